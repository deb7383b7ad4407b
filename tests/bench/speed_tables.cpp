#include "tests/bench/speed_tables.h"

#include <algorithm>
#include <functional>
#include <optional>

#include "server/lab/bench/engine.h"
#include "server/lab/digits.h"
#include "server/lab/text_table.h"
#include "tests/bench/bench_sets.h"

namespace fts::bench {
namespace {

using lab::BenchResult;
using lab::BenchScene;
using lab::TextTable;
using lab::with_digits;
using Results = std::vector<BenchResult>;

std::string ns_text(double ns) {
    return with_digits(ns < 10.0 ? "%.2f" : ns < 100.0 ? "%.1f" : "%.0f", ns);
}

BenchScene scene_at(std::size_t balls, double packing, double speed) {
    return {balls, packing, lab::Radii::kEqual, speed};
}

// How many times as long Chipmunk takes.
std::optional<double> ratio(const Results& results, const std::string& engine,
                            const BenchScene& scene) {
    const BenchResult* const result = lab::find_result(results, engine, scene);
    if (result == nullptr) return std::nullopt;
    return lab::times_faster_than_chipmunk(results, *result);
}

std::optional<double> hits_per_s(const Results& results, const BenchScene& scene) {
    const BenchResult* const result = lab::find_result(results, "event-double", scene);
    return result == nullptr ? std::nullopt : result->collisions_per_s;
}

// A million balls against ten thousand, per ball.
std::optional<double> growth_ratio(const Results& results) {
    const auto* const many =
        lab::find_result(results, "discrete-double", scene_at(1'000'000, 0.3, kSlow));
    const auto* const few =
        lab::find_result(results, "discrete-double", scene_at(10'000, 0.3, kSlow));
    if (many == nullptr || few == nullptr) return std::nullopt;
    return many->ns_per_ball_tick / few->ns_per_ball_tick;
}

accuracy::Table targets_table(const Results& targets, const Results& growth) {
    TextTable table({"what", "measured", "target", "reached"});
    const auto add = [&](const std::string& what, const std::optional<double>& value, double target,
                         bool at_least, const char* unit) {
        if (!value) return;
        const double scale = unit == std::string(" M/s") ? 1e-6 : 1.0;
        table.add(
            {what, with_digits("%.3g", *value * scale) + unit,
             (at_least ? "at least " : "at most ") + with_digits("%.3g", target * scale) + unit,
             (at_least ? *value >= target : *value <= target) ? "yes" : "no"});
    };
    const auto slow = scene_at(10'000, 0.3, kSlow), fast = scene_at(10'000, 0.3, kFast);
    add("`discrete` double, times as fast as Chipmunk", ratio(targets, "discrete-double", slow),
        25.0, true, "");
    add("`swept` double, times as fast as Chipmunk", ratio(targets, "swept-double", slow), 8.0,
        true, "");
    add("`swept` double at 2 r a tick, times as fast as Chipmunk",
        ratio(targets, "swept-double", fast), 10.0, true, "");
    add("`event` double, collisions", hits_per_s(targets, slow), 2e6, true, " M/s");
    add("`event` double, packing 0.1, collisions",
        hits_per_s(targets, scene_at(10'000, 0.1, kSlow)), 1e6, true, " M/s");
    add("`event` double, 100,000 balls, collisions",
        hits_per_s(targets, scene_at(100'000, 0.3, kSlow)), 0.7e6, true, " M/s");
    add("`discrete` double, cost of a ball among a million to one among 10,000",
        growth_ratio(growth), 2.5, false, "");
    return {"targets", table.markdown()};
}

// Time and the laws beside each other: a fast wrong answer is not a result.
accuracy::Table laws_table(const Results& results) {
    TextTable table({"engine", "ns, slow", "times Chipmunk", "energy", "through", "ns, fast",
                     "times Chipmunk", "energy", "through"});
    for (const lab::EngineInfo& engine : lab::engines()) {
        std::vector<std::string> row = {engine.title};
        for (const double speed : {kSlow, kFast}) {
            const auto* const result =
                lab::find_result(results, engine.name, scene_at(10'000, 0.3, speed));
            if (result == nullptr) break;
            const auto faster = lab::times_faster_than_chipmunk(results, *result);
            row.insert(
                row.end(),
                {ns_text(result->ns_per_ball_tick), faster ? with_digits("%.3g", *faster) : "-",
                 lab::energy_text(result->laws.energy_error),
                 result->laws.head_on ? with_digits("%.0f", result->laws.head_on->per_1000())
                                      : "-"});
        }
        if (row.size() > 1) table.add(row);
    }
    return {"laws", table.markdown()};
}

accuracy::Table growth_table(const Results& results) {
    const std::vector<std::size_t> sizes = {32, 320, 3'200, 10'000, 100'000, 1'000'000};
    std::vector<std::string> heads = {"engine"};
    for (const std::size_t size : sizes) heads.push_back(lab::grouped(size));
    TextTable table(heads);
    for (const lab::EngineInfo& engine : lab::engines()) {
        std::vector<std::string> row = {engine.title};
        for (const std::size_t size : sizes) {
            const auto* const result =
                lab::find_result(results, engine.name, scene_at(size, 0.3, kSlow));
            row.push_back(result == nullptr ? "-" : ns_text(result->ns_per_ball_tick));
        }
        table.add(row);
    }
    return {"growth", table.markdown()};
}

accuracy::Table matrix_table(const Results& results, double speed, const std::string& name) {
    std::vector<std::string> heads = {"balls, packing, radii"};
    for (const lab::EngineInfo& engine : lab::engines()) {
        if (!engine.is_floor) heads.push_back(engine.title);
    }
    TextTable table(heads);
    std::vector<BenchScene> scenes;
    for (const BenchResult& result : results) {
        const BenchScene& scene = result.cell.scene;
        if (scene.radii_per_tick != speed) continue;
        if (scenes.empty() || !(scenes.back() == scene)) scenes.push_back(scene);
    }
    for (const BenchScene& scene : scenes) {
        std::vector<std::string> row = {lab::grouped(scene.balls) + ", " +
                                        with_digits("%g", scene.packing) + ", " +
                                        to_string(scene.radii)};
        for (const lab::EngineInfo& engine : lab::engines()) {
            if (engine.is_floor) continue;
            const auto* const result = lab::find_result(results, engine.name, scene);
            row.push_back(result == nullptr ? "-" : ns_text(result->ns_per_ball_tick));
        }
        table.add(row);
    }
    return {name, table.markdown()};
}

const Results& results_in(const std::map<std::string, KeptSet>& sets, const std::string& name) {
    static const Results kNone;
    const auto found = sets.find(name);
    return found == sets.end() ? kNone : found->second.results;
}

lab::Plot figure_of(const Results& results, lab::BenchAxis axis, const std::string& set) {
    lab::Plot plot = lab::cost_plot(results, axis, scene_at(10'000, 0.3, kSlow));
    plot.footnote = "scripts/bench " + set;
    plot.height_px = 620.0;
    return plot;
}

}  // namespace

std::vector<accuracy::Table> speed_tables(const std::map<std::string, KeptSet>& sets) {
    std::vector<accuracy::Table> tables;
    if (sets.contains("targets")) {
        tables.push_back({"machine", sets.at("targets").machine + ".\n"});
        tables.push_back(targets_table(results_in(sets, "targets"), results_in(sets, "growth")));
        tables.push_back(laws_table(results_in(sets, "targets")));
    }
    if (sets.contains("growth")) tables.push_back(growth_table(results_in(sets, "growth")));
    if (sets.contains("matrix")) {
        tables.push_back(matrix_table(results_in(sets, "matrix"), kSlow, "matrix-slow"));
        tables.push_back(matrix_table(results_in(sets, "matrix"), kFast, "matrix-fast"));
    }
    return tables;
}

std::vector<accuracy::Figure> speed_figures(const std::map<std::string, KeptSet>& sets) {
    std::vector<accuracy::Figure> figures;
    if (sets.contains("growth")) {
        lab::Plot plot = figure_of(results_in(sets, "growth"), lab::BenchAxis::kBalls, "growth");
        plot.title = "How cost grows with the number of balls";
        plot.subtitle =
            "Equal balls in a walled box, packing 0.3, 0.05 r a tick. Memory is the floor: places "
            "and velocities read and written once a tick. Open marks and dashed lines of solvers "
            "are float.";
        figures.push_back({"speed-growth.svg", plot});
    }
    if (sets.contains("density")) {
        lab::Plot plot =
            figure_of(results_in(sets, "density"), lab::BenchAxis::kPacking, "density");
        plot.title = "What density costs";
        plot.subtitle =
            "10,000 equal balls in a walled box, 0.05 r a tick. Who waits for collisions pays for "
            "each; who looks for neighbours pays for them.";
        figures.push_back({"speed-density.svg", plot});
    }
    if (sets.contains("speed")) {
        lab::Plot plot = figure_of(results_in(sets, "speed"), lab::BenchAxis::kSpeed, "speed");
        plot.title = "What speed costs";
        plot.subtitle =
            "10,000 equal balls in a walled box, packing 0.3. Beyond about 1 r a tick discrete, "
            "Chipmunk and Box2D let balls through each other; swept and event never do.";
        figures.push_back({"speed-speed.svg", plot});
    }
    return figures;
}

}  // namespace fts::bench
