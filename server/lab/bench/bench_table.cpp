// Results as tables for the terminal, and as JSON.

#include <nlohmann/json.hpp>

#include "server/lab/bench/bench.h"
#include "server/lab/digits.h"
#include "server/lab/text_table.h"

namespace fts::lab {
namespace {

std::vector<std::string> bench_row(const std::vector<BenchResult>& results,
                                   const BenchResult& result) {
    const EngineInfo* const engine = find_engine(result.cell.engine);
    const std::string title = "  " + (engine == nullptr ? result.cell.engine : engine->title);
    if (!result.not_run.empty()) return {title, "-", "-", "-", "-", "-", "  " + result.not_run};
    const auto faster = times_faster_than_chipmunk(results, result);
    const bool is_floor = engine != nullptr && engine->is_floor;
    return {title,
            with_digits(result.ns_per_ball_tick < 10.0 ? "%.2f" : "%.1f", result.ns_per_ball_tick),
            result.collisions_per_s ? with_digits("%.3g", *result.collisions_per_s) : "-",
            is_floor ? "-" : energy_text(result.laws.energy_error),
            result.laws.head_on ? with_digits("%.0f", result.laws.head_on->per_1000()) : "-",
            faster ? with_digits(*faster < 10.0 ? "%.2f" : "%.1f", *faster) : "-"};
}

nlohmann::ordered_json bench_json(const std::vector<BenchResult>& results,
                                  const BenchResult& result) {
    const BenchScene& scene = result.cell.scene;
    nlohmann::ordered_json row = {{"engine", result.cell.engine},
                                  {"balls", scene.balls},
                                  {"packing", scene.packing},
                                  {"radii", to_string(scene.radii)},
                                  {"radii_per_tick", scene.radii_per_tick}};
    if (!result.not_run.empty()) {
        row["not_run"] = result.not_run;
        return row;
    }
    row["ns_per_ball_tick"] = result.ns_per_ball_tick;
    const auto or_null = [](const auto& value) {
        return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    };
    row["collisions_per_s"] = or_null(result.collisions_per_s);
    row["energy_error"] = result.laws.energy_error;
    row["energy_error_after_ticks"] = result.laws.ticks;
    std::optional<std::size_t> pairs, through;
    if (result.laws.head_on) {
        pairs = result.laws.head_on->pairs;
        through = result.laws.head_on->through;
    }
    row["head_on_pairs"] = or_null(pairs);
    row["head_on_through"] = or_null(through);
    row["times_faster_than_chipmunk"] = or_null(times_faster_than_chipmunk(results, result));
    return row;
}

}  // namespace

std::string energy_text(double error) {
    if (error == 0.0) return "0";
    return error < kEnergyLost ? with_digits("%.1e", error) : "not finite";
}

std::string table_of(const std::vector<BenchResult>& results) {
    std::string out;
    for (std::size_t first = 0; first < results.size();) {
        TextTable table({"  engine", "ns", "hits/s", "energy", "through", "x Chipmunk"});
        std::size_t i = first;
        for (; i < results.size() && results[i].cell.scene == results[first].cell.scene; ++i) {
            table.add(bench_row(results, results[i]));
        }
        out += text_of(results[first].cell.scene) + "\n" + table.text() + "\n";
        first = i;
    }
    out +=
        "  ns          CPU time per ball and tick; hits/s: collisions per second of it\n"
        "  energy      relative error of the kinetic energy after 60 ticks, fewer in large and "
        "fast\n"
        "              scenes, as many for every engine\n"
        "  through     of 1000 pairs that fly head on at each other at the scene's speed, those "
        "that\n"
        "              passed through each other\n"
        "  x Chipmunk  how many times as long Chipmunk takes, the faster of its two indices\n"
        "  memory      places and velocities read and written once: the floor\n";
    if (find_engine("chipmunk-hash") == nullptr) {
        out += "  Box2D and Chipmunk are not in this build: ./setup bench, then build again.\n";
    }
    return out;
}

std::string json_of(const std::vector<BenchResult>& results) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const BenchResult& result : results) rows.push_back(bench_json(results, result));
    return nlohmann::ordered_json{{"tick_s", kBenchTickS}, {"rows", rows}}.dump(2) + "\n";
}

}  // namespace fts::lab
