#include "server/lab/replication_command.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "server/lab/arena_trace.h"
#include "server/lab/exit_codes.h"
#include "server/lab/number_option.h"
#include "server/lab/output.h"
#include "server/lab/progress_bar.h"
#include "server/lab/replication_study.h"
#include "server/lab/scene_argument.h"

namespace fts::lab {
namespace {

struct ReplicationOptions {
    ReplicationRequest request;
    std::string json_file, svg_file;
};

bool divides_the_tick_rate(double rate_hz) {
    const double ticks = kTraceTickRateHz / rate_hz;
    return std::abs(ticks - std::round(ticks)) < 1e-6;
}

// What was decoded and is not what was sent, of all coders.
std::uint64_t wrong_of(const ReplicationStudy& study) {
    std::uint64_t wrong = 0;
    for (const CoderRow& row : study.rows) wrong += row.wrong;
    return wrong;
}

int execute(const ReplicationOptions& options) {
    if (!divides_the_tick_rate(options.request.rate_hz)) {
        complain("--rate must be 60 over a whole number: 60, 30, 20, 15, 12, 10, ...");
        return kExitUsage;
    }
    std::string error;
    StudyFiles files = StudyFiles::open(options.json_file, options.svg_file, error);
    if (!error.empty()) {
        complain(error);
        return kExitFailure;
    }
    listen_for_interruption();
    ReplicationStudy study;
    {
        ProgressBar bar;
        study = study_replication(
            options.request, nobody_interrupted,
            [&](std::size_t done, std::size_t of) { bar.show(done, of, "snapshots"); });
    }
    if (!study.error.empty()) {
        complain(study.error);
        return kExitUsage;
    }
    std::fputs(table_of(options.request, study).c_str(), files.on_stdout() ? stderr : stdout);
    const bool written =
        files.write(json_of(options.request, study), svg_of(options.request, study), error);
    if (!written) complain(error);
    if (wrong_of(study) > 0) {
        complain(std::to_string(wrong_of(study)) + " snapshots were not decoded to what was sent");
        return kExitFailure;
    }
    if (study.stopped()) return kExitInterrupted;
    return written ? 0 : kExitFailure;
}

}  // namespace

void add_replication(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand(
        "replication", "What a snapshot costs on the wire: every way to code it, on one arena");
    const auto options = std::make_shared<ReplicationOptions>();
    ReplicationRequest& request = options->request;
    command->add_option("--count", request.count, "Balls")
        ->check(number_from(1, kMaxTraceBalls))
        ->capture_default_str();
    command->add_option("--seed", request.seed, "Of the arena, and of what the link loses")
        ->capture_default_str();
    command->add_option("--rate", request.rate_hz, "Snapshots per second, 60 over a whole number")
        ->check(number_from(1, kTraceTickRateHz))
        ->capture_default_str();
    command
        ->add_option("--delay-ms", request.delay_ms,
                     "From sending a snapshot to hearing that it was held")
        ->check(number_from(0, kMaxDelayMs))
        ->capture_default_str();
    command
        ->add_option("--loss", request.loss,
                     "Part of the datagrams that is lost, and of the acknowledgements")
        ->check(number_from(0, 0.9))
        ->capture_default_str();
    command
        ->add_option("--seconds", request.seconds,
                     "Simulated time, of which the first 10 are not measured")
        ->check(number_from(kUnmeasuredS + 1, kMaxTraceS))
        ->capture_default_str();
    command->add_option("--json", options->json_file, "File for all figures; - for the terminal");
    command->add_option("--svg", options->svg_file,
                        "File for a picture of size against cost; - for the terminal");
    command->callback([options, &exit_code] { exit_code = execute(*options); });
}

}  // namespace fts::lab
