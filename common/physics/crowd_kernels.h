// The innermost loops of the discrete solver, once for each width of vector instructions. They read
// and write plain memory, so that they can be compiled for a processor that others need not have.
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/physics/simd_level.h"

namespace fts::physics {

// So many elements may be read and written beyond the end of what a kernel works on.
inline constexpr std::uint32_t kWidestLanes = 16;

// Discs sorted by the cells of rows, as CellGrid has them; `a` and `b` take the pairs found.
template <typename Scalar>
struct CellSearch {
    const Scalar *x_m, *y_m;
    const Scalar* radius_m;      // null: reach_m is that of all pairs
    const std::uint32_t* disc;   // by place in the cells
    const std::uint32_t* cell;   // by disc
    const std::uint32_t* first;  // by cell: the first place in it
    std::uint32_t stride, columns, rows;
    Scalar reach_m;  // with `radius_m`: what is added to the sum of two radii
    std::uint32_t *a, *b;
    std::size_t capacity;       // of either
    std::size_t most_near_one;  // that a disc can have in the cells; less than the capacity
    bool few;                   // it is foreseen that hardly any pair is near
};

// How far a search has come. It stops early where the room for pairs might not suffice.
struct SearchProgress {
    std::uint32_t row = 0;
    std::uint32_t place = 0;  // 0: at the row's begin
    std::size_t found = 0;
};

// Pairs, and the places of their discs.
template <typename Scalar>
struct PairTest {
    const Scalar *x_m, *y_m;
    const Scalar* radius_m;  // null: reach_m is that of all pairs
    const std::uint32_t *a, *b;
    std::size_t count;
    Scalar reach_m;
    // Of a box whose opposite sides are one: places differ by less than this; else 0.
    Scalar extent_x_m, extent_y_m;
};

// Both ends belong to it.
template <typename Scalar>
struct Range2 {
    Scalar low_x_m, high_x_m, low_y_m, high_y_m;
};

template <typename Scalar>
struct Motion {
    Scalar *x_m, *y_m;
    const Scalar *vx_mps, *vy_mps;
    std::size_t count;
    Scalar span_s;
    Scalar usual_squared;   // of a speed
    std::uint32_t* faster;  // takes the numbers of those who are, ascending
};

template <typename Scalar>
struct Speeds {
    Scalar greatest_squared;
    std::size_t faster;  // how many
};

template <typename Scalar>
struct CrowdKernels {
    // Moves all by their velocities.
    Speeds<Scalar> (*advance)(const Motion<Scalar>& motion);
    // Writes the numbers of the places that are not inside, ascending; gives how many.
    std::size_t (*outside)(const Scalar* x_m, const Scalar* y_m, std::size_t count,
                           const Range2<Scalar>& inside, std::uint32_t* numbers);
    // Finds every pair of neighbouring cells that is nearer than its reach, each once.
    void (*search)(const CellSearch<Scalar>& cells, SearchProgress& progress);
    // Writes the numbers of the pairs that are nearer than their reach, ascending; gives how many.
    std::size_t (*pick)(const PairTest<Scalar>& pairs, std::uint32_t* numbers);
};

// Expects a level that is supported.
template <typename Scalar>
const CrowdKernels<Scalar>& crowd_kernels(SimdLevel level);

}  // namespace fts::physics
