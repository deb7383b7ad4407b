// A comparison as JSON.
#include <cmath>

#include <nlohmann/json.hpp>

#include "server/lab/compare.h"

namespace fts::lab {
namespace {

using Json = nlohmann::ordered_json;

Json figure(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json local_json(const LocalAccuracy& local) {
    return {{"ticks", local.ticks},
            {"ticks_too_busy", local.ticks_too_busy},
            {"ticks_undecided", local.ticks_undecided},
            {"collisions", local.collisions},
            {"matched", local.matched},
            {"missed", local.missed},
            {"extra", local.extra},
            {"missed_per_1000", figure(local.missed_per_1000())},
            {"extra_per_1000", figure(local.extra_per_1000())},
            {"collision_error", figure(local.collision_error)},
            {"collision_error_of_ignoring", figure(local.error_of_ignoring)},
            {"time_error_ticks", figure(local.time_error_ticks)},
            {"angle_error_deg", figure(local.angle_error_deg)}};
}

Json global_json(const GlobalAccuracy& global) {
    Json diverges = nullptr;
    if (global.divergence) {
        diverges = {{"collisions", global.divergence->collisions},
                    {"reached", global.divergence->reached}};
    }
    return {{"ticks", global.ticks},
            {"collisions", global.ball_collisions},
            {"wall_collisions", global.wall_collisions},
            {"energy_error", figure(global.energy_error)},
            {"momentum_error", figure(global.momentum_error)},
            {"max_penetration_over_r", figure(global.penetration_over_r)},
            {"divergence", diverges},
            {"overruns", global.overruns},
            {"finite", global.finite},
            {"state_hash", global.state_hash}};
}

Json row_json(const CompareRow& row) {
    Json json = {{"solver", physics::to_string(row.setting.solver.kind)},
                 {"scalar", physics::to_string(row.setting.scalar)},
                 {"substeps", row.setting.solver.substeps},
                 {"command", row.command}};
    if (!row.skipped.empty()) {
        json["skipped"] = row.skipped;
        return json;
    }
    json["pareto"] = row.pareto;
    json["ns_per_body_tick"] = row.cost.ns_per_body_tick;
    json["ns_per_body_tick_least"] = row.cost.least_ns;
    json["ns_per_body_tick_most"] = row.cost.most_ns;
    json["collisions_per_s"] = row.cost.collisions_per_s;
    json["timed_ticks"] = row.cost.ticks;
    json["timed_repeats"] = row.cost.repeats;
    json["local"] = local_json(row.accuracy.local);
    json["global"] = global_json(row.accuracy.global);
    json["remarks"] = row.accuracy.remarks;
    return json;
}

}  // namespace

std::string json_of(const CompareRequest& request, const Comparison& comparison) {
    Json json = {{"scene", request.scene_name},    {"bodies", request.scene.bodies.size()},
                 {"seconds", request.seconds},     {"rate_hz", request.rate_hz},
                 {"ticks", comparison.run.ticks},  {"command", comparison.command},
                 {"done", comparison.done},        {"of", comparison.of},
                 {"stopped", comparison.stopped()}};
    json["rows"] = Json::array();
    for (const CompareRow& row : comparison.rows) json["rows"].push_back(row_json(row));
    return json.dump(2) + "\n";
}

}  // namespace fts::lab
