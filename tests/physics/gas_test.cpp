// Gases of hard discs: what statistical mechanics says of them, and what many collisions leave of
// what is conserved. The exact solvers only; what the others do is measured in docs/accuracy.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/harness/sanitized.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

constexpr double kLongTick = 0.2;  // 0.4 radii at the speed of the start

class GasOfDiscs : public testing::TestWithParam<SolverKind> {};
INSTANTIATE_TEST_SUITE_P(Exact, GasOfDiscs, testing::Values(SolverKind::kSwept, SolverKind::kEvent),
                         name_of);

// Discs of radius 0.5 m and 1 kg on a hexagonal lattice in a periodic box, all with speed 1 m/s in
// directions that sum to no momentum. `rows` is even.
Scene hexagonal_gas(int columns, int rows, double packing, std::uint64_t seed) {
    constexpr double kRadiusM = 0.5;
    const double spacing_m =
        kRadiusM * std::sqrt(2.0 * std::numbers::pi / (std::sqrt(3.0) * packing));
    const Vec2d step(spacing_m, spacing_m * std::sqrt(3.0) / 2.0);
    Dice dice(seed);
    Scene scene;
    scene.periodic = {Vec2d::Zero(), Vec2d(columns * step.x(), rows * step.y())};
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const Vec2d place((column + 0.25 + 0.5 * (row % 2)) * step.x(), (row + 0.5) * step.y());
            const double angle = dice.between(0.0, 2.0 * std::numbers::pi);
            scene.bodies.push_back({place, Vec2d(std::cos(angle), std::sin(angle)), kRadiusM, 1.0});
        }
    }
    for (std::size_t i = 0; i + 1 < scene.bodies.size(); i += 2) {
        scene.bodies[i + 1].velocity_mps = -scene.bodies[i].velocity_mps;
    }
    EXPECT_FALSE(validate(scene));
    return scene;
}

void run_until(World<double>& world, std::uint64_t ball_collisions) {
    while (world.audit().ball_collisions < ball_collisions) {
        ASSERT_FALSE(world.step(kLongTick).overrun);
    }
}

TEST_P(GasOfDiscs, a_million_collisions_leave_energy_and_momentum_to_1e_minus_12) {
    constexpr std::uint64_t kCollisions = harness::kSanitized ? 50'000 : 1'000'000;
    const Scene scene = hexagonal_gas(16, 16, 0.6, 41);
    World<double> world(scene, {GetParam()});
    const double energy_j = world.kinetic_energy_j();
    const Vec2d momentum_ns = world.momentum_ns();
    const double sum_of_momenta_ns = static_cast<double>(scene.bodies.size());
    run_until(world, kCollisions);
    EXPECT_LE(std::abs(world.kinetic_energy_j() / energy_j - 1.0), 1e-12);
    EXPECT_LE((world.momentum_ns() - momentum_ns).norm(), 1e-12 * sum_of_momenta_ns);
    EXPECT_LE(world.deepest_overlap(), 1e-12);
    RecordProperty("energy_error", std::to_string(world.kinetic_energy_j() / energy_j - 1.0));
}

TEST_P(GasOfDiscs, moves_on_at_a_packing_fraction_of_0_88) {
    World<double> world(hexagonal_gas(12, 14, 0.88, 42), {GetParam()});
    const double energy_j = world.kinetic_energy_j();
    run_until(world, 50'000);
    EXPECT_LE(std::abs(world.kinetic_energy_j() / energy_j - 1.0), 1e-12);
    EXPECT_LE(world.deepest_overlap(), 1e-12);
}

// Back to the places of the start: what is lost on the way is round-off times what 1,000 collisions
// among 400 balls magnify it.
TEST_P(GasOfDiscs, time_reversal_after_a_thousand_collisions_returns_to_the_start) {
    const Scene scene = hexagonal_gas(20, 20, 0.5, 43);
    World<double> world(scene, {GetParam()});
    int ticks = 0;
    for (; world.audit().ball_collisions < 1000; ++ticks) world.step(kLongTick);
    reverse(world);
    for (int tick = 0; tick < ticks; ++tick) world.step(kLongTick);
    const Vec2d extent = scene.periodic->max_m - scene.periodic->min_m;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const auto body = world.body(world.ids()[i]);
        Vec2d off = body.position_m - scene.bodies[i].position_m;
        for (int axis = 0; axis < 2; ++axis) {
            off[axis] -= extent[axis] * std::round(off[axis] / extent[axis]);
        }
        ASSERT_LT(off.norm(), 1e-8);
        ASSERT_LT((body.velocity_mps + scene.bodies[i].velocity_mps).norm(), 1e-8);
    }
}

