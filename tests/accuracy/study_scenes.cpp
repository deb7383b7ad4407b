#include "tests/accuracy/study_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "common/physics/generator.h"
#include "tests/physics/dice.h"

namespace fts::accuracy {
namespace {

using physics::BodyDef;
using physics::Dice;
using physics::Scene;
using physics::Vec2d;

constexpr std::uint64_t kSeed = 2013;
constexpr std::size_t kBalls = 100;
constexpr const char* kPairsOfMass = "pairs-of-mass-";
constexpr const char* kPairsOff = "pairs-off-";

double speed_mps(double radii_per_tick) {
    return radii_per_tick * kRadiusM / kTickS;
}

// Enskog's rate of collisions in a gas of discs, with Henderson's contact value.
double collisions_per_tick(std::size_t balls, double packing, double radii_per_tick) {
    const double crowding = (1.0 - 7.0 / 16.0 * packing) / ((1.0 - packing) * (1.0 - packing));
    const double of_a_ball =
        4.0 * packing * crowding * radii_per_tick / std::sqrt(2.0 * std::numbers::pi);
    return 0.5 * static_cast<double>(balls) * of_a_ball;
}

StudyScene gas(std::size_t balls, double packing, double radii_per_tick, std::uint64_t seed) {
    Scene scene;
    scene.periodic = physics::Periodic{};
    auto filled = physics::fill(scene, {.seed = seed,
                                        .count = static_cast<std::int64_t>(balls),
                                        .packing_fraction = packing,
                                        .radius_min_m = kRadiusM,
                                        .radius_max_m = kRadiusM,
                                        .speed_rms_mps = speed_mps(radii_per_tick)});
    if (const auto* error = std::get_if<physics::SceneError>(&filled)) {
        std::fprintf(stderr, "accuracy-study: %s\n", error->message.c_str());
        std::exit(1);
    }
    return {std::get<Scene>(std::move(filled)), collisions_per_tick(balls, packing, radii_per_tick),
            0};
}

StudyScene heavy_light(double radii_per_tick) {
    StudyScene study = gas(kBalls, 0.3, radii_per_tick, kSeed);
    for (std::size_t i = 0; i < study.scene.bodies.size(); i += 2) {
        study.scene.bodies[i].mass_kg = 100.0;
    }
    return study;
}

StudyScene rack(double radii_per_tick) {
    StudyScene study;
    for (int row = 0; row < 5; ++row) {
        for (int k = 0; k <= row; ++k) {
            const Vec2d place((row * std::sqrt(3.0)) * kRadiusM, (2 * k - row) * kRadiusM);
            study.scene.bodies.push_back({place, Vec2d::Zero(), kRadiusM, 1.0});
        }
    }
    // Not quite in the middle, so that no symmetry helps.
    const Vec2d start(-4.0 * kRadiusM - 3.3 * radii_per_tick * kRadiusM, 0.1 * kRadiusM);
    study.scene.bodies.push_back({start, Vec2d(speed_mps(radii_per_tick), 0.0), kRadiusM, 1.0});
    study.ticks = static_cast<std::size_t>(std::ceil(12.0 + 60.0 / radii_per_tick));
    return study;
}

// The one ball of a pair rests.
struct PairOf {
    double impact_parameter = 0.5;
    double mass_ratio = 1.0;    // of the ball at rest to the other
    double offset_radii = 0.0;  // of the whole scene from the origin
};

// Far enough apart that no pair hears of another.
StudyScene pairs(const PairOf& kind, double radii_per_tick) {
    StudyScene study;
    const double impact_parameter = kind.impact_parameter;
    // Masses around 1 kg, so that both ends of the range stay within what a scene may have.
    const double moving_kg = 1.0 / std::sqrt(kind.mass_ratio);
    const Vec2d origin(kind.offset_radii * kRadiusM, kind.offset_radii * kRadiusM);
    Dice dice(kSeed);
    const double reach = 2.0 * kRadiusM;
    const double ticks = 8.0;
    const double spacing = 4.0 * (reach + 2.0 * ticks * radii_per_tick * kRadiusM);
    for (int i = 0; i < 64; ++i) {
        const Vec2d centre = origin + Vec2d(spacing * (i % 8), spacing * (i / 8));
        const double angle = dice.between(0.0, 2.0 * std::numbers::pi);
        const Vec2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
        const double chord = std::sqrt(1.0 - impact_parameter * impact_parameter);
        const double before_ticks = dice.between(1.0, ticks - 1.0);
        const double behind = reach * chord + before_ticks * radii_per_tick * kRadiusM;
        study.scene.bodies.push_back(
            {centre, Vec2d::Zero(), kRadiusM, kind.mass_ratio * moving_kg});
        study.scene.bodies.push_back({centre - behind * along + impact_parameter * reach * across,
                                      speed_mps(radii_per_tick) * along, kRadiusM, moving_kg});
    }
    study.ticks = 2 * static_cast<std::size_t>(ticks);
    return study;
}

}  // namespace

lab::Run StudyScene::run(double collisions) const {
    if (ticks > 0) return {ticks, kTickS};
    const double needed = std::ceil(collisions / collisions_per_tick);
    return {static_cast<std::size_t>(std::clamp(needed, 8.0, 40'000.0)), kTickS};
}

const std::vector<std::string>& gas_names() {
    static const std::vector<std::string> kNames = {"gas-dilute", "gas-medium", "gas-dense",
                                                    "heavy-light"};
    return kNames;
}

const std::vector<double>& impact_parameters() {
    static const std::vector<double> kParameters = {0.0, 0.25, 0.5, 0.75, 0.9, 0.99};
    return kParameters;
}

std::string pairs_name(double impact_parameter) {
    char text[16];
    std::snprintf(text, sizeof text, "pairs-%.2f", impact_parameter);
    return text;
}

const std::vector<double>& mass_ratios() {
    static const std::vector<double> kRatios = {1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12};
    return kRatios;
}

std::string pairs_of_mass_name(double ratio) {
    char text[24];
    std::snprintf(text, sizeof text, "%s%.0e", kPairsOfMass, ratio);
    return text;
}

const std::vector<double>& offsets_radii() {
    static const std::vector<double> kOffsets = {1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
    return kOffsets;
}

std::string pairs_off_name(double radii) {
    char text[24];
    std::snprintf(text, sizeof text, "%s%.0e", kPairsOff, radii);
    return text;
}

StudyScene study_scene(const std::string& name, double radii_per_tick) {
    if (name == "gas-dilute") return gas(kBalls, 0.05, radii_per_tick, kSeed);
    if (name == "gas-medium") return gas(kBalls, 0.3, radii_per_tick, kSeed);
    if (name == "gas-dense") return gas(kBalls, 0.7, radii_per_tick, kSeed);
    if (name == "heavy-light") return heavy_light(radii_per_tick);
    if (name == "rack") return rack(radii_per_tick);
    const auto number_after = [&](const std::string& prefix) {
        return std::strtod(name.c_str() + prefix.size(), nullptr);
    };
    if (name.starts_with(kPairsOfMass)) {
        return pairs({.mass_ratio = number_after(kPairsOfMass)}, radii_per_tick);
    }
    if (name.starts_with(kPairsOff)) {
        return pairs({.offset_radii = number_after(kPairsOff)}, radii_per_tick);
    }
    return pairs({.impact_parameter = number_after("pairs-")}, radii_per_tick);
}

StudyScene medium_gas(std::size_t balls, double radii_per_tick, std::uint64_t seed) {
    return gas(balls, 0.3, radii_per_tick, seed);
}

}  // namespace fts::accuracy
