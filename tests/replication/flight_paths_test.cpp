// What is drawn between two snapshots: it begins and ends where they say, has the kink of each hit
// where and when it happened, and is the server's path where nothing is unknown.
#include "common/replication/flight_paths.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/game/input.h"
#include "common/physics/generator.h"
#include "tests/replication/random_snapshots.h"

namespace fts::replication {
namespace {

using physics::Vec2d;
using testing::chance;
using testing::pick;
using testing::Rng;

constexpr Tick kApart = 3;
constexpr double kSpanS = kApart / 60.0;

Course open_course() {
    Course course;
    course.lattice = {kPositionStepM, kVelocityStepMps};
    return course;
}

physics::Control<double> thrust_of(const BallState& ball) {
    physics::Control<double> control;
    control.acceleration_mps2 =
        40.0 * game::thrust_of({.thrust_x = ball.thrust_x, .thrust_y = ball.thrust_y});
    control.drag_per_s = 2.0;
    return control;
}

BallState flying_ball(std::uint16_t id, Vec2d place_m, Vec2d velocity_mps) {
    BallState ball;
    ball.id = id;
    ball.x = quantise(place_m.x(), kPositionStepM);
    ball.y = quantise(place_m.y(), kPositionStepM);
    ball.vx = quantise(velocity_mps.x(), kVelocityStepMps);
    ball.vy = quantise(velocity_mps.y(), kVelocityStepMps);
    ball.radius = 2048;
    ball.mass = 65536;
    return ball;
}

Vec2d start_of(const BallState& ball) {
    return {dequantise(ball.x, kPositionStepM), dequantise(ball.y, kPositionStepM)};
}

// A crowd in a box, of which some thrust.
std::vector<BallState> crowd_in(const Course& course, std::uint64_t seed) {
    physics::Generator generator;
    generator.seed = seed;
    generator.count = 120;
    generator.speed_rms_mps = 12.0;
    const auto scene = std::get<physics::Scene>(physics::fill(course.scene, generator));
    Rng rng(seed);
    std::vector<BallState> balls;
    for (const physics::BodyDef& body : scene.bodies) {
        const auto id = static_cast<std::uint16_t>(3 * balls.size());
        balls.push_back(flying_ball(id, body.position_m, body.velocity_mps));
        if (chance(rng, 50)) balls.back().thrust_x = chance(rng, 50) ? 127 : -127;
    }
    return balls;
}

Course walled_course() {
    Course course = open_course();
    course.scene.walls = physics::Walls{{0.0, 0.0}, {40.0, 30.0}};
    return course;
}

std::vector<BallState> ticks_after(const Course& course, std::span<const BallState> balls,
                                   Tick ticks) {
    LatticeWorld world(course, balls);
    for (Tick tick = 0; tick < ticks; ++tick) world.advance(course.tick_s);
    return world.balls();
}

TEST(FlightPaths, begin_and_end_where_the_snapshots_say_and_never_jump) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Course server = walled_course();
        server.control_of = thrust_of;
        const std::vector<BallState> from = crowd_in(server, seed);
        const std::vector<BallState> to = ticks_after(server, from, kApart);
        const FlightPaths paths = paths_between(walled_course(), from, 90, to, 90 + kApart, {});
        ASSERT_EQ(paths.size(), from.size());
        constexpr int kFrames = 300;
        for (std::size_t i = 0; i < from.size(); ++i) {
            EXPECT_LT((paths.at(i, 0.0).position_m - start_of(from[i])).norm(), 1e-9);
            EXPECT_LT((paths.at(i, kSpanS).position_m - start_of(to[i])).norm(), 1e-9);
            Vec2d last_m = paths.at(i, 0.0).position_m;
            for (int frame = 1; frame <= kFrames; ++frame) {
                const Vec2d place_m = paths.at(i, kSpanS * frame / kFrames).position_m;
                EXPECT_LT((place_m - last_m).norm(), 100.0 * kSpanS / kFrames);
                last_m = place_m;
            }
        }
    }
}

