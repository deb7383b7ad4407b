// The innermost tests of the swept solver's broad phase: which of many straight paths, sorted by
// the cell they start in, may meet one another. They reject and never decide: what passes is looked
// at again with exact arithmetic, so that every instruction set gives the same results.
//
// Two discs at d = p - q with the relative motion w until the end touch only if
// d.d + 2 d.w <= R^2: while they approach, the square of their distance falls by no more than its
// first rate times the time. With the point twice ahead of each, e = p + 2 (motion until the end),
// that is d.(e_p - e_q) <= R^2: two products.
//
// Lengths are in cells and times in parts of the span, both in single precision whatever the
// solver's; the limits that are passed in make up for it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/physics/simd_level.h"

namespace fts::physics {

// So many floats after the last path may be read. They must be NaN, which is near to nothing.
inline constexpr std::uint32_t kMostLanes = 8;

struct PathLanes {
    const float* x;  // at the start of the span
    const float* y;
    const float* ahead_x;  // where twice the motion of the span leads
    const float* ahead_y;
    const float* radius;  // not used when all are equal
    const std::uint32_t* body;
    const std::uint32_t* first;  // of each cell, rows of `width` cells, and one more at the end
    std::uint32_t width, height;
    std::uint32_t paths;
};

// Which of the paths from `first` on may meet path `path`: bit k is for the one k further on.
struct FoundPairs {
    std::uint32_t path, first, bits;
};

// Paths may meet when they start within `reach` on each axis, which is at most `rows` cells. No
// path starts in the outer `rows` columns or the last `rows` rows.
struct PairSearch {
    float reach;
    std::uint32_t rows;
    float limit;  // of the square of the distance; without the radii unless all are equal
    std::size_t most_of_one;  // most_found
};

// How far a search for pairs has come: the next path, and its row.
struct PairCursor {
    std::uint32_t path = 0, row = 0;
};

// One path alone may find so many at most.
constexpr std::size_t most_found(std::size_t paths, std::uint32_t rows) {
    return paths / 4 + 2 * (std::size_t{rows} + 1);
}

struct CellWindow {  // inclusive
    std::uint32_t first_x, first_y, last_x, last_y;
};

// One path against those of a window, from `half_time` on: half the part of the span that is over.
struct PathSearch {
    float x, y;              // at that time
    float ahead_x, ahead_y;  // where twice the motion that is left leads
    float radius;            // not used when all are equal
    float half_time;
    float limit;
};

// A search for whom either of two bodies may meet, from one time on and with one limit.
struct SightSearch {
    std::uint32_t bodies[2];
    PathSearch paths[2];
    float close_limit;  // as `limit`, of the distance at that time
};

// One of the two, and whom it may meet.
struct Meeting {
    std::uint32_t one, other;
};

// Of each of the two how many are within the close limit, itself among them, and which path is its
// own: both are where their paths say, but for round-off within the limits.
struct Seen {
    std::size_t count;  // of meetings
    std::uint32_t close[2];
    std::uint32_t paths[2];
};

// Who touches one of two discs at that time. A limit is the square of a distance when all radii
// are equal, and otherwise what is added to the square of the sum of radii.
struct TouchSearch {
    float x[2], y[2];
    float radius[2];
    float limit[2];
    float half_time;
};

struct LaneKernels {
    // Appends to `found` from `cursor` on, until there is no room for what one path more may find,
    // or all paths were looked at; returns how many. Some have no bits.
    std::size_t (*find_pairs)(const PathLanes&, const PairSearch&, PairCursor& cursor,
                              FoundPairs* found, std::size_t room);
    // These write the bodies whose paths they find, which may be all, and return how many.
    std::size_t (*find_meeting)(const PathLanes&, const CellWindow&, const PathSearch&,
                                std::uint32_t* found);
    std::size_t (*find_touching)(const PathLanes&, const CellWindow&, const TouchSearch&,
                                 std::uint32_t* found);
    // As find_meeting, for both of two that are within the window. They are not found themselves.
    // There is room for two more meetings than it finds, since it writes before it knows.
    Seen (*see)(const PathLanes&, const CellWindow&, const SightSearch&, Meeting* found);
};

// Those of a level that the processor has. Above AVX2 there are none of their own, since few cells
// hold so many paths: wider vectors would be slower.
const LaneKernels& lane_kernels(SimdLevel level, bool equal_radii);

}  // namespace fts::physics
