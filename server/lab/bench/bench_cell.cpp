#include "server/lab/bench/bench_cell.h"

#include <algorithm>
#include <sstream>
#include <variant>

#include "common/physics/generator.h"
#include "server/lab/bench/engine.h"
#include "server/lab/digits.h"

namespace fts::lab {
namespace {

constexpr std::uint64_t kSeedOfScenes = 2013;
// Balls that are as fast meet far more others in a tick than they are near.
constexpr double kFastRadiiPerTick = 0.5;

// What follows "KEY:" in one part of a name.
template <typename Value>
bool read_part(std::istringstream& parts, const std::string& key, Value& value) {
    std::string part;
    if (!std::getline(parts, part, '/') || !part.starts_with(key + ":")) return false;
    std::istringstream text(part.substr(key.size() + 1));
    return static_cast<bool>(text >> value) && text.eof();
}

}  // namespace

std::string to_string(Radii radii) {
    return radii == Radii::kEqual ? "equal" : "unequal";
}

std::string grouped(std::size_t number) {
    std::string text = std::to_string(number);
    for (std::size_t end = text.size(); end > 3; end -= 3) text.insert(end - 3, ",");
    return text;
}

std::string name_of(const BenchCell& cell) {
    const BenchScene& scene = cell.scene;
    return cell.engine + "/N:" + std::to_string(scene.balls) +
           "/packing:" + with_digits("%g", scene.packing) + "/radii:" + to_string(scene.radii) +
           "/speed:" + with_digits("%g", scene.radii_per_tick);
}

std::optional<BenchCell> cell_from(const std::string& name) {
    BenchCell cell;
    std::istringstream parts(name);
    std::string radii;
    if (!std::getline(parts, cell.engine, '/') || !read_part(parts, "N", cell.scene.balls) ||
        !read_part(parts, "packing", cell.scene.packing) || !read_part(parts, "radii", radii) ||
        !read_part(parts, "speed", cell.scene.radii_per_tick)) {
        return std::nullopt;
    }
    if (radii != "equal" && radii != "unequal") return std::nullopt;
    cell.scene.radii = radii == "equal" ? Radii::kEqual : Radii::kUnequal;
    return cell;
}

std::string text_of(const BenchScene& scene) {
    return grouped(scene.balls) + " balls, packing " + with_digits("%g", scene.packing) + ", " +
           to_string(scene.radii) + " radii, " + with_digits("%g", scene.radii_per_tick) +
           " r a tick";
}

std::string reason_not_to_run(const BenchCell& cell) {
    const EngineInfo* const engine = find_engine(cell.engine);
    if (engine == nullptr) return "not in this build";
    const bool is_fast = cell.scene.radii_per_tick >= kFastRadiiPerTick;
    const std::size_t most =
        is_fast ? std::min(engine->max_balls, engine->max_fast_balls) : engine->max_balls;
    if (cell.scene.balls <= most) return {};
    return "not run: with more than " + grouped(most) + (is_fast ? " fast" : "") +
           " balls a tick may take seconds";
}

std::vector<BenchCell> cells_of(const BenchMatrix& matrix) {
    std::vector<BenchCell> cells;
    for (const std::size_t balls : matrix.balls) {
        for (const double packing : matrix.packings) {
            for (const Radii radii : matrix.radii) {
                for (const double speed : matrix.speeds) {
                    for (const std::string& engine : matrix.engines) {
                        cells.push_back({engine, {balls, packing, radii, speed}});
                    }
                }
            }
        }
    }
    return cells;
}

physics::Scene balls_of(const BenchScene& scene) {
    const bool equal = scene.radii == Radii::kEqual;
    physics::Generator generator;
    generator.seed = kSeedOfScenes;
    generator.count = static_cast<std::int64_t>(scene.balls);
    generator.packing_fraction = scene.packing;
    generator.radius_min_m = equal ? kBenchRadiusM : 0.5 * kBenchRadiusM;
    generator.radius_max_m = equal ? kBenchRadiusM : 1.5 * kBenchRadiusM;
    generator.mass = equal ? physics::MassRule::kEqual : physics::MassRule::kByArea;
    generator.speed_rms_mps = scene.radii_per_tick * kBenchRadiusM / kBenchTickS;
    auto filled = physics::fill({}, generator);
    if (const auto* const error = std::get_if<physics::SceneError>(&filled)) {
        throw SceneRefused(error->message);
    }
    return std::get<physics::Scene>(std::move(filled));
}

}  // namespace fts::lab
