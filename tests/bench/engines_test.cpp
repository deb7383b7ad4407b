// What is measured beside each other does the same thing, and does it well enough to be worth its
// time.
#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "server/lab/bench/bench.h"
#include "server/lab/bench/specimen.h"

namespace fts::lab {

// For the names that googletest prints.
static void PrintTo(const EngineInfo& engine, std::ostream* out) {
    *out << engine.name;
}

namespace {

class EveryEngine : public testing::TestWithParam<EngineInfo> {};
class EveryPhysicsEngine : public EveryEngine {};  // but for the floor, which knows no collisions

// Ours conserve energy to round-off. Of the others it is only told: fast balls can double it.
double largest_energy_error(const EngineInfo& engine) {
    if (engine.name.ends_with("-double")) return 1e-12;
    if (engine.name.ends_with("-float")) return 1e-5;
    return kEnergyLost;
}

TEST_P(EveryEngine, starts_with_the_scene_as_it_is_given) {
    const physics::Scene scene = balls_of({32, 0.3, Radii::kUnequal, 0.05});
    const auto engine = make_engine(GetParam().name, scene, kBenchTickS);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        EXPECT_LT((engine->ball(i).position_m - scene.bodies[i].position_m).norm(), 1e-5);
        EXPECT_LT((engine->ball(i).velocity_mps - scene.bodies[i].velocity_mps).norm(), 1e-5);
    }
}

TEST_P(EveryPhysicsEngine, keeps_balls_in_their_box_and_ours_their_energy) {
    for (const double speed : {0.05, 2.0}) {
        SCOPED_TRACE(speed);
        const BenchScene what{32, 0.3, Radii::kEqual, speed};
        const physics::Scene scene = balls_of(what);
        Specimen specimen({GetParam().name, what});
        EXPECT_LT(specimen.laws().energy_error, largest_energy_error(GetParam()));
        EXPECT_EQ(specimen.laws().ticks, warm_up_ticks(what));
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            const BallState ball = specimen.engine().ball(i);
            // Who steps first and looks then may leave a ball outside by as much as it moves.
            const double slack = 4.0 * speed * kBenchRadiusM;
            EXPECT_LT(ball.position_m.cwiseAbs().maxCoeff(), scene.walls->max_m.x() + slack);
            EXPECT_TRUE(ball.velocity_mps.allFinite());
        }
    }
}

TEST_P(EveryPhysicsEngine, lets_no_slow_pair_through_each_other) {
    EXPECT_EQ(shoot_head_on(GetParam().name, 0.1, 100).through, 0U);
}

std::string test_name(const testing::TestParamInfo<EngineInfo>& info) {
    std::string name = info.param.name;
    std::ranges::replace(name, '-', '_');
    return name;
}
std::vector<EngineInfo> physics_engines() {
    std::vector<EngineInfo> all = engines();
    std::erase_if(all, [](const EngineInfo& engine) { return engine.is_floor; });
    return all;
}
INSTANTIATE_TEST_SUITE_P(, EveryEngine, testing::ValuesIn(engines()), test_name);
INSTANTIATE_TEST_SUITE_P(, EveryPhysicsEngine, testing::ValuesIn(physics_engines()), test_name);

TEST(HeadOnPairs, pass_through_each_other_where_nothing_looks_between_ticks) {
    // Each meets for one tick of two, and whoever is looked at before the middle is turned back.
    const HeadOn discrete = shoot_head_on("discrete-double", 4.0, 1000);
    EXPECT_NEAR(discrete.per_1000(), 500.0, 60.0);
    EXPECT_EQ(shoot_head_on("swept-double", 4.0, 1000).through, 0U);
    EXPECT_EQ(shoot_head_on("event-double", 4.0, 1000).through, 0U);
}