TEST(FlightPaths, have_the_kink_of_a_head_on_hit_where_and_when_it_happened) {
    // Centres are 1.3 m apart and close by 16 m/s: surfaces touch after 0.3 / 16 s, at x = 0.
    const std::vector<BallState> from = {flying_ball(1, {-0.65, 0}, {8, 0}),
                                         flying_ball(2, {0.65, 0}, {-8, 0})};
    const std::vector<BallState> to = {flying_ball(1, {-0.75, 0}, {-8, 0}),
                                       flying_ball(2, {0.75, 0}, {8, 0})};
    const FlightPaths paths = paths_between(open_course(), from, 10, to, 10 + kApart, {});
    const double hit_s = 0.3 / 16.0;
    const double step_m = kPositionStepM;
    EXPECT_NEAR(paths.at(0, hit_s).position_m.x(), -0.5, step_m);
    EXPECT_NEAR(paths.at(1, hit_s).position_m.x(), 0.5, step_m);
    for (const double before_s : {1e-3, 1e-4}) {
        EXPECT_NEAR(paths.at(0, hit_s - before_s).velocity_mps.x(), 8.0, 0.1);
        EXPECT_NEAR(paths.at(0, hit_s + before_s).velocity_mps.x(), -8.0, 0.1);
    }
    for (double since_s = 0.0; since_s <= kSpanS; since_s += 1e-4) {
        const double before_m = -0.65 + 8.0 * since_s, after_m = -0.5 - 8.0 * (since_s - hit_s);
        EXPECT_NEAR(paths.at(0, since_s).position_m.x(), std::min(before_m, after_m), step_m);
    }
}

TEST(FlightPaths, are_the_servers_to_rounding_where_nothing_is_unknown) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Course course = walled_course();
        course.control_of = thrust_of;
        const std::vector<BallState> from = crowd_in(course, seed);
        const std::vector<ControlEvent> events = {{92, from[4].id, 0, 127, false},
                                                  {91, from[7].id, -127, 0, false},
                                                  {93, 1, 127, 0, true}};
        LatticeWorld server(course, from);
        std::vector<std::vector<Vec2d>> ticks_m;
        for (Tick tick = 90; tick < 90 + kApart; ++tick) {
            for (const ControlEvent& event : events) {
                if (event.tick != tick + 1 || event.ball == 1) continue;
                BallState held;
                held.thrust_x = event.thrust_x;
                held.thrust_y = event.thrust_y;
                server.steer(event.ball / 3, held);
            }
            server.advance(course.tick_s);
            std::vector<Vec2d>& places_m = ticks_m.emplace_back();
            for (const physics::BodyId id : server.world().ids()) {
                places_m.push_back(server.world().body(id).position_m);
            }
        }
        const std::vector<BallState> to = server.balls();
        const FlightPaths paths = paths_between(course, from, 90, to, 90 + kApart, events);
        for (std::size_t i = 0; i < from.size(); ++i) {
            for (std::size_t tick = 0; tick < kApart; ++tick) {
                const Vec2d drawn_m =
                    paths.at(i, static_cast<double>(tick + 1) * course.tick_s).position_m;
                EXPECT_LT((drawn_m - ticks_m[tick][i]).norm(), 1.2 * kPositionStepM);
            }
        }
    }
}

double worst_error_m(const Course& course, const std::vector<BallState>& from,
                     const std::vector<BallState>& to, const FlightRun& truth) {
    const FlightPaths paths = paths_between(course, from, 0, to, kApart, {});
    double worst_m = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        for (const Knot& knot : truth.knots_of(i)) {
            worst_m =
                std::max(worst_m, (paths.at(i, knot.time_s).position_m - knot.position_m).norm());
        }
    }
    return worst_m;
}

TEST(LeastPushes, take_as_much_effort_as_the_constant_push_that_makes_the_gap) {
    const Vec2d push_mps2(3.0, -4.0);
    const Gap gap{push_mps2 * (kSpanS * kSpanS / 2.0), push_mps2 * kSpanS};
    EXPECT_NEAR(effort_of(gap, kSpanS), 25.0 * kSpanS, 1e-12);
}

