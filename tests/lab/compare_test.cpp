#include "server/lab/compare.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/lab/exact_tick.h"
#include "server/lab/pareto.h"
#include "tests/physics/scenes.h"

namespace fts::lab {
namespace {

using physics::ScalarKind;
using physics::Scene;
using physics::SolverKind;
using physics::Vec2d;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint64_t kGasSeed = 11;

bool always() {
    return true;
}

Setting setting(SolverKind kind, std::uint32_t substeps = 1,
                ScalarKind scalar = ScalarKind::kDouble) {
    return {{kind, substeps}, scalar};
}

// Balls of about one radius a tick at `speed` 1.
Scene gas(double speed, std::size_t balls = 24) {
    physics::Dice dice(kGasSeed);
    return physics::random_gas({.balls = balls,
                                .half_width_m = 4.0,
                                .max_speed_mps = 30.0 * speed,
                                .min_radius_m = 0.4,
                                .max_radius_m = 0.5},
                               dice);
}

Accuracy accuracy_of(const Scene& scene, const Setting& how, std::size_t ticks) {
    const Run run{ticks, 1.0 / 60.0};
    const SamplingLimits limits;
    const auto reference = reference_of(scene, run, limits, always);
    return *measure_accuracy(scene, how, run, limits, reference ? &*reference : nullptr, always);
}

CompareRequest request_for(const Scene& scene) {
    CompareRequest request;
    request.scene_name = "some.scene";
    request.scene = scene;
    request.seconds = 0.5;
    request.solvers = {SolverKind::kDiscrete, SolverKind::kSwept};
    request.substeps = {1, 4};
    request.scalars = {ScalarKind::kFloat, ScalarKind::kDouble};
    request.cost = {.repeats = 1, .seconds_of_a_repeat = 0.001};
    return request;
}

TEST(Accuracy, swept_and_event_in_double_are_exact_but_for_round_off) {
    for (const SolverKind kind : {SolverKind::kSwept, SolverKind::kEvent}) {
        SCOPED_TRACE(physics::to_string(kind));
        const Accuracy accuracy = accuracy_of(gas(0.1), setting(kind), 200);
        EXPECT_GT(accuracy.local.collisions, 50U);
        EXPECT_EQ(accuracy.local.missed, 0U);
        EXPECT_EQ(accuracy.local.extra, 0U);
        EXPECT_LT(accuracy.local.collision_error.value(), 1e-10);
        EXPECT_LT(accuracy.local.time_error_ticks.value(), 1e-10);
        EXPECT_LT(std::abs(accuracy.global.energy_error.value()), 1e-12);
        EXPECT_LT(accuracy.global.momentum_error.value(), 1e-12) << "walls are accounted for";
        EXPECT_GT(accuracy.global.divergence->collisions, 50U);
    }
}

TEST(Accuracy, a_step_of_a_hundred_radii_misses_nearly_everything) {
    Scene scene;
    // Pairs that meet in the middle of a tick and are far past each other at its end.
    for (int i = 0; i < 20; ++i) {
        const double y = 10.0 * i, x = 15.0 + 0.37 * i;
        scene.bodies.push_back({{-x, y}, {50.0 * 60.0, 0.0}, 0.5, 1.0});
        scene.bodies.push_back({{x, y + 0.3}, {-50.0 * 60.0, 0.0}, 0.5, 1.0});
    }
    const Accuracy accuracy = accuracy_of(scene, setting(SolverKind::kDiscrete), 2);
    EXPECT_EQ(accuracy.local.collisions, 20U);
    EXPECT_GT(accuracy.local.missed_per_1000().value(), 900.0);
    EXPECT_NEAR(accuracy.local.collision_error.value(), accuracy.local.error_of_ignoring.value(),
                0.1);
    EXPECT_EQ(accuracy.global.divergence->collisions, 0U);
    EXPECT_TRUE(accuracy.global.divergence->reached);
    const Accuracy exact = accuracy_of(scene, setting(SolverKind::kSwept), 2);
    EXPECT_EQ(exact.local.missed, 0U);
}

TEST(Accuracy, smaller_steps_are_more_exact) {
    const Scene scene = gas(0.2);
    const auto coarse = accuracy_of(scene, setting(SolverKind::kDiscrete, 1), 200).local;
    const auto fine = accuracy_of(scene, setting(SolverKind::kDiscrete, 64), 200).local;
    EXPECT_LT(fine.time_error_ticks.value(), 0.1 * coarse.time_error_ticks.value());
    EXPECT_LT(fine.collision_error.value(), coarse.collision_error.value());
    EXPECT_GT(coarse.collision_error.value(), 1e-3);
}

TEST(Accuracy, single_precision_shows) {
    const auto local =
        accuracy_of(gas(0.1), setting(SolverKind::kSwept, 1, ScalarKind::kFloat), 100).local;
    EXPECT_GT(local.collision_error.value(), 1e-9);
    EXPECT_LT(local.collision_error.value(), 1e-2);
}

TEST(Accuracy, says_what_does_not_apply_instead_of_a_wrong_figure) {
    Scene lossy = gas(0.1);
    lossy.restitution = 0.9;
    const Accuracy accuracy = accuracy_of(lossy, setting(SolverKind::kSwept), 20);
    EXPECT_FALSE(accuracy.local.collision_error);
    EXPECT_FALSE(accuracy.global.energy_error);
    EXPECT_FALSE(accuracy.global.divergence);
    EXPECT_TRUE(accuracy.global.momentum_error) << "it is conserved all the same";
    EXPECT_FALSE(accuracy.remarks.empty());

    Scene platform = gas(0.1);
    platform.walls.reset();
    platform.platform = physics::Disc{100.0};
    EXPECT_FALSE(accuracy_of(platform, setting(SolverKind::kSwept), 20).global.energy_error);
}

TEST(Accuracy, drag_is_no_error) {
    Scene scene = gas(0.2);
    scene.drag_per_s = 0.5;
    const Accuracy accuracy = accuracy_of(scene, setting(SolverKind::kSwept), 100);
    EXPECT_GT(accuracy.local.collisions, 20U);
    EXPECT_LT(accuracy.local.collision_error.value(), 1e-10);
    EXPECT_LT(std::abs(accuracy.global.energy_error.value()), 1e-11);
    EXPECT_LT(accuracy.global.momentum_error.value(), 1e-11);
}

TEST(Accuracy, a_hit_at_the_very_end_of_a_tick_is_nobodys_error) {
    // They touch after exactly 60 ticks.
    Scene scene;
    scene.bodies = {{{-2.0, 0.0}, {1.0, 0.0}, 0.5, 1.0}, {{2.0, 0.0}, {-2.0, 0.0}, 0.5, 1.0}};
    for (const ScalarKind scalar : {ScalarKind::kFloat, ScalarKind::kDouble}) {
        for (const SolverKind kind : {SolverKind::kSwept, SolverKind::kEvent}) {
            SCOPED_TRACE(to_string(setting(kind, 1, scalar)));
            const auto local = accuracy_of(scene, setting(kind, 1, scalar), 90).local;
            EXPECT_GE(local.ticks_undecided, 1U);
            EXPECT_EQ(local.missed + local.extra, 0U);
            EXPECT_LT(local.collision_error.value_or(0.0), 1e-5);
        }
    }
}

TEST(ExactTick, groups_of_bodies_give_what_the_whole_scene_gives) {
    for (const double speed : {0.1, 1.0, 5.0}) {
        SCOPED_TRACE(speed);
        Scene scene = gas(speed, 20);
        for (const bool periodic : {false, true}) {
            if (periodic) {
                scene.periodic = physics::Periodic{scene.walls->min_m, scene.walls->max_m};
                scene.walls.reset();
            }
            const auto grouped = exact_tick(scene, 1.0 / 60.0, 1e7);
            Oracle whole(scene);
            whole.advance(1.0 / 60.0);
            ASSERT_TRUE(grouped);
            ASSERT_EQ(grouped->contacts.size(), whole.contacts().size());
            const auto after = whole.bodies();
            for (std::size_t i = 0; i < after.size(); ++i) {
                const Vec2d difference = grouped->velocity_after_mps[i] - after[i].velocity_mps;
                EXPECT_LT(difference.norm(), 1e-9 * speed) << "body " << i;
            }
        }
    }
}

TEST(ExactTick, gives_up_rather_than_work_without_end) {
    EXPECT_FALSE(exact_tick(gas(50.0), 1.0 / 60.0, 500.0));
}

TEST(Divergence, independent_collisions_may_come_in_any_order) {
    const std::vector<Hit> exact = {{0, 1, 0.1}, {2, 3, 0.2}, {0, 2, 0.3}, {1, 3, 0.4}};
    const std::vector<Hit> swapped = {{2, 3, 0.2}, {0, 1, 0.2}, {1, 3, 0.3}, {0, 2, 0.4}};
    EXPECT_FALSE(divergence(exact, swapped, 4, 1.0, 0.1, 0.0).reached);
    EXPECT_EQ(divergence(exact, swapped, 4, 1.0, 0.1, 0.0).collisions, 4U);
    const std::vector<Hit> wrong = {{0, 1, 0.1}, {2, 3, 0.2}, {0, 3, 0.3}};
    EXPECT_TRUE(divergence(exact, wrong, 4, 1.0, 0.1, 0.0).reached);
    EXPECT_EQ(divergence(exact, wrong, 4, 1.0, 0.1, 0.0).collisions, 2U);
}

TEST(Divergence, what_is_still_to_come_in_the_last_tick_is_not_wrong) {
    const std::vector<Hit> exact = {{0, 1, 0.1}, {0, kFirstWall, 0.95}};
    EXPECT_FALSE(divergence(exact, {{0, 1, 0.1}}, 2, 1.0, 0.1, 0.0).reached);
    EXPECT_TRUE(divergence(exact, {{0, 1, 0.1}}, 2, 1.0, 0.01, 0.0).reached);
}

TEST(Pareto, keeps_what_nothing_beats) {
    const std::vector<CostAndError> choices = {{1.0, 0.5}, {2.0, 0.5}, {3.0, 0.1},
                                               {2.5, 0.2}, {9.0, 0.1}, {0.5, std::nan("")},
                                               {4.0, 0.0}};
    EXPECT_THAT(pareto_front(choices), ElementsAre(0, 3, 2, 6));
    EXPECT_TRUE(pareto_front({}).empty());
}

TEST(Compare, has_a_row_for_every_setting_and_the_command_that_makes_it_again) {
    const CompareRequest request = request_for(gas(0.2));
    const Comparison comparison = compare(request, always, [](auto, auto, const auto&) {});
    ASSERT_EQ(comparison.rows.size(), 6U);
    EXPECT_FALSE(comparison.stopped());
    double cost = 0.0;
    std::size_t optimal = 0;
    for (const CompareRow& row : comparison.rows) {
        EXPECT_GE(row.cost.ns_per_body_tick, cost);
        cost = row.cost.ns_per_body_tick;
        optimal += row.pareto ? 1 : 0;
        EXPECT_THAT(row.command, HasSubstr(flags_of(row.setting)));
    }
    EXPECT_GE(optimal, 1U);
    EXPECT_TRUE(comparison.rows.front().pareto) << "nothing is cheaper than the cheapest";

    const std::string table = table_of(request, comparison);
    EXPECT_THAT(table, HasSubstr("discrete x4 float"));
    EXPECT_THAT(table, HasSubstr("fts-lab compare some.scene --seconds 0.5 --rate 60"));
    const auto json = nlohmann::json::parse(json_of(request, comparison));
    ASSERT_EQ(json["rows"].size(), 6U);
    EXPECT_TRUE(json["rows"][0]["local"]["collision_error"].is_number());
    EXPECT_THAT(svg_of(request, comparison), HasSubstr("swept float"));
}

TEST(Compare, keeps_what_is_done_when_it_is_stopped) {
    const CompareRequest request = request_for(gas(0.2));
    std::size_t asked_after = 0;
    bool on = true;
    const auto third = [&](std::size_t done, std::size_t, const Setting&) {
        asked_after = done;
        on = done < 2;
    };
    const Comparison comparison = compare(
        request, [&] { return on; }, third);
    EXPECT_EQ(asked_after, 2U);
    EXPECT_EQ(comparison.rows.size(), 2U);
    EXPECT_TRUE(comparison.stopped());
    EXPECT_THAT(table_of(request, comparison), HasSubstr("stopped after 2 of 6"));
    EXPECT_TRUE(nlohmann::json::parse(json_of(request, comparison))["stopped"].get<bool>());
}

TEST(Compare, leaves_out_what_would_take_minutes_and_says_so) {
    CompareRequest request = request_for(gas(0.1));
    request.solvers = {SolverKind::kSeed};
    request.substeps = {physics::kMaxSubsteps};
    request.scalars = {ScalarKind::kDouble};
    request.seconds = 1e6;
    request.sampling.work_of_reference = 1e3;
    const Comparison comparison = compare(request, always, [](auto, auto, const auto&) {});
    ASSERT_EQ(comparison.rows.size(), 1U);
    EXPECT_THAT(comparison.rows[0].skipped, HasSubstr("every pair"));
    EXPECT_THAT(table_of(request, comparison), HasSubstr("left out"));
    EXPECT_TRUE(svg_of(request, comparison).empty());
}

}  // namespace
}  // namespace fts::lab
