// Which solver advances a scene, and how finely: the handle of the trade of speed for accuracy. See
// fidelity.h for what chooses it from a scene and a tolerance.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace fts::physics {

enum class SolverKind : std::uint8_t {
    kSeed,      // the algorithm of 2013: move, test every pair, push apart, respond by angles
    kDiscrete,  // move, find overlaps, impulse along the line of centres; fast, never exact
    kSwept,     // exact times of impact inside each tick, in time order
    kEvent,     // a calendar of predicted collisions that survives across ticks
};

inline constexpr std::uint32_t kMaxSubsteps = 1024;

struct SolverChoice {
    SolverKind kind = SolverKind::kSwept;
    std::uint32_t substeps =
        1;  // [1, kMaxSubsteps]; of `seed` and `discrete`, the others need none
};

// "seed", "discrete", "swept", "event".
std::string_view to_string(SolverKind kind);
std::optional<SolverKind> solver_from(std::string_view name);

}  // namespace fts::physics
