#include "server/lab/bench/specimen.h"

#include <algorithm>
#include <cmath>

#include "common/physics/splitmix.h"

namespace fts::lab {
namespace {

constexpr double kMostWarmUpTicks = 60.0;
constexpr double kFewestWarmUpTicks = 5.0;
// Radii that all balls together move in a warm-up. The slowest engine takes some 25 us for one.
constexpr double kWarmUpRadii = 200'000.0;
constexpr double kLeastRadiiPerTick = 0.1;  // slower balls cost as much
// A million, and beside them what is compared with them.
constexpr std::size_t kMostBallsKept = 1'500'000;
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

std::size_t warm_up_ticks(const BenchScene& scene) {
    const double radii_a_tick =
        static_cast<double>(scene.balls) * std::max(scene.radii_per_tick, kLeastRadiiPerTick);
    const double until_a_radius = std::ceil(1.0 / scene.radii_per_tick);
    const double fewest = std::clamp(until_a_radius, kFewestWarmUpTicks, kMostWarmUpTicks);
    return static_cast<std::size_t>(
        std::clamp(std::floor(kWarmUpRadii / radii_a_tick), fewest, kMostWarmUpTicks));
}

Specimen::Specimen(const BenchCell& cell) {
    const physics::Scene scene = balls_of(cell.scene);
    engine_ = make_engine(cell.engine, scene, kBenchTickS);
    const double before_j = kinetic_energy_j(scene, *engine_);
    laws_.ticks = warm_up_ticks(cell.scene);
    for (std::size_t tick = 0; tick < laws_.ticks; ++tick) engine_->step();
    const double error = std::abs(kinetic_energy_j(scene, *engine_) / before_j - 1.0);
    laws_.energy_error = std::isfinite(error) ? error : kEnergyLost;
}

Specimen* SpecimenStore::make(const BenchCell& cell, std::string& not_run) {
    std::string& refused = refused_[text_of(cell.scene)];
    if (refused.empty()) {
        try {
            return &specimens_.emplace(name_of(cell), cell).first->second;
        } catch (const SceneRefused& error) {
            refused = std::string("not run: ") + error.what();
        }
    }
    not_run = refused;
    return nullptr;
}

Specimen* SpecimenStore::get(const BenchCell& cell, std::string& not_run) {
    const auto found = specimens_.find(name_of(cell));
    if (found != specimens_.end()) return &found->second;
    if (balls_ + cell.scene.balls > kMostBallsKept) {
        specimens_.clear();
        balls_ = 0;
    }
    Specimen* const specimen = make(cell, not_run);
    if (specimen == nullptr) return nullptr;
    balls_ += cell.scene.balls;
    if (find_engine(cell.engine)->is_floor) return specimen;
    const double speed = cell.scene.radii_per_tick;
    const auto [head_on, is_new] = head_on_.try_emplace({cell.engine, speed});
    if (is_new) head_on->second = shoot_head_on(cell.engine, 2.0 * speed, kHeadOnPairs);
    specimen->set(head_on->second);
    return specimen;
}

}  // namespace fts::lab
