#include "server/lab/bench/specimen.h"

#include <chrono>
#include <cmath>

#include "common/physics/splitmix.h"

namespace fts::lab {
namespace {

constexpr std::size_t kWarmUpTicks = 60;
constexpr double kWarmUpS = 3.0;
constexpr std::size_t kMostBallsKept = 400'000;
constexpr std::uint64_t kSeedOfPairs = 2013;

double kinetic_energy_j(const physics::Scene& scene, const Engine& engine) {
    double sum = 0.0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        sum += 0.5 * scene.bodies[i].mass_kg * engine.ball(i).velocity_mps.squaredNorm();
    }
    return sum;
}

// In rows and columns far enough apart that no pair ever meets another.
physics::Scene pairs_at(double closing_mps, std::size_t pairs, double room_m) {
    physics::SplitMix random(kSeedOfPairs);
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(pairs))));
    physics::Scene scene;
    for (std::size_t k = 0; k < pairs; ++k) {
        const std::size_t row = k / columns, column = k % columns;
        const physics::Vec2d middle(static_cast<double>(column) * room_m,
                                    static_cast<double>(row) * 4.0 * kBenchRadiusM);
        const double until_touch_s = (0.5 + random.uniform()) * kBenchTickS;
        const physics::Vec2d half(kBenchRadiusM + 0.5 * closing_mps * until_touch_s, 0.0);
        const physics::Vec2d velocity(0.5 * closing_mps, 0.0);
        scene.bodies.push_back({middle - half, velocity, kBenchRadiusM, 1.0});
        scene.bodies.push_back({middle + half, -velocity, kBenchRadiusM, 1.0});
    }
    return scene;
}

}  // namespace

HeadOn shoot_head_on(const std::string& engine, double closing_radii_per_tick, std::size_t pairs) {
    // Until the last pair has met, crossed the four radii of its overlap, and been looked at once
    // more.
    const auto ticks = static_cast<std::size_t>(std::ceil(3.5 + 4.0 / closing_radii_per_tick));
    const double closing_mps = closing_radii_per_tick * kBenchRadiusM / kBenchTickS;
    const double room_m =
        8.0 * kBenchRadiusM + 2.0 * closing_mps * static_cast<double>(ticks) * kBenchTickS;
    const auto shooting = make_engine(engine, pairs_at(closing_mps, pairs, room_m), kBenchTickS);
    for (std::size_t tick = 0; tick < ticks; ++tick) shooting->step();
    HeadOn result{pairs, 0};
    for (std::size_t k = 0; k < pairs; ++k) {
        const double left = shooting->ball(2 * k).position_m.x();
        const double right = shooting->ball(2 * k + 1).position_m.x();
        if (!(left < right)) ++result.through;
    }
    return result;
}

Specimen::Specimen(const BenchCell& cell) {
    const physics::Scene scene = balls_of(cell.scene);
    engine_ = make_engine(cell.engine, scene, kBenchTickS);
    const double before_j = kinetic_energy_j(scene, *engine_);
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(kWarmUpS);
    while (laws_.ticks < kWarmUpTicks && (laws_.ticks < 2 || Clock::now() < end)) {
        engine_->step();
        ++laws_.ticks;
    }
    const double error = std::abs(kinetic_energy_j(scene, *engine_) / before_j - 1.0);
    laws_.energy_error = std::isfinite(error) ? error : kEnergyLost;
}

Specimen& SpecimenStore::get(const BenchCell& cell) {
    const std::string name = name_of(cell);
    if (const auto found = specimens_.find(name); found != specimens_.end()) return found->second;
    if (balls_ + cell.scene.balls > kMostBallsKept) {
        specimens_.clear();
        balls_ = 0;
    }
    balls_ += cell.scene.balls;
    Specimen& specimen = specimens_.emplace(name, cell).first->second;
    if (find_engine(cell.engine)->is_floor) return specimen;
    const double speed = cell.scene.radii_per_tick;
    const auto [head_on, is_new] = head_on_.try_emplace({cell.engine, speed});
    if (is_new) head_on->second = shoot_head_on(cell.engine, 2.0 * speed, kHeadOnPairs);
    specimen.set(head_on->second);
    return specimen;
}

}  // namespace fts::lab
