// feature-cost SOLVER FEATURE TICKS: advances one scene, as it is or with one feature more, for
// scripts/feature-cost to count the instructions of. The scene is 2,000 equal balls in the open
// that cover 30 % of their square and move 0.05 of a radius a tick; a feature changes next to
// nothing of what happens in it.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "common/physics/world.h"

namespace {

using fts::physics::Scene;
using fts::physics::Vec2d;

constexpr int kRows = 45;  // balls: rows by rows, less what is beyond kBalls
constexpr std::size_t kBalls = 2000;
constexpr double kRadiusM = 0.5;
constexpr double kPacking = 0.3;
constexpr double kTickS = 1.0 / 60.0;
constexpr double kRadiiPerTick = 0.05;
constexpr int kWarmUpTicks = 40;

double width_m() {
    return std::sqrt(kBalls * std::numbers::pi / kPacking) * kRadiusM;
}

Scene plain_scene() {
    std::mt19937_64 engine(2013);
    const auto between = [&](double low, double high) {
        return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
    };
    const double speed_mps = kRadiiPerTick * kRadiusM / kTickS * std::sqrt(1.5);
    const double spacing_m = width_m() / kRows;
    const double jitter_m = 0.5 * spacing_m - kRadiusM;
    Scene scene;
    for (std::size_t i = 0; i < kBalls; ++i) {
        const double column = static_cast<double>(i % kRows), row = static_cast<double>(i / kRows);
        const Vec2d place = Vec2d(column + 0.5, row + 0.5) * spacing_m;
        const double x = between(-jitter_m, jitter_m), y = between(-jitter_m, jitter_m);
        const double vx = between(-speed_mps, speed_mps), vy = between(-speed_mps, speed_mps);
        scene.bodies.push_back({place + Vec2d(x, y), {vx, vy}, kRadiusM, 1.0});
    }
    return scene;
}

// Walls and a platform are a ball's width outside, so that few ever reach them.
const std::map<std::string, std::function<void(Scene&)>>& features() {
    const Vec2d margin = Vec2d::Constant(2.0 * kRadiusM);
    static const std::map<std::string, std::function<void(Scene&)>> kFeatures = {
        {"none", [](Scene&) {}},
        {"drag", [](Scene& scene) { scene.drag_per_s = 1e-9; }},
        {"walls",
         [margin](Scene& scene) {
             scene.walls = {-margin, Vec2d::Constant(width_m()) + margin};
         }},
        {"unequal-masses", [](Scene& scene) { scene.bodies[0].mass_kg *= 1.0 + 1e-9; }},
        {"unequal-radii", [](Scene& scene) { scene.bodies[0].radius_m *= 1.0 - 1e-9; }},
        {"periodic",
         [margin](Scene& scene) {
             scene.periodic = {-margin, Vec2d::Constant(width_m()) + margin};
         }},
        {"platform", [](Scene& scene) { scene.platform = fts::physics::Disc{4.0 * width_m()}; }},
    };
    return kFeatures;
}

}  // namespace

// By this name valgrind is told what to count.
extern "C" [[gnu::noinline]] void fts_counted_ticks(fts::physics::World<double>& world, int ticks) {
    for (int tick = 0; tick < ticks; ++tick) world.step(kTickS);
}

int main(int argc, char** argv) {
    const std::string solver_name = argc == 4 ? argv[1] : "", feature = argc == 4 ? argv[2] : "";
    const auto solver = fts::physics::solver_from(solver_name);
    const int ticks = argc == 4 ? std::atoi(argv[3]) : 0;
    const auto found = features().find(feature);
    if (!solver || found == features().end() || ticks < 1) {
        std::fputs("Usage: feature-cost seed|discrete|swept|event FEATURE TICKS\nFeatures:",
                   stderr);
        for (const auto& [name, apply] : features()) std::fprintf(stderr, " %s", name.c_str());
        std::fputs("\n", stderr);
        return 2;
    }
    Scene scene = plain_scene();
    found->second(scene);
    fts::physics::World<double> world(scene, {*solver, 1});
    for (int tick = 0; tick < kWarmUpTicks; ++tick) world.step(kTickS);
    const auto before = world.audit().ball_collisions;
    fts_counted_ticks(world, ticks);
    std::printf("%zu %llu\n", kBalls,
                static_cast<unsigned long long>(world.audit().ball_collisions - before));
    return 0;
}