TEST(LeastPushes, close_what_a_run_with_a_hit_leaves_open) {
    for (int steps = 1; steps < 40; ++steps) {
        SCOPED_TRACE(steps);
        const std::vector<BallState> from = {
            flying_ball(1, {0, 0}, {9, 1}),
            flying_ball(2, {1.05 + 0.01 * steps, 0.01 * steps}, {-7, 2})};
        Pushes pushes{2, std::vector<Vec2d>(kApart * 2, Vec2d::Zero())};
        const FlightRun blind = run_flight(open_course(), from, 0, kApart, {}, pushes);
        ASSERT_EQ(blind.hits.size(), 1U);
        Course thrusting = open_course();
        thrusting.control_of = [](const BallState& ball) {
            physics::Control<double> control;
            control.acceleration_mps2 = ball.id == 1 ? Vec2d(0, 20) : Vec2d(-15, 5);
            return control;
        };
        const FlightRun truth = run_flight(thrusting, from, 0, kApart, {}, {});
        const auto gaps_to_truth = [&](const FlightRun& run) {
            std::vector<Gap> gaps;
            for (std::size_t i = 0; i < 2; ++i) {
                gaps.push_back({truth.balls[i].end_m - run.balls[i].end_m,
                                truth.balls[i].end_mps - run.balls[i].end_mps});
            }
            return gaps;
        };
        const std::vector<Gap> open = gaps_to_truth(blind);
        add_least_pushes(blind, 1.0, 1.0 / 60.0, kApart, open, {1, 1}, pushes);
        const std::vector<Gap> left =
            gaps_to_truth(run_flight(open_course(), from, 0, kApart, {}, pushes));
        const auto effort = [](const std::vector<Gap>& gaps) {
            return effort_of(gaps[0], kSpanS) + effort_of(gaps[1], kSpanS);
        };
        // Ticks are few and the hit is followed to first order.
        EXPECT_LT(effort(left), 0.1 * effort(open));
    }
}

TEST(FlightPaths, find_hits_of_balls_that_thrust_unknown_to_them) {
    Course server = open_course();
    server.control_of = thrust_of;
    for (int steps = 0; steps < 40; ++steps) {
        SCOPED_TRACE(steps);
        const double apart_m = 1.05 + 0.01 * steps, aside_m = 0.01 * steps;
        std::vector<BallState> from = {flying_ball(1, {0, 0}, {9, 1}),
                                       flying_ball(2, {apart_m, aside_m}, {-7, 2})};
        from[0].thrust_y = 127;
        from[1].thrust_x = -127;
        const FlightRun truth = run_flight(server, from, 0, kApart, {}, {});
        ASSERT_EQ(truth.hits.size(), 1U);
        // A radius is 0.5 m; a smooth curve is off by 0.1 m and more.
        EXPECT_LT(worst_error_m(open_course(), from, ticks_after(server, from, kApart), truth),
                  0.02);
    }
}

TEST(FlightPaths, find_a_hit_that_only_thrust_explains) {
    Course server = open_course();
    server.control_of = thrust_of;
    std::vector<BallState> from = {flying_ball(1, {0, 0}, {8, 0}),
                                   flying_ball(2, {1.2, 0.985}, {-8, 0})};
    from[0].thrust_y = 127;
    from[1].thrust_y = -127;
    const FlightRun truth = run_flight(server, from, 0, kApart, {}, {});
    ASSERT_EQ(truth.hits.size(), 1U);
    from[0].thrust_y = from[1].thrust_y = 0;
    ASSERT_TRUE(run_flight(server, from, 0, kApart, {}, {}).hits.empty());
    from[0].thrust_y = 127;
    from[1].thrust_y = -127;
    EXPECT_LT(worst_error_m(open_course(), from, ticks_after(server, from, kApart), truth), 0.03);
}

