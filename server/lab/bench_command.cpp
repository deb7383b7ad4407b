#include "server/lab/bench_command.h"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/fmt/fmt.h>

#include "server/lab/bench/bench.h"
#include "server/lab/exit_codes.h"
#include "server/lab/number_option.h"
#include "server/lab/output.h"
#include "server/lab/progress_bar.h"
#include "server/lab/scene_argument.h"

namespace fts::lab {
namespace {

constexpr unsigned kMaxRepeats = 1000;
constexpr double kRepeatS = 0.1, kQuickRepeatS = 0.02;

struct BenchOptions {
    std::vector<std::string> engines;  // empty: all
    std::vector<std::size_t> balls = {32, 200, 2'000, 10'000, 100'000};
    std::vector<double> packings = {0.1, 0.3, 0.6};
    std::vector<std::string> radii = {"equal", "unequal"};
    std::vector<double> speeds = {0.05, 2.0};
    unsigned repeats = 3;
    bool quick = false;
    std::string json_file, svg_file;
};

// What was not asked for by its option becomes less.
void shorten(const CLI::App& command, BenchOptions& options) {
    if (command.count("--balls") == 0) options.balls = {32, 2'000};
    if (command.count("--packing") == 0) options.packings = {0.3};
    if (command.count("--radii") == 0) options.radii = {"equal"};
}

std::string command_of(const BenchOptions& options) {
    std::string command = "fts-lab bench";
    if (!options.engines.empty()) {
        command += fmt::format(" --engine {}", fmt::join(options.engines, ","));
    }
    command +=
        fmt::format(" --balls {} --packing {} --radii {} --speed {} --repeats {}",
                    fmt::join(options.balls, ","), fmt::join(options.packings, ","),
                    fmt::join(options.radii, ","), fmt::join(options.speeds, ","), options.repeats);
    return options.quick ? command + " --quick" : command;
}

BenchMatrix matrix_of(const BenchOptions& options) {
    BenchMatrix matrix{options.engines, options.balls, options.packings, {}, options.speeds};
    if (matrix.engines.empty()) {
        for (const EngineInfo& engine : engines()) {
            if (!engine.is_only_by_name) matrix.engines.push_back(engine.name);
        }
    }
    for (const std::string& radii : options.radii) {
        matrix.radii.push_back(radii == "equal" ? Radii::kEqual : Radii::kUnequal);
    }
    return matrix;
}

// Over what has most to show; the rest stays at the first of its values.
std::string picture_of(const BenchOptions& options, const std::vector<BenchResult>& results,
                       std::size_t of) {
    if (results.empty()) return {};
    const BenchScene& fixed = results.front().cell.scene;
    const BenchAxis axis = options.balls.size() > 1      ? BenchAxis::kBalls
                           : options.packings.size() > 1 ? BenchAxis::kPacking
                                                         : BenchAxis::kSpeed;
    Plot plot = cost_plot(results, axis, fixed);
    plot.title = "What a tick costs";
    plot.subtitle = "The first scene, " + text_of(fixed) +
                    ", and those that differ from it in the horizontal axis alone. Open marks and "
                    "dashed lines of solvers are float.";
    plot.footnote = command_of(options);
    if (results.size() < of) {
        plot.footnote += "   (stopped after " + std::to_string(results.size()) + " of " +
                         std::to_string(of) + ")";
    }
    return render_svg(plot);
}

bool opened(const std::string& path, const char* flag, std::unique_ptr<Output>& output) {
    if (path.empty()) return true;
    std::string error;
    output = Output::open(path, flag, error);
    if (output == nullptr) complain(error);
    return output != nullptr;
}

bool written(Output* output, const std::string& text) {
    if (output == nullptr) return true;
    std::string error;
    output->stream() << text;
    if (output->finish(error)) return true;
    complain(error);
    return false;
}

std::vector<BenchResult> measured(const std::vector<BenchCell>& cells, const BenchLimits& limits) {
    ProgressBar bar;
    return measure_cells(cells, limits, nobody_interrupted,
                         [&](std::size_t done, const BenchCell& next) {
                             bar.show(done, cells.size(), name_of(next));
                         });
}

int execute(const BenchOptions& options) {
    if (options.json_file == "-" && options.svg_file == "-") {
        complain("--json and --svg both go to the terminal; give one of them a file");
        return kExitUsage;
    }
    const BenchLimits limits{options.repeats, options.quick ? kQuickRepeatS : kRepeatS};
    std::unique_ptr<Output> json, svg;
    if (!opened(options.json_file, "--json", json) || !opened(options.svg_file, "--svg", svg)) {
        return kExitFailure;
    }
    listen_for_interruption();
    const auto cells = cells_of(matrix_of(options));
    const auto results = measured(cells, limits);
    const bool to_stdout = options.json_file == "-" || options.svg_file == "-";
    std::FILE* const terminal = to_stdout ? stderr : stdout;
    std::fputs(table_of(results).c_str(), terminal);
    const bool stopped = results.size() < cells.size();
    if (stopped) {
        std::fprintf(terminal, "stopped after %zu of %zu\n", results.size(), cells.size());
    }
    const bool good = written(json.get(), json_of(results)) &&
                      written(svg.get(), picture_of(options, results, cells.size()));
    if (stopped) return kExitInterrupted;
    return good ? 0 : kExitFailure;
}

std::vector<std::string> names_of_engines() {
    std::vector<std::string> names;
    for (const EngineInfo& engine : engines()) names.push_back(engine.name);
    return names;
}

void declare_scenes(CLI::App& command, BenchOptions& options) {
    command.add_option("--balls", options.balls, "How many, such as 32,10000")
        ->delimiter(',')
        ->check(CLI::Range(std::size_t{2}, physics::kMaxBodies))
        ->capture_default_str();
    command.add_option("--packing", options.packings, "Part of the area that they cover")
        ->delimiter(',')
        ->check(number_from(1e-6, 0.8))
        ->capture_default_str();
    command.add_option("--radii", options.radii, "equal, or unequal: 0.5 to 1.5 of the mean")
        ->delimiter(',')
        ->check(CLI::IsMember({"equal", "unequal"}))
        ->capture_default_str();
    command.add_option("--speed", options.speeds, "Radii per tick, root of the mean square")
        ->delimiter(',')
        ->check(number_from(1e-3, 1e3))
        ->capture_default_str();
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand(
        "bench", "What solvers cost over size, density and speed, beside other engines");
    const auto options = std::make_shared<BenchOptions>();
    command->add_option("--engine", options->engines, "Only these, such as swept-double")
        ->delimiter(',')
        ->check(CLI::IsMember(names_of_engines()));
    declare_scenes(*command, *options);
    command->add_option("--repeats", options->repeats, "Of which the median counts")
        ->check(CLI::Range(1U, kMaxRepeats))
        ->capture_default_str();
    command->add_flag("--quick", options->quick,
                      "Timed in a hurry; two sizes, one density and equal radii where not given");
    command->add_option("--json", options->json_file, "File for all figures; - for the terminal");
    command->add_option("--svg", options->svg_file, "File for a picture; - for the terminal");
    command->callback([command, options, &exit_code] {
        if (options->quick) shorten(*command, *options);
        exit_code = execute(*options);
    });
}

}  // namespace fts::lab