TEST(Bench, what_would_not_end_is_not_run_and_says_how_many_balls_are_too_many) {
    const auto why_not = [](const char* engine, std::size_t balls, double radii_per_tick) {
        return reason_not_to_run({engine, {balls, 0.3, Radii::kEqual, radii_per_tick}});
    };
    EXPECT_EQ(why_not("discrete-double", 1'000'000, 2.0), "");
    EXPECT_EQ(why_not("seed-double", 2'000, 2.0), "");
    EXPECT_NE(why_not("seed-double", 2'001, 0.05).find("more than 2,000 balls"), std::string::npos);
    if (find_engine("box2d") == nullptr) GTEST_SKIP() << "Box2D is not in this build";
    EXPECT_EQ(why_not("box2d", 100'000, 0.05), "");
    EXPECT_EQ(why_not("box2d", 10'000, 2.0), "");
    EXPECT_NE(why_not("box2d", 10'001, 2.0).find("more than 10,000 fast balls"), std::string::npos);
    EXPECT_EQ(why_not("box2d-bullets", 2'000, 0.05), "");
    EXPECT_NE(why_not("box2d-bullets", 201, 2.0).find("more than 200 fast"), std::string::npos);
}

TEST(WarmUp, is_shorter_the_larger_and_faster_the_scene_and_moves_a_ball_by_a_radius) {
    EXPECT_EQ(warm_up_ticks({32, 0.3, Radii::kEqual, 0.05}), 60U);
    EXPECT_EQ(warm_up_ticks({10'000, 0.3, Radii::kEqual, 0.05}), 60U);
    EXPECT_EQ(warm_up_ticks({10'000, 0.3, Radii::kEqual, 2.0}), 10U);
    EXPECT_EQ(warm_up_ticks({100'000, 0.3, Radii::kEqual, 0.05}), 20U);
    EXPECT_EQ(warm_up_ticks({1'000'000, 0.3, Radii::kEqual, 0.05}), 20U);
    EXPECT_EQ(warm_up_ticks({1'000'000, 0.3, Radii::kEqual, 1e3}), 5U);
    EXPECT_EQ(warm_up_ticks({1'000'000, 0.3, Radii::kEqual, 1e-3}), 60U);
}

TEST(BenchCell, is_its_name) {
    for (const Radii radii : {Radii::kEqual, Radii::kUnequal}) {
        const BenchCell cell{"swept-double", {12'345, 0.35, radii, 0.005}};
        const auto again = cell_from(name_of(cell));
        ASSERT_TRUE(again);
        EXPECT_EQ(again->engine, cell.engine);
        EXPECT_EQ(again->scene, cell.scene);
    }
    EXPECT_FALSE(cell_from("swept-double/N:twelve/packing:0.3/radii:equal/speed:1"));
    EXPECT_FALSE(cell_from("swept-double/N:12/packing:0.3/radii:odd/speed:1"));
    EXPECT_FALSE(cell_from(""));
}

BenchResult result_of(const std::string& engine, const BenchScene& scene, double ns) {
    BenchResult result;
    result.cell = {engine, scene};
    result.ns_per_ball_tick = ns;
    return result;
}

TEST(BenchResults, are_compared_with_the_faster_chipmunk_in_the_same_scene) {
    const BenchScene scene, other{200, 0.3, Radii::kEqual, 0.05};
    const std::vector<BenchResult> results = {
        result_of("discrete-double", scene, 10.0), result_of("chipmunk-hash", scene, 400.0),
        result_of("chipmunk-tree", scene, 300.0), result_of("chipmunk-tree", other, 1.0),
        result_of("swept-double", {32, 0.3, Radii::kEqual, 0.05}, 1.0)};
    EXPECT_DOUBLE_EQ(times_faster_than_chipmunk(results, results[0]).value(), 30.0);
    EXPECT_FALSE(times_faster_than_chipmunk(results, results[4]));
}

TEST(BenchPlot, shows_along_an_axis_only_what_differs_in_nothing_else) {
    const BenchScene fixed{200, 0.3, Radii::kEqual, 0.05};
    BenchScene large = fixed, dense = fixed;
    large.balls = 2'000;
    dense.packing = 0.6;
    const std::vector<BenchResult> results = {result_of("swept-double", dense, 3.0),
                                              result_of("swept-double", large, 2.0),
                                              result_of("swept-double", fixed, 1.0)};
    const Plot over_balls = cost_plot(results, BenchAxis::kBalls, fixed);
    ASSERT_EQ(over_balls.series.size(), 1U);
    ASSERT_EQ(over_balls.series[0].points.size(), 2U);
    EXPECT_EQ(over_balls.series[0].points[1].x, 2000.0);
    const Plot over_packing = cost_plot(results, BenchAxis::kPacking, fixed);
    ASSERT_EQ(over_packing.series[0].points.size(), 2U);
    EXPECT_EQ(over_packing.series[0].points[1].y, 3.0);
}

}  // namespace
}  // namespace fts::lab
