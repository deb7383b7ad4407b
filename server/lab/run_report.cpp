#include "server/lab/run_report.h"

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

namespace fts::lab {
namespace {

constexpr const char* kFact = "  {:<22}{}\n";

std::string hash_text(std::uint64_t hash) {
    return fmt::format("{:016x}", hash);
}

nlohmann::json pair_of(const physics::Vec2d& vector) {
    return {vector.x(), vector.y()};
}

std::uint32_t substeps_of(const Setting& setting) {
    return has_substeps(setting) ? setting.solver.substeps : 1;
}

}  // namespace

std::string text_of(const RunReport& report) {
    const RunResult& result = report.result;
    const physics::CollisionAudit& audit = result.audit;
    std::string text = fmt::format("Run of '{}'{}\n", report.scene,
                                   result.was_stopped ? ", stopped before its end" : "");
    const auto fact = [&text](const char* name, const std::string& value) {
        text += fmt::format(kFact, name, value);
    };
    fact("solver", to_string(report.settings.setting));
    if (!report.plan.empty()) fact("because", report.plan);
    fact("time", fmt::format("{:g} s in {} ticks of {:g} a second", result.simulated_s,
                             result.ticks, report.settings.rate_hz));
    fact("bodies", result.falls == 0
                       ? std::to_string(result.bodies_at_start)
                       : fmt::format("{}, of which {} fell", result.bodies_at_start, result.falls));
    fact("collisions", fmt::format("{} of two balls, {} with a wall", audit.ball_collisions,
                                   audit.wall_collisions));
    text += "Conservation\n";
    fact("kinetic energy",
         fmt::format("{:.9g} J, then {:.9g} J: a change of {:+.2e}", result.energy_at_start_j,
                     result.energy_at_end_j, result.energy_error()));
    fact("momentum", fmt::format("({:.4g}, {:.4g}) Ns, then ({:.4g}, {:.4g}) Ns: {}",
                                 result.momentum_at_start_ns.x(), result.momentum_at_start_ns.y(),
                                 result.momentum_at_end_ns.x(), result.momentum_at_end_ns.y(),
                                 audit.wall_collisions > 0
                                     ? "walls push"
                                     : fmt::format("{:.2e} of all |p|", result.momentum_error())));
    fact("worst energy error", fmt::format("{:.2e} of the pair's energy, in any one collision",
                                           audit.worst_energy_error));
    fact("worst momentum error", fmt::format("{:.2e} of the pair's momentum, in any one collision",
                                             audit.worst_momentum_error));
    fact("deepest overlap",
         fmt::format("{:.2e} of a radius, of any two at any tick", result.deepest_overlap));
    text += "Cost\n";
    fact("stepping", fmt::format("{:.3g} s", result.stepping_s));
    fact("per ball and tick", fmt::format("{:.4g} ns", result.ns_per_body_tick()));
    fact("collisions a second", fmt::format("{:.4g}", result.collisions_per_s()));
    fact("overruns", fmt::format("{} of the event budget, stepped again", result.overruns));
    fact("state hash", hash_text(result.state_hash));
    return text;
}

std::string json_of(const RunReport& report) {
    const RunResult& result = report.result;
    const physics::CollisionAudit& audit = result.audit;
    const Setting& setting = report.settings.setting;
    nlohmann::ordered_json json;
    json["scene"] = report.scene;
    json["solver"] = physics::to_string(setting.solver.kind);
    json["scalar"] = physics::to_string(setting.scalar);
    json["substeps"] = substeps_of(setting);
    json["rate_hz"] = report.settings.rate_hz;
    json["seconds"] = result.simulated_s;
    json["bodies"] = result.bodies_at_start;
    json["bodies_final"] = result.bodies_at_end;
    json["falls"] = result.falls;
    json["ticks"] = result.ticks;
    json["collisions"] = audit.ball_collisions;
    json["wall_collisions"] = audit.wall_collisions;
    json["energy_initial"] = result.energy_at_start_j;
    json["energy_final"] = result.energy_at_end_j;
    json["energy_error"] = result.energy_error();
    json["momentum_initial"] = pair_of(result.momentum_at_start_ns);
    json["momentum_final"] = pair_of(result.momentum_at_end_ns);
    json["momentum_error"] = result.momentum_error();
    json["worst_energy_error"] = audit.worst_energy_error;
    json["worst_momentum_error"] = audit.worst_momentum_error;
    json["max_penetration_over_r"] = result.deepest_overlap;
    json["overruns"] = result.overruns;
    json["state_hash"] = hash_text(result.state_hash);
    json["stepping_s"] = result.stepping_s;
    json["ns_per_body_tick"] = result.ns_per_body_tick();
    json["collisions_per_s"] = result.collisions_per_s();
    json["stopped"] = result.was_stopped;
    if (!report.plan.empty()) json["plan"] = report.plan;
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace fts::lab
