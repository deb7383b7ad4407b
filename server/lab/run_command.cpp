#include "server/lab/run_command.h"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "common/physics/fidelity.h"
#include "server/lab/exit_codes.h"
#include "server/lab/number_option.h"
#include "server/lab/output.h"
#include "server/lab/progress_bar.h"
#include "server/lab/run.h"
#include "server/lab/run_report.h"
#include "server/lab/scene_argument.h"
#include "server/lab/trajectory.h"

namespace fts::lab {
namespace {

constexpr double kMaxTicksToRun = 1e12;

struct RunOptions {
    SceneArgument scene;
    std::string solver = "swept";
    std::string scalar = "auto";
    std::uint32_t substeps = 1;
    std::string tolerance = "auto";
    double rate_hz = 60.0;
    double seconds = 0.0;
    std::string json_file, csv_file;
    std::optional<double> csv_rate_hz;
};

struct RunOutputs {
    std::unique_ptr<Output> json, csv;

    bool take_stdout() const { return (json && json->is_stdout()) || (csv && csv->is_stdout()); }
};

std::optional<RunOutputs> open_outputs(const RunOptions& options) {
    RunOutputs outputs;
    std::string error;
    if (options.json_file == "-" && options.csv_file == "-") {
        complain("--json and --csv both go to the terminal; give one of them a file");
        return std::nullopt;
    }
    if (!options.json_file.empty()) {
        outputs.json = Output::open(options.json_file, "--json", error);
    }
    if (error.empty() && !options.csv_file.empty()) {
        outputs.csv = Output::open(options.csv_file, "--csv", error);
    }
    if (error.empty()) return outputs;
    complain(error);
    return std::nullopt;
}

// Sets `why` when the setting was chosen here.
Setting setting_of(const RunOptions& options, const physics::Scene& scene, std::string& why) {
    Setting setting;
    setting.solver.substeps = options.substeps;
    if (options.solver == "auto") {
        physics::Fidelity fidelity;
        fidelity.tolerance = *physics::tolerance_from(options.tolerance);
        fidelity.tick_duration_s = 1.0 / options.rate_hz;
        fidelity.allow_float = options.scalar != "double";
        const physics::Plan plan = physics::plan(scene, fidelity);
        setting.solver = plan.solver;
        setting.scalar = plan.scalar;
        why = plan.reason;
    } else {
        setting.solver.kind = *physics::solver_from(options.solver);
        if (!has_substeps(setting) && options.substeps > 1) {
            complain("warning: " + options.solver + " has no substeps; --substeps " +
                     std::to_string(options.substeps) + " changes nothing");
        }
    }
    if (const auto scalar = physics::scalar_from(options.scalar)) setting.scalar = *scalar;
    return setting;
}

// Seldom enough not to be felt, often enough to be alive.
class Beat {
  public:
    bool is_due() {
        const auto now = std::chrono::steady_clock::now();
        if (now < next_) return false;
        next_ = now + std::chrono::milliseconds(200);
        return true;
    }

  private:
    std::chrono::steady_clock::time_point next_ =
        std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
};

RunResult watched_run(const physics::Scene& scene, const RunSettings& settings,
                      TrajectoryWriter* trajectory) {
    ProgressBar bar;
    Beat beat;
    Observer observer;
    observer.go_on = [&](const RunState& state) {
        if (beat.is_due()) {
            bar.show(state.tick, state.ticks_in_all,
                     std::to_string(state.collisions) + " collisions");
        }
        return nobody_interrupted();
    };
    if (trajectory != nullptr) {
        observer.wants_bodies = [&](const RunState& state) {
            return trajectory->is_sample(state.tick, state.ticks_in_all);
        };
        observer.show = [&](const RunState& state, std::uint32_t body,
                            const physics::Vec2d& position_m, const physics::Vec2d& velocity_mps) {
            trajectory->write(state.time_s, body, position_m, velocity_mps);
        };
    }
    return run(scene, settings, observer);
}

bool write_all(RunOutputs& outputs, const RunReport& report) {
    std::string error;
    bool good = true;
    if (outputs.json) outputs.json->stream() << json_of(report);
    for (const auto& output : {outputs.json.get(), outputs.csv.get()}) {
        if (output != nullptr && !output->finish(error)) {
            complain(error);
            good = false;
        }
    }
    return good;
}

int execute(const RunOptions& options) {
    if (!physics::tolerance_from(options.tolerance)) {
        complain("--tolerance is '" + options.tolerance +
                 "'; give auto, fast, exact, or a number above 0 and below 1");
        return kExitUsage;
    }
    if (options.seconds * options.rate_hz > kMaxTicksToRun) {
        complain("--seconds times --rate are more than 1e12 ticks; give less");
        return kExitUsage;
    }
    const std::optional<LoadedScene> loaded = load(options.scene);
    if (!loaded) return kExitUsage;
    std::optional<RunOutputs> outputs = open_outputs(options);
    if (!outputs) return kExitFailure;

    RunReport report;
    report.scene = loaded->name;
    report.settings.rate_hz = options.rate_hz;
    report.settings.seconds = options.seconds;
    report.settings.setting = setting_of(options, loaded->scene, report.plan);
    std::optional<TrajectoryWriter> trajectory;
    if (outputs->csv) {
        trajectory.emplace(outputs->csv->stream(), options.rate_hz,
                           options.csv_rate_hz.value_or(options.rate_hz));
    }
    listen_for_interruption();
    report.result =
        watched_run(loaded->scene, report.settings, trajectory ? &*trajectory : nullptr);
    std::fputs(text_of(report).c_str(), outputs->take_stdout() ? stderr : stdout);
    const bool written = write_all(*outputs, report);
    if (!report.result.stuck.empty()) complain(report.result.stuck);
    if (report.result.was_stopped) return kExitInterrupted;
    return written && report.result.stuck.empty() ? 0 : kExitFailure;
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("run", "Advance a scene and report what was conserved and what it cost");
    const auto options = std::make_shared<RunOptions>();
    declare(*command, options->scene);
    command->add_option("--solver", options->solver, "seed, discrete, swept, event or auto")
        ->check(CLI::IsMember({"seed", "discrete", "swept", "event", "auto"}))
        ->capture_default_str();
    command
        ->add_option("--scalar", options->scalar,
                     "float, double or auto: what --solver auto chooses, double otherwise")
        ->check(CLI::IsMember({"float", "double", "auto"}))
        ->capture_default_str();
    command->add_option("--substeps", options->substeps, "Per tick, of seed and discrete")
        ->check(CLI::Range(1U, physics::kMaxSubsteps))
        ->capture_default_str();
    command
        ->add_option("--tolerance", options->tolerance,
                     "Of --solver auto: auto, fast, exact, or a collision error above 0")
        ->capture_default_str();
    command->add_option("--rate", options->rate_hz, "Ticks per second")
        ->check(number_from(1e-4, 1e9))
        ->capture_default_str();
    command->add_option("--seconds", options->seconds, "How long, in the scene's time")
        ->check(number_from(0.0, 1e12))
        ->required();
    command->add_option("--json", options->json_file, "File for the figures; - for the terminal");
    command->add_option("--csv", options->csv_file,
                        "File for the trajectory, a row for each body and sample; - for the "
                        "terminal");
    command
        ->add_option("--csv-rate", options->csv_rate_hz, "Samples per second; each tick by default")
        ->check(number_from(1e-9, 1e9));
    command->callback([options, &exit_code] { exit_code = execute(*options); });
}

}  // namespace fts::lab
