// The check that a hit kept momentum and energy finds what is wrong, and nothing where all is
// right.
#include "client/bot/conservation.h"

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace fts::bot {
namespace {

using physics::Vec2d;
using replication::CollisionReport;

CollisionReport elastic_hit(std::mt19937& random) {
    std::uniform_real_distribution<> any(-1.0, 1.0);
    CollisionReport hit;
    hit.own.mass_kg = 0.2 + 5.0 * std::abs(any(random));
    hit.other.mass_kg = 0.2 + 5.0 * std::abs(any(random));
    hit.own.velocity_before_mps = 9.0 * Vec2d(any(random), any(random));
    hit.other.velocity_before_mps = 9.0 * Vec2d(any(random), any(random));
    hit.normal = Vec2d(any(random), any(random)).normalized();
    const double approach_mps =
        (hit.other.velocity_before_mps - hit.own.velocity_before_mps).dot(hit.normal);
    hit.impulse_ns = 2.0 * approach_mps * hit.own.mass_kg * hit.other.mass_kg /
                     (hit.own.mass_kg + hit.other.mass_kg);
    hit.own.velocity_after_mps =
        hit.own.velocity_before_mps + hit.normal * (hit.impulse_ns / hit.own.mass_kg);
    hit.other.velocity_after_mps =
        hit.other.velocity_before_mps - hit.normal * (hit.impulse_ns / hit.other.mass_kg);
    return hit;
}

TEST(Conservation, holds_to_round_off_for_elastic_hits) {
    std::mt19937 random(11);
    for (int i = 0; i < 1000; ++i) {
        const auto error = conservation_error(elastic_hit(random));
        ASSERT_TRUE(error);
        EXPECT_LT(error->momentum, 1e-14);
        EXPECT_LT(error->energy, 1e-13);
    }
}

TEST(Conservation, finds_energy_that_was_lost_and_momentum_that_was_gained) {
    std::mt19937 random(12);
    CollisionReport hit = elastic_hit(random);
    hit.own.velocity_after_mps *= 1.0 + 1e-6;
    const auto error = conservation_error(hit);
    ASSERT_TRUE(error);
    EXPECT_GT(error->momentum, 1e-9);
    EXPECT_GT(error->energy, 1e-9);
}

TEST(Conservation, has_nothing_to_say_about_what_is_not_finite_or_shared) {
    std::mt19937 random(13);
    CollisionReport hit = elastic_hit(random);
    hit.other.velocity_after_mps.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(conservation_error(hit));
    hit = elastic_hit(random);
    hit.own.mass_kg = 0.0;
    EXPECT_FALSE(conservation_error(hit));
    hit = elastic_hit(random);
    hit.contacts_at_once = 2;
    EXPECT_FALSE(conservation_error(hit)) << "a third ball has its share";
}

TEST(HitsCsv, has_as_many_values_in_a_line_as_names_in_the_heading) {
    std::mt19937 random(14);
    CollisionReport hit = elastic_hit(random);
    const std::string heading(hits_csv_heading());
    const std::string line = hits_csv_line(3, hit);
    EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(heading, ','));
    hit.own.mass_kg = -1.0;
    const std::string unsound = hits_csv_line(3, hit);
    EXPECT_EQ(std::ranges::count(unsound, ','), std::ranges::count(heading, ','));
}

}  // namespace
}  // namespace fts::bot
