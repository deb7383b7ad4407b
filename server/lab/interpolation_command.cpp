#include "server/lab/interpolation_command.h"

#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "server/lab/arena_trace.h"
#include "server/lab/exit_codes.h"
#include "server/lab/interpolation_study.h"
#include "server/lab/number_option.h"
#include "server/lab/output.h"
#include "server/lab/progress_bar.h"
#include "server/lab/scene_argument.h"

namespace fts::lab {
namespace {

struct InterpolationOptions {
    InterpolationRequest request;
    std::string json_file, svg_file, hit_svg_file;
};

int execute(const InterpolationOptions& options) {
    std::string error;
    StudyFiles files = StudyFiles::open(options.json_file, options.svg_file, error);
    std::unique_ptr<Output> hit_svg;
    const bool hit_to_stdout = options.hit_svg_file == "-";
    if (hit_to_stdout && files.on_stdout()) {
        error = "only one of --json, --svg and --hit-svg can go to the terminal";
    }
    if (error.empty() && !options.hit_svg_file.empty()) {
        hit_svg = Output::open(options.hit_svg_file, "--hit-svg", error);
    }
    if (!error.empty()) {
        complain(error);
        return kExitFailure;
    }
    listen_for_interruption();
    InterpolationStudy study;
    {
        ProgressBar bar;
        study = study_interpolation(
            options.request, nobody_interrupted,
            [&](std::size_t done, std::size_t of) { bar.show(done, of, "snapshots"); });
    }
    if (!study.error.empty()) {
        complain(study.error);
        return kExitUsage;
    }
    const bool to_stdout = files.on_stdout() || hit_to_stdout;
    std::fputs(table_of(options.request, study).c_str(), to_stdout ? stderr : stdout);
    bool written =
        files.write(json_of(options.request, study), svg_of(options.request, study), error);
    if (hit_svg && written) {
        hit_svg->stream() << hit_svg_of(options.request, study);
        written = hit_svg->finish(error);
    }
    if (!written) complain(error);
    if (study.stopped()) return kExitInterrupted;
    return written ? 0 : kExitFailure;
}

}  // namespace

void add_interpolation(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand(
        "interpolation",
        "How far what is drawn between snapshots is from what happened: every way, at 10 to 60 Hz");
    const auto options = std::make_shared<InterpolationOptions>();
    InterpolationRequest& request = options->request;
    command->add_option("--count", request.count, "Balls")
        ->check(number_from(1, kMaxTraceBalls))
        ->capture_default_str();
    command->add_option("--seed", request.seed, "Of the arena")->capture_default_str();
    command
        ->add_option("--seconds", request.seconds,
                     "Simulated time at each rate, of which the first 10 are not measured")
        ->check(number_from(kUnmeasuredS + 1, kMaxTraceS))
        ->capture_default_str();
    command->add_option("--json", options->json_file, "File for all figures; - for the terminal");
    command->add_option("--svg", options->svg_file,
                        "File for a picture of error against rate; - for the terminal");
    command->add_option("--hit-svg", options->hit_svg_file,
                        "File for a picture of one hit, as every way draws it");
    command->callback([options, &exit_code] { exit_code = execute(*options); });
}

}  // namespace fts::lab
