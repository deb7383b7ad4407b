// Random clusters of touching balls, resolved without a solver.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "common/physics/cone_projection.h"
#include "common/physics/impact.h"
#include "common/physics/simultaneous.h"
#include "tests/physics/allocation_count.h"
#include "tests/physics/dice.h"

namespace fts::physics {
namespace {

struct Cluster {
    std::vector<BodyDef> bodies;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> contacts;
};

constexpr double kTouchM = 1e-9;

void find_contacts(Cluster& cluster) {
    for (std::uint32_t b = 0; b < cluster.bodies.size(); ++b) {
        for (std::uint32_t a = 0; a < b; ++a) {
            const BodyDef &first = cluster.bodies[a], &second = cluster.bodies[b];
            const double reach = first.radius_m + second.radius_m;
            if ((first.position_m - second.position_m).norm() < reach + kTouchM) {
                cluster.contacts.push_back({a, b});
            }
        }
    }
}

// Touches both, on the left as one looks from the first to the second. NaN when it cannot.
Vec2d place_beside(const BodyDef& first, const BodyDef& second, double radius_m) {
    const Vec2d apart = second.position_m - first.position_m;
    const double d = apart.norm(), r1 = first.radius_m + radius_m, r2 = second.radius_m + radius_m;
    const double along = (d * d + r1 * r1 - r2 * r2) / (2.0 * d);
    const Vec2d side(-apart.y(), apart.x());
    return first.position_m + apart * (along / d) + side * (std::sqrt(r1 * r1 - along * along) / d);
}

bool is_clear(const Cluster& cluster, const BodyDef& ball) {
    return std::all_of(cluster.bodies.begin(), cluster.bodies.end(), [&](const BodyDef& other) {
        return (other.position_m - ball.position_m).norm() > other.radius_m + ball.radius_m - 1e-12;
    });
}

struct Sizes {
    double least_mass_kg = 0.1;
    double greatest_mass_kg = 10.0;
};

// Each new ball touches two that are there, so that there are nearly twice as many contacts as
// balls.
Cluster random_cluster(std::size_t balls, Dice& dice, const Sizes& sizes = {}) {
    Cluster cluster;
    while (cluster.bodies.size() < balls) {
        BodyDef ball;
        ball.radius_m = dice.between(0.3, 0.6);
        ball.mass_kg = dice.of_any_size(sizes.least_mass_kg, sizes.greatest_mass_kg);
        ball.velocity_mps = dice.in_box(3.0);
        if (cluster.bodies.size() == 1) {
            ball.position_m = {cluster.bodies[0].radius_m + ball.radius_m, 0.0};
        } else if (cluster.bodies.size() > 1) {
            const std::size_t i = dice.below(cluster.bodies.size());
            const std::size_t j = dice.below(cluster.bodies.size());
            if (i == j) continue;
            ball.position_m = place_beside(cluster.bodies[i], cluster.bodies[j], ball.radius_m);
        }
        if (ball.position_m.allFinite() && is_clear(cluster, ball)) cluster.bodies.push_back(ball);
    }
    find_contacts(cluster);
    return cluster;
}

Cluster crystal(int side, Dice& dice) {
    Cluster cluster;
    for (int row = 0; row < side; ++row) {
        for (int i = 0; i < side; ++i) {
            const Vec2d place(i + 0.5 * (row % 2), row * std::sqrt(0.75));
            cluster.bodies.push_back({place, dice.in_box(1.0), 0.5, 1.0});
        }
    }
    find_contacts(cluster);
    return cluster;
}

struct Resolved {
    std::vector<Vec2d> velocities_mps;
    Resolution done;
};

Resolution resolve(const Cluster& cluster, double restitution, ContactSet<double>& set) {
    set.begin(static_cast<std::uint32_t>(cluster.bodies.size()));
    for (std::uint32_t i = 0; i < cluster.bodies.size(); ++i) {
        set.add(i, cluster.bodies[i].velocity_mps, cluster.bodies[i].mass_kg, false);
    }
    for (const auto& [a, b] : cluster.contacts) {
        set.touch(a, b, cluster.bodies[a].position_m - cluster.bodies[b].position_m);
    }
    return set.resolve(
        restitution, [](std::uint32_t) {}, [](std::span<const Hit<double>>) {});
}

Resolved resolve(const Cluster& cluster, double restitution) {
    ContactSet<double> set;
    Resolved resolved;
    resolved.done = resolve(cluster, restitution, set);
    for (std::uint32_t i = 0; i < cluster.bodies.size(); ++i) {
        resolved.velocities_mps.push_back(set.velocity_mps(i));
    }
    return resolved;
}

struct Sums {
    double energy_j = 0.0;
    Vec2d momentum_ns = Vec2d::Zero();
    double momenta_ns = 0.0;
};

Sums sums(const Cluster& cluster, const std::vector<Vec2d>& velocities_mps) {
    Sums sums;
    for (std::size_t i = 0; i < velocities_mps.size(); ++i) {
        const double mass = cluster.bodies[i].mass_kg;
        sums.energy_j += 0.5 * mass * velocities_mps[i].squaredNorm();
        sums.momentum_ns += mass * velocities_mps[i];
        sums.momenta_ns += mass * velocities_mps[i].norm();
    }
    return sums;
}

Sums sums_before(const Cluster& cluster) {
    std::vector<Vec2d> velocities;
    for (const BodyDef& body : cluster.bodies) velocities.push_back(body.velocity_mps);
    return sums(cluster, velocities);
}

void expect_conserved(const Cluster& cluster, const Resolved& resolved) {
    const Sums before = sums_before(cluster);
    const Sums after = sums(cluster, resolved.velocities_mps);
    EXPECT_NEAR(after.energy_j / before.energy_j, 1.0, 1e-12);
    EXPECT_LT((after.momentum_ns - before.momentum_ns).norm(), 1e-12 * before.momenta_ns);
}

void expect_parting(const Cluster& cluster, const Resolved& resolved, double within_mps = 1e-12) {
    for (const auto& [a, b] : cluster.contacts) {
        const Vec2d normal =
            (cluster.bodies[a].position_m - cluster.bodies[b].position_m).normalized();
        const Vec2d parting = resolved.velocities_mps[a] - resolved.velocities_mps[b];
        EXPECT_GE(parting.dot(normal), -within_mps) << a << " and " << b;
    }
}

double greatest_difference(const std::vector<Vec2d>& left, const std::vector<Vec2d>& right) {
    double greatest = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i) {
        greatest = std::max(greatest, (left[i] - right[i]).norm());
    }
    return greatest;
}

class RandomCluster : public testing::TestWithParam<std::uint64_t> {
  protected:
    Dice dice{GetParam()};
    Cluster cluster = random_cluster(2 + dice.below(16), dice);
};

TEST_P(RandomCluster, conserves_parts_and_ends) {
    SCOPED_TRACE(GetParam());
    const Resolved resolved = resolve(cluster, 1.0);
    EXPECT_FALSE(resolved.done.unfinished) << resolved.done.passes << " passes";
    expect_conserved(cluster, resolved);
    expect_parting(cluster, resolved);
}

TEST_P(RandomCluster, does_not_depend_on_the_order_of_contacts) {
    SCOPED_TRACE(GetParam());
    const Resolved expected = resolve(cluster, 1.0);
    for (int repeat = 0; repeat < 3; ++repeat) {
        Cluster shuffled = cluster;
        for (std::size_t i = shuffled.contacts.size(); i > 1; --i) {
            std::swap(shuffled.contacts[i - 1], shuffled.contacts[dice.below(i)]);
            if (dice.below(2) == 0)
                std::swap(shuffled.contacts[i - 1].first, shuffled.contacts[i - 1].second);
        }
        const Resolved resolved = resolve(shuffled, 1.0);
        EXPECT_LT(greatest_difference(expected.velocities_mps, resolved.velocities_mps), 1e-11);
        EXPECT_EQ(expected.done.passes, resolved.done.passes);
    }
}

TEST_P(RandomCluster, has_a_mirror_image_that_moves_as_its_mirror_image) {
    SCOPED_TRACE(GetParam());
    const Resolved expected = resolve(cluster, 1.0);
    Cluster mirror = cluster;
    for (BodyDef& body : mirror.bodies) {
        std::swap(body.position_m.x(), body.position_m.y());
        std::swap(body.velocity_mps.x(), body.velocity_mps.y());
    }
    Resolved resolved = resolve(mirror, 1.0);
    for (Vec2d& velocity : resolved.velocities_mps) std::swap(velocity.x(), velocity.y());
    EXPECT_LT(greatest_difference(expected.velocities_mps, resolved.velocities_mps), 1e-11);
}

TEST_P(RandomCluster, that_loses_energy_never_gains_any_and_parts) {
    SCOPED_TRACE(GetParam());
    double less = sums_before(cluster).energy_j * (1.0 + 1e-12);
    for (const double restitution : {0.99, 0.5, 0.0}) {
        SCOPED_TRACE(restitution);
        const Resolved resolved = resolve(cluster, restitution);
        const Sums after = sums(cluster, resolved.velocities_mps);
        EXPECT_FALSE(resolved.done.unfinished);
        EXPECT_LT((after.momentum_ns - sums_before(cluster).momentum_ns).norm(),
                  1e-12 * sums_before(cluster).momenta_ns);
        EXPECT_LE(after.energy_j, less);
        expect_parting(cluster, resolved);
    }
}

TEST_P(RandomCluster, of_masses_far_apart_conserves_and_parts) {
    SCOPED_TRACE(GetParam());
    const Cluster far = random_cluster(2 + dice.below(12), dice, {1e-6, 1e6});
    const Resolved resolved = resolve(far, 1.0);
    expect_conserved(far, resolved);
    if (!resolved.done.unfinished) expect_parting(far, resolved, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomCluster, testing::Range<std::uint64_t>(400, 500));

TEST(Crystal, of_four_hundred_balls_that_all_move_is_resolved_in_one_go) {
    for (const std::uint64_t seed : {501U, 502U}) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        const Cluster cluster = crystal(20, dice);
        EXPECT_GT(cluster.contacts.size(), 1000U);
        const Resolved resolved = resolve(cluster, 1.0);
        EXPECT_FALSE(resolved.done.unfinished) << resolved.done.passes << " passes";
        expect_conserved(cluster, resolved);
        expect_parting(cluster, resolved);
    }
}

// A row in which every contact approaches, the same everywhere.
Cluster shrinking_row(std::uint32_t balls) {
    Cluster row;
    for (std::uint32_t i = 0; i < balls; ++i) {
        const double x = i - 0.5 * (balls - 1);
        row.bodies.push_back({Vec2d(x, 0), Vec2d(-x, 0), 0.5, 1.0});
    }
    find_contacts(row);
    return row;
}

TEST(Row, that_shrinks_evenly_is_reflected_as_one) {
    for (const std::uint32_t balls : {10U, 150U, 500U}) {
        SCOPED_TRACE(balls);
        const Cluster row = shrinking_row(balls);
        const Resolved resolved = resolve(row, 1.0);
        EXPECT_EQ(resolved.done.passes, 1U);
        expect_conserved(row, resolved);
        for (std::uint32_t i = 0; i < balls; ++i) {
            const Vec2d& before = row.bodies[i].velocity_mps;
            EXPECT_LT((resolved.velocities_mps[i] + before).norm(), 1e-11 * balls) << i;
        }
    }
}

TEST(Row, too_long_to_be_solved_exactly_still_conserves_and_parts) {
    const Cluster row = shrinking_row(1500);
    EXPECT_GT(row.contacts.size(), kMaxExactContacts);
    const Resolved resolved = resolve(row, 1.0);
    EXPECT_FALSE(resolved.done.unfinished) << resolved.done.passes << " passes";
    expect_conserved(row, resolved);
    expect_parting(row, resolved);
}

TEST(ContactSet, a_pair_alone_collides_to_the_same_bits_as_impact) {
    constexpr std::uint64_t kSeed = 510;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (int i = 0; i < 200; ++i) {
        const Mover<double> first{dice.in_box(1.0), dice.in_box(1.0), dice.of_any_size(0.1, 10)};
        const Mover<double> second{dice.in_box(1.0), dice.in_box(1.0), dice.of_any_size(0.1, 10)};
        const auto expected = impact(first, second, 0.9);
        ContactSet<double> set;
        set.begin(2);
        set.add(0, first.velocity_mps, first.mass_kg, false);
        set.add(1, second.velocity_mps, second.mass_kg, false);
        set.touch(0, 1, first.position_m - second.position_m);
        const Resolution done = set.resolve(
            0.9, [](std::uint32_t) {}, [](std::span<const Hit<double>>) {});
        ASSERT_EQ(done.hits, expected ? 1U : 0U);
        if (!expected) continue;
        EXPECT_EQ(set.velocity_mps(0), expected->velocity_1_mps);
        EXPECT_EQ(set.velocity_mps(1), expected->velocity_2_mps);
        EXPECT_TRUE(set.keeps_apart(1, 0, second.position_m - first.position_m));
    }
}

TEST(ContactSet, that_has_warmed_up_asks_for_no_memory) {
    constexpr std::uint64_t kSeed = 511;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Cluster cluster = random_cluster(40, dice);
    ContactSet<double> set;
    const Resolution first = resolve(cluster, 1.0, set);
    const std::size_t before = allocations();
    EXPECT_GT(before, 0U);
    const Resolution second = resolve(cluster, 1.0, set);
    EXPECT_EQ(allocations(), before);
    EXPECT_EQ(first.hits, second.hits);
    EXPECT_GT(second.hits, 20U);
}

// A light ball between heavy ones is hit more often than one resolution allows.
TEST(ContactSet, says_when_it_did_not_finish_and_goes_on_when_asked_again) {
    Cluster cluster;
    cluster.bodies.push_back({Vec2d(0, 0), Vec2d(1, 0), 0.5, 1.0});
    cluster.bodies.push_back({Vec2d(1, 0), Vec2d(0, 0), 0.5, 1e-5});
    cluster.bodies.push_back({Vec2d(2, 0), Vec2d(0, 0), 0.5, 1.0});
    find_contacts(cluster);
    int resolutions = 0;
    for (bool unfinished = true; unfinished; ++resolutions) {
        ASSERT_LT(resolutions, 100);
        const Resolved resolved = resolve(cluster, 1.0);
        expect_conserved(cluster, resolved);
        unfinished = resolved.done.unfinished;
        if (unfinished) {
            EXPECT_EQ(resolved.done.passes, max_passes(2));
        } else {
            expect_parting(cluster, resolved);
        }
        for (std::size_t i = 0; i < 3; ++i) {
            cluster.bodies[i].velocity_mps = resolved.velocities_mps[i];
        }
    }
    EXPECT_GT(resolutions, 1);
}

// What minimises: no impulse pulls, no contact approaches, and who parts is not pushed.
TEST(ConeProjection, satisfies_the_conditions_of_the_minimum) {
    for (std::uint64_t seed = 520; seed < 560; ++seed) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        const Cluster cluster = random_cluster(3 + dice.below(30), dice);
        ConeProjection projection;
        projection.begin();
        std::vector<Vec2d> after;
        for (const BodyDef& body : cluster.bodies) {
            projection.add_body(1.0 / body.mass_kg);
            after.push_back(body.velocity_mps);
        }
        std::vector<Vec2d> normals;
        for (const auto& [a, b] : cluster.contacts) {
            const BodyDef &first = cluster.bodies[a], &second = cluster.bodies[b];
            normals.push_back((first.position_m - second.position_m).normalized());
            projection.add_contact(a, b, normals.back(),
                                   normals.back().dot(first.velocity_mps - second.velocity_mps));
        }
        const std::span<const double> impulses = projection.solve();
        for (std::size_t i = 0; i < impulses.size(); ++i) {
            ASSERT_GE(impulses[i], 0.0);
            const auto& [a, b] = cluster.contacts[i];
            after[a] += impulses[i] / cluster.bodies[a].mass_kg * normals[i];
            after[b] -= impulses[i] / cluster.bodies[b].mass_kg * normals[i];
        }
        for (std::size_t i = 0; i < impulses.size(); ++i) {
            const auto& [a, b] = cluster.contacts[i];
            const double parting = normals[i].dot(after[a] - after[b]);
            EXPECT_GE(parting, -1e-12);
            EXPECT_LT(std::abs(parting * impulses[i]), 1e-11);
        }
    }
}

}  // namespace
}  // namespace fts::physics
