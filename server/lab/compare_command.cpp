#include "server/lab/compare_command.h"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/physics/solver_choice.h"
#include "server/lab/compare.h"
#include "server/lab/exit_codes.h"
#include "server/lab/output.h"
#include "server/lab/progress_bar.h"
#include "server/lab/scene_argument.h"

namespace fts::lab {
namespace {

constexpr double kMaxTicksToCompare = 1e8;

struct CompareOptions {
    SceneArgument scene;
    double seconds = 10.0;
    double rate_hz = 60.0;
    std::vector<std::uint32_t> substeps = {1, 4, 16};
    std::vector<std::string> solvers = {"seed", "discrete", "swept", "event"};
    std::vector<std::string> scalars = {"float", "double"};
    std::string json_file, svg_file;
};

struct CompareOutputs {
    std::unique_ptr<Output> json, svg;
};

std::optional<CompareOutputs> open_outputs(const CompareOptions& options) {
    CompareOutputs outputs;
    std::string error;
    if (options.json_file == "-" && options.svg_file == "-") {
        complain("--json and --svg both go to the terminal; give one of them a file");
        return std::nullopt;
    }
    if (!options.json_file.empty()) {
        outputs.json = Output::open(options.json_file, "--json", error);
    }
    if (error.empty() && !options.svg_file.empty()) {
        outputs.svg = Output::open(options.svg_file, "--svg", error);
    }
    if (error.empty()) return outputs;
    complain(error);
    return std::nullopt;
}

// False when not all of it could be written; stderr has been told.
bool write_all(CompareOutputs& outputs, const CompareRequest& request,
               const Comparison& comparison) {
    if (outputs.json) outputs.json->stream() << json_of(request, comparison);
    if (outputs.svg) {
        const std::string svg = svg_of(request, comparison);
        if (svg.empty()) complain("warning: no picture: no row has a collision error to show");
        outputs.svg->stream() << svg;
    }
    bool good = true;
    std::string error;
    for (Output* output : {outputs.json.get(), outputs.svg.get()}) {
        if (output != nullptr && !output->finish(error)) {
            complain(error);
            good = false;
        }
    }
    return good;
}

CompareRequest request_of(const CompareOptions& options, const physics::Scene& scene) {
    CompareRequest request;
    request.scene_name = options.scene.scene;
    request.scene = scene;
    request.seconds = options.seconds;
    request.rate_hz = options.rate_hz;
    request.substeps = options.substeps;
    for (const std::string& name : options.solvers) {
        request.solvers.push_back(*physics::solver_from(name));
    }
    for (const std::string& name : options.scalars) {
        request.scalars.push_back(*physics::scalar_from(name));
    }
    return request;
}

int execute(const CompareOptions& options) {
    const std::optional<LoadedScene> loaded = load(options.scene);
    if (!loaded) return kExitUsage;
    if (loaded->scene.bodies.empty()) {
        complain("'" + options.scene.scene +
                 "' has no bodies to compare; add a body or a generator");
        return kExitUsage;
    }
    const double ticks = std::round(options.seconds * options.rate_hz);
    if (!(ticks >= 1.0 && ticks <= kMaxTicksToCompare)) {
        complain("--seconds times --rate must be 1 to 1e8 ticks");
        return kExitUsage;
    }
    std::optional<CompareOutputs> outputs = open_outputs(options);
    if (!outputs) return kExitFailure;
    listen_for_interruption();
    const CompareRequest request = request_of(options, loaded->scene);
    Comparison comparison;
    {
        ProgressBar bar;
        comparison = compare(request, nobody_interrupted,
                             [&](std::size_t done, std::size_t of, const Setting& next) {
                                 bar.show(done, of, to_string(next));
                             });
    }
    const bool to_stdout = options.json_file == "-" || options.svg_file == "-";
    std::fputs(table_of(request, comparison).c_str(), to_stdout ? stderr : stdout);
    const bool written = write_all(*outputs, request, comparison);
    if (comparison.stopped()) return kExitInterrupted;
    return written ? 0 : kExitFailure;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand(
        "compare", "Every solver and scalar against exact dynamics: accuracy beside cost");
    const auto options = std::make_shared<CompareOptions>();
    declare(*command, options->scene);
    command->add_option("--seconds", options->seconds, "Simulated time")
        ->check(CLI::Range(1e-9, 1e12))
        ->capture_default_str();
    command->add_option("--rate", options->rate_hz, "Ticks per second")
        ->check(CLI::Range(1e-4, 1e9))
        ->capture_default_str();
    command
        ->add_option("--substeps", options->substeps,
                     "Of the solvers that have any, such as 1,4,16")
        ->delimiter(',')
        ->check(CLI::Range(1U, physics::kMaxSubsteps))
        ->capture_default_str();
    command->add_option("--solver", options->solvers, "Only these, such as discrete,swept")
        ->delimiter(',')
        ->check(CLI::IsMember({"seed", "discrete", "swept", "event"}))
        ->capture_default_str();
    command->add_option("--scalar", options->scalars, "Only this: float or double")
        ->delimiter(',')
        ->check(CLI::IsMember({"float", "double"}))
        ->capture_default_str();
    command->add_option("--json", options->json_file, "File for all figures; - for the terminal");
    command->add_option("--svg", options->svg_file,
                        "File for a picture of cost against error; - for the terminal");
    command->callback([options, &exit_code] { exit_code = execute(*options); });
}

}  // namespace fts::lab
