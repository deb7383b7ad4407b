// One way to advance a scene: a solver, how finely, and in which numbers.
#pragma once

#include <string>

#include "common/physics/fidelity.h"
#include "common/physics/solver_choice.h"

namespace fts::lab {

struct Setting {
    physics::SolverChoice solver;
    physics::ScalarKind scalar = physics::ScalarKind::kDouble;
};

inline bool has_substeps(const Setting& setting) {
    return setting.solver.kind == physics::SolverKind::kSeed ||
           setting.solver.kind == physics::SolverKind::kDiscrete;
}

// "discrete x4 float"; substeps only where there are any.
inline std::string to_string(const Setting& setting) {
    std::string name(physics::to_string(setting.solver.kind));
    if (has_substeps(setting)) name += " x" + std::to_string(setting.solver.substeps);
    return name + " " + std::string(physics::to_string(setting.scalar));
}

// As options of fts-lab: "--solver discrete --substeps 4 --scalar float".
inline std::string flags_of(const Setting& setting) {
    std::string flags = "--solver " + std::string(physics::to_string(setting.solver.kind));
    if (has_substeps(setting)) flags += " --substeps " + std::to_string(setting.solver.substeps);
    return flags + " --scalar " + std::string(physics::to_string(setting.scalar));
}

}  // namespace fts::lab