// Z = P A / (N k T), from the virial of the impulses: Z = 1 + sum(J R) / (2 N k T t), against the
// series of N. Clisby and B. M. McCoy, "Ninth and Tenth Order Virial Coefficients for Hard Spheres
// in D Dimensions" (2006), in powers of the packing fraction.
double virial_series(double packing) {
    constexpr std::array<double, 10> kCoefficients = {1.0,     2.0,     3.12801, 4.25785, 5.33690,
                                                      6.36296, 7.35186, 8.31910, 9.27214, 10.21629};
    double z = 0.0, power = 1.0;
    for (const double coefficient : kCoefficients) {
        z += coefficient * power;
        power *= packing;
    }
    return z;
}

double measured_compressibility(World<double>& world, std::uint64_t collisions) {
    const auto bodies = static_cast<double>(world.size());
    const double temperature_j = world.kinetic_energy_j() / (bodies - 1.0);
    run_until(world, collisions / 5);  // melt the lattice
    double virial_j_s = 0.0, time_s = 0.0;
    const std::uint64_t until = world.audit().ball_collisions + collisions;
    while (world.audit().ball_collisions < until) {
        world.step(kLongTick);
        time_s += kLongTick;
        for (const auto& contact : world.contacts()) virial_j_s += contact.impulse_ns * 1.0;
    }
    return 1.0 + virial_j_s / (2.0 * bodies * temperature_j * time_s);
}

TEST_P(GasOfDiscs, obeys_the_equation_of_state_to_a_percent_up_to_half_full) {
    for (const double packing : {0.05, 0.2, 0.35, 0.5}) {
        SCOPED_TRACE(packing);
        World<double> world(hexagonal_gas(16, 16, packing, 44), {GetParam()});
        const double z = measured_compressibility(world, harness::kSanitized ? 20'000 : 60'000);
        EXPECT_NEAR(z / virial_series(packing), 1.0, harness::kSanitized ? 0.02 : 0.01);
    }
}

// Chi-square of the kinetic energies against the exponential distribution, which is Maxwell's and
// Boltzmann's of speeds in the plane, in 20 bins of equal probability.
double chi_square(const std::vector<double>& energies, double mean) {
    constexpr std::size_t kBins = 20;
    std::array<double, kBins> seen{};
    for (const double energy : energies) {
        const double below = 1.0 - std::exp(-energy / mean);
        seen[std::min(kBins - 1, static_cast<std::size_t>(below * kBins))] += 1.0;
    }
    const double expected = static_cast<double>(energies.size()) / kBins;
    double sum = 0.0;
    for (const double count : seen) sum += (count - expected) * (count - expected) / expected;
    return sum;
}

void collect_energies(const World<double>& world, std::vector<double>& energies) {
    for (const BodyId id : world.ids()) {
        energies.push_back(0.5 * world.body(id).velocity_mps.squaredNorm());
    }
}

TEST_P(GasOfDiscs, forgets_its_start_and_has_maxwell_boltzmann_speeds) {
    constexpr double kOneInTenThousand = 50.8;  // of chi-square with 19 degrees of freedom
    World<double> world(hexagonal_gas(20, 20, 0.4, 45), {GetParam()});
    const double mean_j = world.kinetic_energy_j() / static_cast<double>(world.size());
    std::vector<double> energies;
    collect_energies(world, energies);
    EXPECT_GT(chi_square(energies, mean_j), 10.0 * kOneInTenThousand);  // all speeds are equal

    energies.clear();
    for (std::uint64_t sample = 1; sample <= 20; ++sample) {
        run_until(world, 4'000 + sample * 2'000);  // ten collisions a ball between samples
        collect_energies(world, energies);
    }
    EXPECT_LT(chi_square(energies, mean_j), kOneInTenThousand);
}

// Two balls that rattle in a box hardly larger than they are.
TEST(LongRun, a_hundred_million_collisions_keep_the_energy_to_1e_minus_9) {
#if defined(NDEBUG)
    constexpr std::uint64_t kCollisions = harness::kSanitized ? 500'000 : 100'000'000;
#else
    constexpr std::uint64_t kCollisions = 500'000;  // the optimised build does it all
#endif
    Scene scene;
    scene.walls = {Vec2d(-1.1, -0.8), Vec2d(1.1, 0.8)};
    scene.bodies = {{Vec2d(-0.55, 0.1), Vec2d(300.0, 170.0), 0.5, 1.0},
                    {Vec2d(0.55, -0.1), Vec2d(-210.0, 90.0), 0.5, 1.7}};
    World<double> world(scene);
    const double energy_j = world.kinetic_energy_j();
    while (world.audit().ball_collisions + world.audit().wall_collisions < kCollisions) {
        ASSERT_FALSE(world.step(1.0).overrun);
    }
    EXPECT_GT(world.audit().ball_collisions, kCollisions / 10);
    EXPECT_LE(std::abs(world.kinetic_energy_j() / energy_j - 1.0), 1e-9);
    EXPECT_LE(world.deepest_overlap(), 1e-12);
}

}  // namespace
}  // namespace fts::physics