TEST(FlightPaths, leave_out_a_hit_that_thrust_has_prevented) {
    Course server = open_course();
    server.control_of = thrust_of;
    std::vector<BallState> from = {flying_ball(1, {0, 0}, {8, 0}),
                                   flying_ball(2, {0.5, 0.995}, {-8, 0})};
    ASSERT_EQ(run_flight(open_course(), from, 0, kApart, {}, {}).hits.size(), 1U);
    from[0].thrust_y = -127;
    from[1].thrust_y = 127;
    const FlightRun truth = run_flight(server, from, 0, kApart, {}, {});
    ASSERT_TRUE(truth.hits.empty());
    EXPECT_LT(worst_error_m(open_course(), from, ticks_after(server, from, kApart), truth), 0.01);
}

TEST(FlightPaths, are_mirrored_when_everything_is) {
    Course server = walled_course();
    server.control_of = thrust_of;
    server.scene.walls = physics::Walls{{-20.0, -15.0}, {20.0, 15.0}};
    Course blind = server;
    blind.control_of = nullptr;
    const std::vector<BallState> from = crowd_in(server, 5);
    const std::vector<BallState> to = ticks_after(server, from, kApart);
    const auto mirrored = [](std::vector<BallState> balls) {
        for (BallState& ball : balls) {
            ball.x = -ball.x;
            ball.vx = -ball.vx;
        }
        return balls;
    };
    const FlightPaths paths = paths_between(blind, from, 0, to, kApart, {});
    const FlightPaths twins = paths_between(blind, mirrored(from), 0, mirrored(to), kApart, {});
    for (std::size_t i = 0; i < from.size(); ++i) {
        for (double since_s = 0.0; since_s <= kSpanS; since_s += kSpanS / 64.0) {
            const Vec2d place_m = paths.at(i, since_s).position_m;
            const Vec2d twin_m = twins.at(i, since_s).position_m;
            EXPECT_NEAR(place_m.x(), -twin_m.x(), 1e-7);
            EXPECT_NEAR(place_m.y(), twin_m.y(), 1e-7);
        }
    }
}

TEST(FlightPaths, leave_a_ball_that_was_put_elsewhere_where_it_was_and_let_nothing_hit_it) {
    const std::vector<BallState> from = {flying_ball(1, {-0.6, 0}, {6, 0}),
                                         flying_ball(2, {0.6, 0}, {0, 0})};
    const std::vector<BallState> to = {flying_ball(1, {-0.3, 0}, {6, 0}),
                                       flying_ball(2, {9, 9}, {0, 0})};
    const FlightPaths paths = paths_between(open_course(), from, 0, to, kApart, {});
    for (const double since_s : {0.01, 0.03, 0.0499}) {
        EXPECT_EQ(paths.at(1, since_s).position_m, start_of(from[1]));
        EXPECT_NEAR(paths.at(0, since_s).position_m.x(), -0.6 + 6.0 * since_s, kPositionStepM);
    }
}

TEST(FlightPaths, let_a_ball_that_is_gone_hit_and_fly_on) {
    const std::vector<BallState> from = {flying_ball(1, {-0.6, 0}, {8, 0}),
                                         flying_ball(2, {0.6, 0}, {0, 0})};
    const std::vector<BallState> to = {flying_ball(1, {-0.4, 0}, {0, 0})};
    const FlightPaths paths = paths_between(open_course(), from, 0, to, kApart, {});
    EXPECT_NEAR(paths.at(1, 0.02).position_m.x(), 0.6, kPositionStepM);
    EXPECT_NEAR(paths.at(1, kSpanS).position_m.x(), 0.6 + 8.0 * (kSpanS - 0.2 / 8.0),
                2.0 * kPositionStepM);
    const std::vector<BallState> joined = {to[0], flying_ball(7, {3, 3}, {1, 0})};
    EXPECT_EQ(paths_between(open_course(), from, 0, joined, kApart, {}).size(), 2U);
    EXPECT_EQ(paths_between(open_course(), {}, 0, joined, kApart, {}).size(), 0U);
}

