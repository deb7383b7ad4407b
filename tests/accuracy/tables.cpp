// The study's tables.
#include <cmath>
#include <fstream>
#include <optional>
#include <thread>

#include "server/lab/digits.h"
#include "server/lab/text_table.h"
#include "tests/accuracy/cells.h"
#include "tests/accuracy/figures.h"
#include "tests/accuracy/study_scenes.h"

namespace fts::accuracy {
namespace {

using lab::Setting;
using lab::TextTable;
using lab::with_digits;

std::optional<double> number_in(const Json& cell, const char* field) {
    if (!cell.is_object() || !cell.contains(field) || !cell[field].is_number()) return std::nullopt;
    return cell[field].get<double>();
}

std::string error_text(const std::optional<double>& value) {
    if (!value) return "";
    return *value == 0.0 ? "0" : with_digits("%.1e", std::abs(*value));
}

std::string plain_text(const std::optional<double>& value) {
    if (!value) return "";
    return with_digits(std::abs(*value) < 100.0 ? "%.3g" : "%.0f", *value);
}

Table vector_table(const CellStore& cells) {
    TextTable table({"solver", "ns", "E", "missed", "extra", "time, ticks", "angle, deg",
                     "depth / r", "energy", "momentum"});
    for (const Setting& setting : all_settings()) {
        const Json cell = cells.find(accuracy_key("gas-medium", 0.1, setting));
        const Json cost = cells.find(cost_key("gas-medium", 0.1, setting));
        if (!cell.is_object()) continue;
        table.add({to_string(setting), plain_text(number_in(cost, "ns")),
                   error_text(number_in(cell, "E")), plain_text(number_in(cell, "missed")),
                   plain_text(number_in(cell, "extra")), error_text(number_in(cell, "time")),
                   error_text(number_in(cell, "angle")), error_text(number_in(cell, "depth")),
                   error_text(number_in(cell, "energy")), error_text(number_in(cell, "momentum"))});
    }
    return {"vector", table.markdown()};
}

Table scenes_table(const CellStore& cells) {
    std::vector<std::string> scenes = gas_names();
    scenes.emplace_back("rack");
    std::vector<std::string> heads = {"solver"};
    heads.insert(heads.end(), scenes.begin(), scenes.end());
    TextTable table(heads);
    for (const Setting& setting : all_settings()) {
        std::vector<std::string> row = {to_string(setting)};
        for (const std::string& scene : scenes) {
            row.push_back(
                error_text(number_in(cells.find(accuracy_key(scene, 0.1, setting)), "E")));
        }
        table.add(row);
    }
    return {"scenes", table.markdown()};
}

// The cheapest that was measured to be as exact as asked for. Where bodies thrust, no calendar of
// collisions survives a tick.
Table choice_table(const CellStore& cells, const char* name, bool coasting) {
    constexpr double kTolerances[] = {0.1, 0.01, 1e-3, 1e-5, 1e-9};
    std::vector<std::string> heads = {"radii a tick"};
    for (const double tolerance : kTolerances)
        heads.push_back("E <= " + with_digits("%g", tolerance));
    TextTable table(heads);
    for (const double speed : speeds()) {
        std::vector<std::string> row = {with_digits("%g", speed)};
        for (const double tolerance : kTolerances) {
            std::optional<double> least;
            std::string choice = "none";
            for (const Setting& setting : all_settings()) {
                if (!coasting && setting.solver.kind == physics::SolverKind::kEvent) continue;
                const auto error =
                    number_in(cells.find(accuracy_key("gas-medium", speed, setting)), "E");
                const auto ns = number_in(cells.find(cost_key("gas-medium", speed, setting)), "ns");
                if (!error || !ns || *error > tolerance || (least && *least <= *ns)) continue;
                least = ns;
                choice = to_string(setting) + " (" + plain_text(ns) + ")";
            }
            row.push_back(choice);
        }
        table.add(row);
    }
    return {name, table.markdown()};
}

Table samples_table(const CellStore& cells) {
    TextTable table({"radii a tick", "ticks compared", "true collisions in them", "left out"});
    const Setting swept{{physics::SolverKind::kSwept, 1}, physics::ScalarKind::kDouble};
    for (const double speed : speeds()) {
        const Json cell = cells.find(accuracy_key("gas-medium", speed, swept));
        table.add({with_digits("%g", speed), plain_text(number_in(cell, "ticks")),
                   plain_text(number_in(cell, "collisions")),
                   plain_text(number_in(cell, "too_busy"))});
    }
    return {"samples", table.markdown()};
}

}  // namespace

std::string machine() {
    std::ifstream in("/proc/cpuinfo");
    std::string model = "an unknown processor";
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("model name")) continue;
        model = line.substr(line.find(':') + 2);
        break;
    }
#ifdef NDEBUG
    const std::string build = "optimised";
#else
    const std::string build = "with assertions, not for costs";
#endif
#ifdef __clang__
    const std::string compiler = "clang " + std::to_string(__clang_major__);
#else
    const std::string compiler = "gcc " + std::to_string(__GNUC__);
#endif
    return model + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores; " +
           compiler + ", " + build;
}

std::vector<Table> tables_of(const CellStore& cells) {
    const Json where = cells.find("machine");
    const std::string text = where.is_string() ? where.get<std::string>() : "";
    return {{"machine", text + ".\n"},
            vector_table(cells),
            scenes_table(cells),
            choice_table(cells, "coasting", true),
            choice_table(cells, "thrusting", false),
            samples_table(cells)};
}

}  // namespace fts::accuracy
