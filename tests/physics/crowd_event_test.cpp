// A crowd foreseen in windows of time against the same crowd in a calendar.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/physics/crowd_coasting.h"
#include "common/physics/diagnostics.h"
#include "common/physics/solver_event.h"
#include "tests/physics/crowds.h"
#include "tests/physics/values.h"

namespace fts::physics {
namespace {

template <typename Scalar>
Model<Scalar> model_of_crowd(const Scene& scene) {
    Model<Scalar> model;
    if (scene.walls) {
        model.walls = {scene.walls->min_m.cast<Scalar>(), scene.walls->max_m.cast<Scalar>()};
    }
    model.platform = scene.platform;
    model.restitution = static_cast<Scalar>(scene.restitution);
    const BodyDef& first = scene.bodies.front();
    model.equal_radii = std::all_of(scene.bodies.begin(), scene.bodies.end(),
                                    [&](const auto& b) { return b.radius_m == first.radius_m; });
    model.equal_masses = std::isfinite(first.mass_kg) &&
                         std::all_of(scene.bodies.begin(), scene.bodies.end(),
                                     [&](const auto& b) { return b.mass_kg == first.mass_kg; });
    return model;
}

// A solver, and what it works on.
struct DrivenCrowd {
    Bodies<double> bodies;
    Model<double> model;
    Record<double> record;
    std::vector<Contact<double>> hits;  // times are since the beginning
    std::vector<Fall<double>> falls;
    double now_s = 0.0;
    std::unique_ptr<Solver<double>> solver;

