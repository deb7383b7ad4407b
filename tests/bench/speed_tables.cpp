#include "tests/bench/speed_tables.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "server/lab/bench/engine.h"
#include "server/lab/digits.h"
#include "server/lab/text_table.h"
#include "tests/bench/bench_sets.h"

namespace fts::bench {
namespace {

using lab::BenchCell;
using lab::BenchResult;
using lab::BenchScene;
using lab::TextTable;
using lab::with_digits;
using Results = std::vector<BenchResult>;

constexpr const char* kNotMeasured = "not measured";

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

std::optional<double> tree_ratio(const Results& results, const std::string& engine,
                                 const BenchScene& scene) {
    const BenchResult* const ours = lab::find_result(results, engine, scene);
    const BenchResult* const tree = lab::find_result(results, "chipmunk-tree", scene);
    if (ours == nullptr || tree == nullptr) return std::nullopt;
    return tree->ns_per_ball_tick / ours->ns_per_ball_tick;
}

// What is in the set and can be run, but has no result.
bool is_missing(const std::string& set, const Results& results, const BenchCell& cell) {
    const auto is_this = [&](const BenchCell& other) {
        return other.engine == cell.engine && other.scene == cell.scene;
    };
    const auto& sets = bench_sets();
    const auto found = std::ranges::find(sets, set, &BenchSet::name);
    return found != sets.end() && std::ranges::any_of(found->cells, is_this) &&
           lab::reason_not_to_run(cell).empty() &&
           std::ranges::none_of(results, is_this, &BenchResult::cell);
}

// "-" where nothing is to be measured.
std::string cost_text(const std::string& set, const Results& results, const BenchCell& cell) {
    const auto* const result = lab::find_result(results, cell.engine, cell.scene);
    if (result != nullptr) return ns_text(result->ns_per_ball_tick);
    return is_missing(set, results, cell) ? kNotMeasured : "-";
}

std::optional<double> hits_per_s(const Results& results, const std::string& engine,
                                 const BenchScene& scene) {
    const BenchResult* const result = lab::find_result(results, engine, scene);
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

accuracy::Table targets_table(const Results& targets) {
    TextTable table({"what", "measured", "target", "reached"});
    const auto add = [&](const std::string& what, const std::optional<double>& value, double target,
                         bool at_least, const char* unit) {
        const double scale = unit == std::string(" M/s") ? 1e-6 : 1.0;
        const std::string asked =
            (at_least ? "at least " : "at most ") + with_digits("%.3g", target * scale) + unit;
        if (!value) return table.add({what, kNotMeasured, asked, "-"});
        table.add({what, with_digits("%.3g", *value * scale) + unit, asked,
                   (at_least ? *value >= target : *value <= target) ? "yes" : "no"});
    };
    // As codes of science are measured; and as a game would use it.
    const auto add_event = [&](const std::string& what, const BenchScene& scene, double target) {
        add(what, hits_per_s(targets, "event-double-unread", scene), target, true, " M/s");
        const auto read = hits_per_s(targets, "event-double", scene);
        table.add({"the same, all positions read every tick",
                   read ? with_digits("%.3g", *read * 1e-6) + " M/s" : kNotMeasured, "-", "-"});
    };
    const auto slow = scene_at(10'000, 0.3, kSlow), fast = scene_at(10'000, 0.3, kFast);
    add("`discrete` double, times as fast as Chipmunk", ratio(targets, "discrete-double", slow),
        25.0, true, "");
    add("`swept` double, times as fast as Chipmunk", ratio(targets, "swept-double", slow), 8.0,
        true, "");
    add("`swept` double at 2 r a tick, times as fast as Chipmunk as it comes, with its box tree",
        tree_ratio(targets, "swept-double", fast), 10.0, true, "");
    const auto hash = ratio(targets, "swept-double", fast);
    table.add({"the same, with its spatial hash tuned for the scene",
               hash ? with_digits("%.3g", *hash) : kNotMeasured, "-", "-"});
    add_event("`event` double, collisions", slow, 2e6);
    add_event("`event` double, packing 0.1, collisions", scene_at(10'000, 0.1, kSlow), 1e6);
    add_event("`event` double, 100,000 balls, collisions", scene_at(100'000, 0.3, kSlow), 0.7e6);
    add("`discrete` double, cost of a ball among a million to one among 10,000",
        growth_ratio(targets), 2.5, false, "");
    return {"targets", table.markdown()};
}

bool is_left_out(const std::vector<std::string>& row) {
    return std::ranges::all_of(row, [](const std::string& text) { return text == "-"; });
}

// Time, times Chipmunk, energy and what passed through.
std::vector<std::string> laws_cells(const Results& results, const BenchCell& cell) {
    const auto* const result = lab::find_result(results, cell.engine, cell.scene);
    if (result == nullptr) return {cost_text("targets", results, cell), "-", "-", "-"};
    const auto faster = lab::times_faster_than_chipmunk(results, *result);
    const auto& head_on = result->laws.head_on;
    return {ns_text(result->ns_per_ball_tick), faster ? with_digits("%.3g", *faster) : "-",
            lab::energy_text(result->laws.energy_error),
            head_on ? with_digits("%.0f", head_on->per_1000()) : "-"};
}

// Time and the laws beside each other: a fast wrong answer is not a result.
accuracy::Table laws_table(const Results& results) {
    TextTable table({"engine", "ns, slow", "times Chipmunk", "energy", "through", "ns, fast",
                     "times Chipmunk", "energy", "through"});
    for (const lab::EngineInfo& engine : lab::engines()) {
        auto row = laws_cells(results, {engine.name, scene_at(10'000, 0.3, kSlow)});
        const auto fast = laws_cells(results, {engine.name, scene_at(10'000, 0.3, kFast)});
        row.insert(row.end(), fast.begin(), fast.end());
        if (is_left_out(row)) continue;
        row.insert(row.begin(), engine.title);
        table.add(row);
    }
    return {"laws", table.markdown()};
}

struct Column {
    std::string head;
    BenchScene scene;
};

// Without engines of which nothing is to be measured.
accuracy::Table cost_table(const std::string& set, const Results& results,
                           const std::vector<Column>& columns) {
    std::vector<std::string> heads = {"engine"};
    for (const Column& column : columns) heads.push_back(column.head);
    TextTable table(heads);
    for (const lab::EngineInfo& engine : lab::engines()) {
        std::vector<std::string> row;
        for (const Column& column : columns) {
            row.push_back(cost_text(set, results, {engine.name, column.scene}));
        }
        if (is_left_out(row)) continue;
        row.insert(row.begin(), engine.title);
        table.add(row);
    }
    return {set, table.markdown()};
}

accuracy::Table growth_table(const Results& results) {
    std::vector<Column> columns;
    const std::vector<std::size_t> sizes = {32, 320, 3'200, 10'000, 100'000, 1'000'000};
    for (const std::size_t balls : sizes) {
        columns.push_back({lab::grouped(balls), scene_at(balls, 0.3, kSlow)});
    }
    return cost_table("growth", results, columns);
}

accuracy::Table density_table(const Results& results) {
    std::vector<Column> columns;
    for (const double packing : {0.05, 0.1, 0.3, 0.5, 0.7}) {
        columns.push_back({with_digits("%g", packing), scene_at(10'000, packing, kSlow)});
    }
    return cost_table("density", results, columns);
}

accuracy::Table speed_table(const Results& results) {
    std::vector<Column> columns;
    for (const double speed : {0.01, 0.05, 0.2, 1.0, 2.0}) {
        columns.push_back({with_digits("%g r", speed), scene_at(10'000, 0.3, speed)});
    }
    return cost_table("speed", results, columns);
}

std::vector<BenchScene> scenes_of_matrix(double speed) {
    const auto matrix = std::ranges::find(bench_sets(), std::string("matrix"), &BenchSet::name);
    std::vector<BenchScene> scenes;
    for (const BenchCell& cell : matrix->cells) {
        if (cell.scene.radii_per_tick != speed) continue;
        if (scenes.empty() || !(scenes.back() == cell.scene)) scenes.push_back(cell.scene);
    }
    return scenes;
}

std::string matrix_at(const Results& results, double speed) {
    std::vector<std::string> heads = {"balls, packing, radii"};
    for (const lab::EngineInfo& engine : lab::engines()) {
        if (!engine.is_floor && !engine.is_only_by_name) heads.push_back(engine.title);
    }
    TextTable table(heads);
    for (const BenchScene& scene : scenes_of_matrix(speed)) {
        std::vector<std::string> row = {lab::grouped(scene.balls) + ", " +
                                        with_digits("%g", scene.packing) + ", " +
                                        to_string(scene.radii)};
        for (const lab::EngineInfo& engine : lab::engines()) {
            if (engine.is_floor || engine.is_only_by_name) continue;
            row.push_back(cost_text("matrix", results, {engine.name, scene}));
        }
        table.add(row);
    }
    return table.markdown();
}

accuracy::Table matrix_table(const Results& results) {
    return {"matrix", "**Slow, 0.05 r a tick**\n\n" + matrix_at(results, kSlow) +
                          "\n**Fast, 2 r a tick**\n\n" + matrix_at(results, kFast)};
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
    }
    const auto add = [&](const std::string& set, accuracy::Table table) {
        if (!sets.contains(set)) {
            table.markdown = "Not measured yet: `scripts/bench " + set + "`.\n";
        }
        tables.push_back(std::move(table));
    };
    add("targets", targets_table(results_in(sets, "targets")));
    add("targets", laws_table(results_in(sets, "targets")));
    add("growth", growth_table(results_in(sets, "growth")));
    add("density", density_table(results_in(sets, "density")));
    add("speed", speed_table(results_in(sets, "speed")));
    add("matrix", matrix_table(results_in(sets, "matrix")));
    return tables;
}

std::vector<accuracy::Figure> speed_figures(const std::map<std::string, KeptSet>& sets) {
    const std::string what_is_float = " Open marks and dashed lines of solvers are float.";
    std::vector<accuracy::Figure> figures;
    if (sets.contains("growth")) {
        lab::Plot plot = figure_of(results_in(sets, "growth"), lab::BenchAxis::kBalls, "growth");
        plot.title = "How cost grows with the number of balls";
        plot.subtitle =
            "Equal balls in a walled box, packing 0.3, 0.05 r a tick. Memory is the floor: places "
            "and velocities read and written once a tick." +
            what_is_float;
        figures.push_back({"speed-growth.svg", plot});
    }
    if (sets.contains("density")) {
        lab::Plot plot =
            figure_of(results_in(sets, "density"), lab::BenchAxis::kPacking, "density");
        plot.title = "What density costs";
        plot.subtitle =
            "10,000 equal balls in a walled box, 0.05 r a tick. Who waits for collisions pays for "
            "each; who looks for neighbours pays for them." +
            what_is_float;
        figures.push_back({"speed-density.svg", plot});
    }
    if (sets.contains("speed")) {
        lab::Plot plot = figure_of(results_in(sets, "speed"), lab::BenchAxis::kSpeed, "speed");
        plot.title = "What speed costs";
        plot.subtitle =
            "10,000 equal balls in a walled box, packing 0.3. Beyond about 1 r a tick discrete, "
            "Chipmunk and Box2D let balls through each other; swept and event never do." +
            what_is_float;
        figures.push_back({"speed-speed.svg", plot});
    }
    return figures;
}

}  // namespace fts::bench
