// Every solver and scalar on one scene: the accuracy vector of each beside its cost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/physics/scene.h"
#include "server/lab/accuracy.h"
#include "server/lab/cost.h"
#include "server/lab/setting.h"

namespace fts::lab {

struct CompareRequest {
    std::string scene_name;  // as it is given to fts-lab
    physics::Scene scene;
    double seconds = 10.0;
    double rate_hz = 60.0;
    std::vector<physics::SolverKind> solvers;  // in this order
    std::vector<std::uint32_t> substeps;       // of those that have any
    std::vector<physics::ScalarKind> scalars;
    SamplingLimits sampling;
    CostLimits cost;
};

struct CompareRow {
    Setting setting;
    std::string skipped;  // why; empty when measured
    Cost cost;
    Accuracy accuracy;
    bool pareto = false;
    std::string command;  // that makes this row again
};

struct Comparison {
    std::vector<CompareRow> rows;  // by cost; skipped ones last
    std::size_t done = 0, of = 0;  // settings; fewer when stopped
    Run run;
    std::string command;
    bool stopped() const { return done < of; }
};

std::vector<Setting> settings_of(const CompareRequest& request);

// `progress` is told how many settings are done, of how many, and which is next. `keep_going` is
// asked between ticks; once it says no, what is not finished is left out.
Comparison compare(const CompareRequest& request, const KeepGoing& keep_going,
                   const std::function<void(std::size_t, std::size_t, const Setting&)>& progress);

// For people, with a key beneath.
std::string table_of(const CompareRequest& request, const Comparison& comparison);
// For programs. What does not apply is null.
std::string json_of(const CompareRequest& request, const Comparison& comparison);
// Cost against collision error. Empty when no row has an error to show.
std::string svg_of(const CompareRequest& request, const Comparison& comparison);

}  // namespace fts::lab
