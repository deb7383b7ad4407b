#include "server/lab/plan_command.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "common/physics/fidelity.h"
#include "server/lab/exit_codes.h"
#include "server/lab/number_option.h"
#include "server/lab/output.h"
#include "server/lab/scene_argument.h"

namespace fts::lab {
namespace {

struct PlanOptions {
    SceneArgument scene;
    std::string tolerance;
    double rate_hz = 60.0;
    bool only_double = false;
    std::string json_file;
};

std::string text_of(const std::string& scene, const physics::Plan& plan, double tolerance) {
    constexpr const char* kFact = "  {:<22}{}\n";
    std::string text = fmt::format("Plan for '{}'\n", scene);
    text += fmt::format(kFact, "solver", physics::to_string(plan.solver.kind));
    text += fmt::format(kFact, "scalar", physics::to_string(plan.scalar));
    text += fmt::format(kFact, "substeps", plan.solver.substeps);
    text += fmt::format(kFact, "broadphase", plan.broadphase);
    text += fmt::format(kFact, "collision error",
                        fmt::format("at most {:.2g}, {} the tolerance of {:g}", plan.error_bound,
                                    plan.meets_tolerance ? "within" : "ABOVE", tolerance));
    return text + plan.reason + "\n";
}

std::string json_of(const std::string& scene, const physics::Plan& plan, double tolerance,
                    double rate_hz) {
    nlohmann::ordered_json json;
    json["scene"] = scene;
    json["tolerance"] = tolerance;
    json["rate_hz"] = rate_hz;
    json["solver"] = physics::to_string(plan.solver.kind);
    json["scalar"] = physics::to_string(plan.scalar);
    json["substeps"] = plan.solver.substeps;
    json["broadphase"] = plan.broadphase;
    json["error_bound"] = plan.error_bound;
    json["meets_tolerance"] = plan.meets_tolerance;
    json["cost_ns_per_body_tick"] = plan.cost_ns_per_body_tick;
    json["reason"] = plan.reason;
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

int execute(const PlanOptions& options) {
    const auto tolerance = physics::tolerance_from(options.tolerance);
    if (!tolerance) {
        complain("--tolerance is '" + options.tolerance +
                 "'; give auto, fast, exact, or a number above 0 and below 1");
        return kExitUsage;
    }
    const std::optional<LoadedScene> loaded = load(options.scene);
    if (!loaded) return kExitUsage;
    std::string error;
    std::unique_ptr<Output> json;
    if (!options.json_file.empty()) {
        json = Output::open(options.json_file, "--json", error);
        if (!json) {
            complain(error);
            return kExitFailure;
        }
    }
    physics::Fidelity fidelity;
    fidelity.tolerance = *tolerance;
    fidelity.tick_duration_s = 1.0 / options.rate_hz;
    fidelity.allow_float = !options.only_double;
    const physics::Plan plan = physics::plan(loaded->scene, fidelity);
    std::fputs(text_of(loaded->name, plan, *tolerance).c_str(),
               json && json->is_stdout() ? stderr : stdout);
    if (json) {
        json->stream() << json_of(loaded->name, plan, *tolerance, options.rate_hz);
        if (!json->finish(error)) {
            complain(error);
            return kExitFailure;
        }
    }
    return 0;
}

}  // namespace

void add_plan(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand(
        "plan", "The cheapest way to advance a scene that meets a tolerance, and why");
    const auto options = std::make_shared<PlanOptions>();
    declare(*command, options->scene);
    command
        ->add_option("--tolerance", options->tolerance,
                     "Collision error, a part of the speed: above 0 and below 1, or auto, fast, "
                     "exact")
        ->required();
    command->add_option("--rate", options->rate_hz, "Ticks per second")
        ->check(number_from(1e-4, 1e9))
        ->capture_default_str();
    command->add_flag("--double", options->only_double, "No single precision");
    command->add_option("--json", options->json_file, "File for the plan; - for the terminal");
    command->callback([options, &exit_code] { exit_code = execute(*options); });
}

}  // namespace fts::lab