TEST(FlightPaths, fly_straight_on_over_the_edge_of_a_platform) {
    Course course = open_course();
    course.scene.platform = physics::Disc{5.0};
    const std::vector<BallState> from = {flying_ball(1, {4.9, 0}, {8, 0}),
                                         flying_ball(2, {5.5, 0}, {2, 0})};
    const FlightPaths paths = paths_between(course, from, 0, {}, kApart, {});
    EXPECT_NEAR(paths.at(0, kSpanS).position_m.x(), 4.9 + 8.0 * kSpanS, kPositionStepM);
    EXPECT_NEAR(paths.at(1, kSpanS).position_m.x(), 5.5 + 2.0 * kSpanS, kPositionStepM);
}

TEST(FlightPaths, go_on_beyond_the_newest_snapshot_with_their_hits) {
    const std::vector<BallState> newest = {flying_ball(1, {-0.65, 0}, {8, 0}),
                                           flying_ball(2, {0.65, 0}, {-8, 0})};
    const FlightPaths paths = paths_beyond(open_course(), newest, 6);
    EXPECT_DOUBLE_EQ(paths.span_s(), 0.1);
    EXPECT_NEAR(paths.at(0, 0.1).position_m.x(), -0.5 - 8.0 * (0.1 - 0.3 / 16.0), 2e-3);
    EXPECT_EQ(paths.at(0, 9.0).position_m, paths.at(0, 0.1).position_m);
    EXPECT_DOUBLE_EQ(paths_beyond(open_course(), newest, 1'000'000).span_s(),
                     kMaxFlightTicks / 60.0);
}

TEST(FlightPaths, simulate_nothing_over_a_long_silence) {
    const std::vector<BallState> from = {flying_ball(1, {0, 0}, {8, 0})};
    const std::vector<BallState> to = {flying_ball(1, {1, 2}, {-8, 3})};
    const Tick ticks = kMaxFlightTicks + 10;
    const FlightPaths paths = paths_between(open_course(), from, 5, to, 5 + ticks, {});
    EXPECT_LT((paths.at(0, ticks / 120.0).position_m - Vec2d(0.5, 1)).norm(), 1e-9);
}

TEST(FlightPaths, stay_finite_whatever_two_snapshots_hold) {
    constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
    for (unsigned seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Rng rng(seed);
        Course course = chance(rng, 50) ? walled_course() : open_course();
        if (chance(rng, 30)) course.scene.platform = physics::Ring{2.0, 30.0};
        const std::int64_t wide = chance(rng, 30) ? kFar : chance(rng, 50) ? 40'000 : 600;
        const std::int64_t fast = chance(rng, 30) ? kFar : 20'000;
        const auto steps = [&](std::int64_t most) {
            return static_cast<std::int32_t>(pick(rng, -most, most));
        };
        const auto any_balls = [&] {
            std::vector<BallState> balls;
            for (std::uint16_t id = 0; id < 40; ++id) {
                if (chance(rng, 20)) continue;
                BallState ball;
                ball.id = id;
                ball.x = steps(wide);
                ball.y = steps(wide);
                ball.vx = steps(fast);
                ball.vy = steps(fast);
                ball.radius =
                    static_cast<std::uint16_t>(pick(rng, 0, chance(rng, 10) ? 65535 : 300));
                ball.mass = static_cast<std::uint32_t>(pick(rng, 0, chance(rng, 10) ? kFar : 300));
                balls.push_back(ball);
            }
            return balls;
        };
        const std::vector<BallState> from = any_balls(), to = any_balls();
        const FlightPaths paths = paths_between(course, from, 1, to, 1 + kApart, {});
        for (std::size_t i = 0; i < paths.size(); ++i) {
            for (const double since_s : {-1.0, 0.0, 0.01, 0.025, 0.0499, kSpanS, 7.0}) {
                const FlightPose pose = paths.at(i, since_s);
                ASSERT_TRUE(pose.position_m.allFinite());
                ASSERT_TRUE(pose.velocity_mps.allFinite());
            }
        }
    }
}

}  // namespace
}  // namespace fts::replication
