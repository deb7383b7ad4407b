#include "common/physics/solver.h"

#include <array>
#include <cassert>

#include "common/physics/solver_discrete.h"
#include "common/physics/solver_event.h"
#include "common/physics/solver_seed.h"
#include "common/physics/solver_swept.h"

namespace fts::physics {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"seed", "discrete", "swept", "event"};

}  // namespace

std::string_view to_string(SolverKind kind) {
    return kNames[static_cast<std::size_t>(kind)];
}

std::optional<SolverKind> solver_from(std::string_view name) {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        if (kNames[i] == name) return static_cast<SolverKind>(i);
    }
    return std::nullopt;
}

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_solver(const SolverChoice& choice) {
    assert(choice.substeps >= 1 && choice.substeps <= kMaxSubsteps);
    switch (choice.kind) {
        case SolverKind::kSeed:
            return make_seed_solver<Scalar>(choice.substeps);
        case SolverKind::kDiscrete:
            return make_discrete_solver<Scalar>(choice.substeps);
        case SolverKind::kSwept:
            return make_swept_solver<Scalar>();
        case SolverKind::kEvent:
            return make_event_solver<Scalar>();
    }
    assert(false);
    return nullptr;
}

template std::unique_ptr<Solver<double>> make_solver(const SolverChoice&);
template std::unique_ptr<Solver<float>> make_solver(const SolverChoice&);

}  // namespace fts::physics
