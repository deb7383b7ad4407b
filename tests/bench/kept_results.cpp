#include "tests/bench/kept_results.h"

#include <exception>
#include <fstream>
#include <optional>

#include <nlohmann/json.hpp>

#include "server/lab/bench/engine.h"
#include "tests/bench/bench_sets.h"

namespace fts::bench {
namespace {

using Json = nlohmann::json;

// Empty for what is neither a median nor was refused.
std::optional<lab::BenchResult> result_of(const Json& run, const std::string& set) {
    const bool was_refused = run.value("error_occurred", false);
    if (!was_refused && run.value("aggregate_name", "") != "median") return std::nullopt;
    const auto name = run.at("run_name").get<std::string>().substr(set.size() + 1);
    const auto cell = lab::cell_from(name);
    if (!cell) throw std::runtime_error("'" + name + "' is no cell");
    if (lab::find_engine(cell->engine) == nullptr) {
        throw std::runtime_error("this build has no " + cell->engine + "; run ./setup bench");
    }
    lab::BenchResult result;
    result.cell = *cell;
    if (was_refused) {
        result.not_run = run.at("error_message");
        return result;
    }
    result.ns_per_ball_tick = run.at("ns_per_ball_tick");
    if (run.contains("collisions_per_s")) result.collisions_per_s = run.at("collisions_per_s");
    result.laws.energy_error = run.at("energy_error");
    result.laws.ticks = static_cast<std::size_t>(run.at("energy_error_after_ticks").get<double>());
    if (run.contains("head_on_pairs")) {
        const double pairs = run.at("head_on_pairs"), through = run.at("head_on_through");
        result.laws.head_on =
            lab::HeadOn{static_cast<std::size_t>(pairs), static_cast<std::size_t>(through)};
    }
    return result;
}

KeptSet read_set(const std::filesystem::path& file, const std::string& set) {
    std::ifstream in(file);
    Json json;
    // Spreads of what is always 0 are no numbers, and stand in the file as such.
    std::string text{std::istreambuf_iterator<char>(in), {}};
    for (const char* const nan : {"-NaN", "NaN"}) {
        for (auto at = text.find(nan); at != std::string::npos; at = text.find(nan, at)) {
            text.replace(at, std::string(nan).size(), "null");
        }
    }
    json = Json::parse(text);
    KeptSet kept;
    kept.machine = json.at("context").value("machine", "");
    for (const Json& run : json.at("benchmarks")) {
        if (auto result = result_of(run, set)) kept.results.push_back(std::move(*result));
    }
    return kept;
}

}  // namespace

std::map<std::string, KeptSet> read_sets(const std::filesystem::path& folder, std::string& error) {
    std::map<std::string, KeptSet> sets;
    for (const BenchSet& set : bench_sets()) {
        const auto file = folder / (set.name + ".json");
        if (!std::filesystem::exists(file)) continue;
        try {
            sets[set.name] = read_set(file, set.name);
        } catch (const std::exception& failure) {
            error = file.string() + ": " + failure.what();
            return sets;
        }
    }
    return sets;
}

}  // namespace fts::bench