    DrivenCrowd(const Scene& scene, Foresight foresight)
        : model(model_of_crowd<double>(scene)), solver(make_event_solver<double>(foresight)) {
        for (const BodyDef& body : scene.bodies) {
            bodies.add(body.position_m, body.velocity_mps, body.radius_m, body.mass_kg);
        }
    }
    DriftReport<double> drift(double span_s) {
        record.begin_step();
        const DriftReport<double> report = solver->drift(bodies, model, span_s, record);
        for (Contact<double> hit : record.contacts) {
            hit.time_s += now_s;
            hits.push_back(hit);
        }
        for (Fall<double> fall : record.falls) {
            fall.time_s += now_s;
            falls.push_back(fall);
        }
        now_s += span_s;
        return report;
    }
    bool is_for_windows() const { return CrowdCoasting<double>().begin(bodies, model); }
};

void expect_same_life(DrivenCrowd& windows, DrivenCrowd& calendar, double within) {
    ASSERT_EQ(windows.hits.size(), calendar.hits.size());
    for (std::size_t i = 0; i < windows.hits.size(); ++i) {
        const Contact<double>&one = windows.hits[i], &two = calendar.hits[i];
        ASSERT_EQ(one.a, two.a) << i;
        ASSERT_EQ(one.b, two.b) << i;
        ASSERT_NEAR(one.time_s, two.time_s, within) << i;
        ASSERT_LT((one.point_m - two.point_m).norm(), 10.0 * within) << i;
    }
    ASSERT_EQ(windows.falls.size(), calendar.falls.size());
    for (std::size_t i = 0; i < windows.falls.size(); ++i) {
        ASSERT_EQ(windows.falls[i].id, calendar.falls[i].id) << i;
        ASSERT_NEAR(windows.falls[i].time_s, calendar.falls[i].time_s, within) << i;
    }
    windows.solver->synchronise(windows.bodies);
    calendar.solver->synchronise(calendar.bodies);
    ASSERT_EQ(windows.bodies.ids, calendar.bodies.ids);
    for (const BodyId id : windows.bodies.ids) {
        const std::uint32_t i = id.index;
        ASSERT_LT((windows.bodies.position_m[i] - calendar.bodies.position_m[i]).norm(),
                  10.0 * within);
        ASSERT_LT((windows.bodies.velocity_mps[i] - calendar.bodies.velocity_mps[i]).norm(),
                  1000.0 * within);
    }
}

struct Situation {
    const char* name;
    std::function<Scene(CrowdShape, Dice&)> scene;
    std::size_t fewest_hits = 1000;
    std::size_t fewest_falls = 0;
    double tick_s = kTick;
    double within = 1e-10;
};

Scene crowd_on(const Platform& platform, CrowdShape shape, Dice& dice) {
    shape.balls = 600;
    Scene scene = random_crowd(shape, dice);
    scene.walls.reset();
    stand_on(platform, scene);
    return scene;
}

// So wide that more than kFewestInWindows of the crowd stand on it.
double half_of(const CrowdShape& shape) {
    return 0.5 * std::sqrt(600.0 * 3.14 * (shape.max_radius_m > 1.0 ? 1.08 : 0.25) / shape.filled);
}

Scene one_line(const CrowdShape& shape, Dice& dice) {
    Scene scene;
    double x = -500.0;
    for (std::size_t i = 0; i < shape.balls; ++i) {
        const double radius = dice.between(shape.min_radius_m, shape.max_radius_m);
        x += 2.0 * shape.max_radius_m + dice.between(0.0, 1.0);
        const Vec2d velocity(dice.between(-5.0, 5.0), 0.0);
        scene.bodies.push_back({Vec2d(x, 3.0), velocity, radius, radius * radius});
    }
    return scene;
}

const Situation kSituations[] = {
    {"in_walls", [](const CrowdShape& shape, Dice& dice) { return random_crowd(shape, dice); }},
    {"in_the_open",
     [](const CrowdShape& shape, Dice& dice) {
         Scene scene = random_crowd(shape, dice);
         scene.walls.reset();
         return scene;
     }},
    {"crowded_in_walls",
     [](CrowdShape shape, Dice& dice) {
         shape.filled = 0.42;
         shape.max_speed_mps = 2.0;
         return random_crowd(shape, dice);
     }},
    {"sparse_in_walls",
     [](CrowdShape shape, Dice& dice) {
         shape.filled = 0.02;
         return random_crowd(shape, dice);
     },
     100, 0, 5.0 * kTick},
    {"on_a_disc",
     [](const CrowdShape& shape, Dice& dice) {
         return crowd_on(Disc{half_of(shape)}, shape, dice);
     },
     1000, 100},
    {"on_a_rectangle",
     [](const CrowdShape& shape, Dice& dice) {
         const double half = half_of(shape);
         return crowd_on(Rectangle{{0.9 * half, 0.8 * half}}, shape, dice);
     },
     1000, 100},
    {"on_a_ring",
     [](const CrowdShape& shape, Dice& dice) {
         const double half = half_of(shape);
         return crowd_on(Ring{0.2 * half, half}, shape, dice);
     },
     1000, 100},
    {"with_some_immovable",
     [](const CrowdShape& shape, Dice& dice) {
         Scene scene = random_crowd(shape, dice);
         for (std::size_t i = 0; i < scene.bodies.size(); i += 17) {
             scene.bodies[i].mass_kg = kInfinite;
             if (i % 2 == 0) scene.bodies[i].velocity_mps = Vec2d::Zero();
         }
         return scene;
     }},
    {"a_little_inelastic",
     [](const CrowdShape& shape, Dice& dice) {
         Scene scene = random_crowd(shape, dice);
         scene.restitution = 0.97;
         return scene;
     }},
    {"with_four_much_larger",
     [](CrowdShape shape, Dice& dice) {
         shape.balls = 600;
         Scene scene = random_crowd(shape, dice);
         for (int i = 0; i < 4; ++i) {
             const Vec2d place(i % 2 == 0 ? -9.0 : 9.0, i < 2 ? -9.0 : 9.0);
             std::erase_if(scene.bodies, [&](const BodyDef& body) {
                 return (body.position_m - place).norm() < 5.0 + body.radius_m;
             });
             scene.bodies.push_back({place, dice.in_box(1.0), 5.0, 25.0});
         }
         return scene;
     }},
    {"with_a_bullet",
     [](const CrowdShape& shape, Dice& dice) {
         Scene scene = random_crowd(shape, dice);
         scene.bodies[7].velocity_mps = Vec2d(400.0, 300.0);
         return scene;
     },
     100, 0, 1e-3},
    {"at_rest_but_for_one",
     [](const CrowdShape& shape, Dice& dice) {
         Scene scene = random_crowd(shape, dice);
         for (BodyDef& body : scene.bodies) body.velocity_mps = Vec2d::Zero();
         scene.bodies[5].velocity_mps = Vec2d(3.0, 2.0);
         return scene;
     },
     30, 0, 2.0 * kTick},
    {"far_from_the_origin",
     [](CrowdShape shape, Dice& dice) {
         shape.centre_m = Vec2d(1e5, -1e5);
         return random_crowd(shape, dice);
     },
     1000, 0, kTick, 1e-6},
    {"in_one_line", one_line},
    {"let_loose_in_a_corner_of_a_wide_box",
     [](CrowdShape shape, Dice& dice) {
         shape.filled = 0.35;
         Scene scene = random_crowd(shape, dice);
         scene.walls->max_m += Vec2d(500.0, 300.0);
         return scene;
     }},
    {"in_two_heaps_far_apart",
     [](const CrowdShape& shape, Dice& dice) {
         Scene scene = random_crowd(shape, dice);
         const std::size_t half = scene.bodies.size() / 2;
         for (std::size_t i = 0; i < half; ++i) scene.bodies[i].position_m += Vec2d(2e3, 1e3);
         scene.walls.reset();
         return scene;
     }},
    {"in_a_stream_past_the_origin",
     [](const CrowdShape& shape, Dice& dice) {
         Scene scene = random_crowd(shape, dice);
         scene.walls.reset();
         for (BodyDef& body : scene.bodies) body.velocity_mps += Vec2d(60.0, -40.0);
         return scene;
     },
     1000, 0, kTick, 1e-9},
};

std::string name_of_situation(const testing::TestParamInfo<std::size_t>& info) {
    return kSituations[info.param].name;
}

class CrowdAgainstCalendar : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Situations, CrowdAgainstCalendar,
                         testing::Range<std::size_t>(0, std::size(kSituations)), name_of_situation);

TEST_P(CrowdAgainstCalendar, the_same_pairs_collide_at_the_same_times_in_the_same_order) {
    const Situation& situation = kSituations[GetParam()];
    std::size_t hits = 0, falls = 0;
    for (std::uint64_t seed = 500; seed < 512; ++seed) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        CrowdShape shape;
        shape.balls = 360 + dice.below(240);
        if (seed % 2 == 1) shape.max_radius_m = 1.5;
        const Scene scene = situation.scene(shape, dice);
        DrivenCrowd windows(scene, Foresight::kSuitable), calendar(scene, Foresight::kCalendar);
        ASSERT_TRUE(windows.is_for_windows()) << scene.bodies.size();
        for (int tick = 0; tick < 40; ++tick) {
            ASSERT_FALSE(windows.drift(situation.tick_s).overrun);
            ASSERT_FALSE(calendar.drift(situation.tick_s).overrun);
        }
        hits += calendar.hits.size();
        falls += calendar.falls.size();
        expect_same_life(windows, calendar, situation.within);
        if (HasFatalFailure()) return;
    }
    EXPECT_GE(hits, situation.fewest_hits);
    EXPECT_GE(falls, situation.fewest_falls);
}

TEST(CrowdEvents, nothing_happens_in_a_crowd_at_rest) {
    constexpr std::uint64_t kSeed = 510;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Scene apart = random_crowd({.max_speed_mps = 0.0}, dice);
    Scene touching;
    touching.bodies = rack(24, 0.5);
    for (const Scene& scene : {apart, touching}) {
        DrivenCrowd windows(scene, Foresight::kSuitable);
        ASSERT_TRUE(windows.is_for_windows());
        for (int tick = 0; tick < 100; ++tick) {
            const DriftReport<double> report = windows.drift(1.0);
            ASSERT_EQ(report.events, 0U);
            ASSERT_FALSE(report.overrun);
        }
        windows.solver->synchronise(windows.bodies);
        for (const BodyId id : windows.bodies.ids) {
            EXPECT_EQ(windows.bodies.position_m[id.index], scene.bodies[id.index].position_m);
        }
    }
}

// Everybody in the rack touches others in one instant: in which order is nobody's to say.
TEST(CrowdEvents, a_cue_ball_breaks_a_rack_in_exact_contact_as_with_a_calendar) {
    for (const double aside_m : {0.0, 0.3}) {
        SCOPED_TRACE(aside_m);
        Scene scene;
        scene.bodies = rack(24, 0.5);
        scene.walls = Walls{Vec2d(-20.0, -30.0), Vec2d(40.0, 30.0)};
        scene.bodies.push_back({Vec2d(-5.0, aside_m), Vec2d(30.0, 0.0), 0.5, 1.0});
        DrivenCrowd windows(scene, Foresight::kSuitable), calendar(scene, Foresight::kCalendar);
        ASSERT_TRUE(windows.is_for_windows());
        const double energy_j = kinetic_energy_j(windows.bodies);
        for (int tick = 0; tick < 120; ++tick) {
            ASSERT_FALSE(windows.drift(kTick).overrun) << tick;
            ASSERT_FALSE(calendar.drift(kTick).overrun) << tick;
            windows.solver->synchronise(windows.bodies);
            ASSERT_NEAR(kinetic_energy_j(windows.bodies) / energy_j, 1.0, 1e-12) << tick;
            ASSERT_LT(deepest_overlap(windows.bodies, windows.model), 1e-12) << tick;
        }
        EXPECT_GT(windows.hits.size(), 300U);
        EXPECT_GT(calendar.hits.size(), 300U);
    }
}

TEST(CrowdEvents, a_quiet_drift_neither_reads_nor_writes_the_bodies) {
    constexpr std::uint64_t kSeed = 511;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Scene scene = random_crowd({.max_speed_mps = 1e-6, .filled = 0.1}, dice);
    DrivenCrowd crowd(scene, Foresight::kSuitable);
    ASSERT_TRUE(crowd.is_for_windows());
    crowd.drift(1e-3);
    crowd.bodies.position_m.assign(crowd.bodies.slots(), Vec2d(kNan, kNan));
    crowd.bodies.velocity_mps.assign(crowd.bodies.slots(), Vec2d(kNan, kNan));
    for (int tick = 0; tick < 10; ++tick) {
        ASSERT_EQ(crowd.drift(1e-3).events, 0U);
        EXPECT_TRUE(std::isnan(crowd.bodies.position_m[0].x()));
    }
    crowd.solver->synchronise(crowd.bodies);
    for (const BodyId id : crowd.bodies.ids) {
        const BodyDef& body = scene.bodies[id.index];
        const Vec2d expected = body.position_m + 11e-3 * body.velocity_mps;
        EXPECT_LT((crowd.bodies.position_m[id.index] - expected).norm(), 1e-14);
        EXPECT_EQ(crowd.bodies.velocity_mps[id.index], body.velocity_mps);
    }
}

// They share one memory: what one of them had foreseen must not come up in the other.
TEST(CrowdEvents, a_solver_that_forgets_goes_from_windows_to_a_calendar_and_back) {
    constexpr std::uint64_t kSeed = 512;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    constexpr std::size_t kChanged = 60;
    const Scene scene = random_crowd({.balls = kFewestInWindows + kChanged / 2}, dice);
    DrivenCrowd windows(scene, Foresight::kSuitable), calendar(scene, Foresight::kCalendar);
    for (int change = 0; change < 6; ++change) {
        const bool shrinks = change % 2 == 0;
        for (DrivenCrowd* crowd : {&windows, &calendar}) {
            crowd->solver->synchronise(crowd->bodies);
            for (std::uint32_t i = 0; i < kChanged; ++i) {
                if (shrinks) {
                    crowd->bodies.remove(i);
                } else {
                    const BodyDef& ball = scene.bodies[i];
                    const Vec2d apart(0.0, 100.0);
                    crowd->bodies.add(ball.position_m + apart, Vec2d::Zero(), ball.radius_m,
                                      ball.mass_kg);
                }
            }
            crowd->model.walls.reset();
            crowd->solver->forget();
        }
        EXPECT_EQ(windows.is_for_windows(), !shrinks);
        for (int tick = 0; tick < 8; ++tick) {
            windows.drift(kTick);
            calendar.drift(kTick);
        }
        expect_same_life(windows, calendar, 1e-10);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(windows.hits.size(), 100U);
}

// So many that what is due is read ahead; with some that are faster than the paths of the rest.
TEST(CrowdEvents, more_than_near_caches_hold_live_as_in_a_calendar) {
    constexpr std::uint64_t kSeed = 519;
    SCOPED_TRACE(kSeed);
    constexpr int kRows = 184;
    constexpr double kSpacing = 1.3;
    Dice dice(kSeed);
    Scene scene;
    scene.walls = {Vec2d::Constant(-kSpacing), Vec2d::Constant(kRows * kSpacing)};
    for (int i = 0; i < kRows * kRows; ++i) {
        const double speed = i % 3000 == 0 ? 60.0 : 5.0;
        scene.bodies.push_back(
            {kSpacing * Vec2d(i % kRows, i / kRows), dice.in_box(speed), 0.5, 1.0});
    }
    DrivenCrowd windows(scene, Foresight::kSuitable), calendar(scene, Foresight::kCalendar);
    ASSERT_TRUE(windows.is_for_windows());
    for (int tick = 0; tick < 4; ++tick) {
        ASSERT_FALSE(windows.drift(0.03).overrun);
        ASSERT_FALSE(calendar.drift(0.03).overrun);
    }
    EXPECT_GT(windows.hits.size(), 5000U);
    expect_same_life(windows, calendar, 1e-9);
}

}  // namespace
}  // namespace fts::physics
