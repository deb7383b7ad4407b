// The loops that look through the paths of flight_paths.h, for one kind of processor each. What
// they find is the same on all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/physics/simd_level.h"

namespace fts::physics {

// In cells; the way is that of the whole window.
struct alignas(16) FlightPath {
    float x = 0.0F, y = 0.0F, way_x = 0.0F, way_y = 0.0F;
};

struct WhosePath {
    std::uint32_t body, cell;
};

// A stretch of paths.
struct PathRow {
    std::uint32_t first, end;
};

// For which paths the product of the distances to `self` at two fractions of the window is at most
// `limit`, and, where there are radii, the square of both radii more.
struct PathTest {
    FlightPath self;
    float from = 0.0F, to = 0.0F;
    float limit = 0.0F, radius = 0.0F;
    float close_limit = 0.0F;  // of the square of the distance at `from`
};

// Who may meet a path, and who is close to it at the first of the two fractions; see PathKernels.
struct PathSight {
    std::uint32_t meeting = 0, close = 0;
};

// A path, and who passes its test; see PathKernels.
struct PathPartners {
    std::uint32_t path, bits;
};

// So many paths of a row are looked at without asking whether they are there. Few rows have more.
inline constexpr std::uint32_t kPathsAtOnce = 8;
// A bit beyond those of three rows: one of them has more.
inline constexpr std::uint32_t kHasLongRow = 0x80000000;

// All paths, sorted by cells of which there are `width` in a row. `radii` is null where all are
// equal. What is beyond the last path is readable, and is nobody.
struct AllPaths {
    const FlightPath* path;
    const float* radius;
    const WhosePath* whose;
    const std::uint32_t* first;  // by cell
    std::uint32_t count, width;

    // A cell and the eight about it.
    std::array<PathRow, 3> rows_about(std::uint32_t cell) const {
        const std::uint32_t* const beside = first + cell - 1;
        const std::uint32_t *const below = beside - width, *const above = beside + width;
        return {{{below[0], below[3]}, {beside[0], beside[3]}, {above[0], above[3]}}};
    }
    // Of those the ones that come after a path, so that of two one has the other in these.
    std::array<PathRow, 2> rows_after(std::uint32_t path_number) const {
        const std::uint32_t* const cell = first + whose[path_number].cell;
        return {{{path_number + 1, cell[2]}, {cell[width - 1], cell[width + 2]}}};
    }
};

struct PathKernels {
    // kPathsAtOnce bits for the first paths of a row.
    std::uint32_t (*find)(const AllPaths& all, PathRow row, const PathTest& test);
    // The same of each of rows_about(cell), and kHasLongRow.
    std::uint32_t (*find_about)(const AllPaths& all, std::uint32_t cell, const PathTest& test);
    PathSight (*see_about)(const AllPaths& all, std::uint32_t cell, const PathTest& test);
    // The same as find_about for each path that has somebody in rows_after() it, whom the test is
    // made for. Returns how many they are.
    std::size_t (*find_pairs)(const AllPaths& all, const PathTest& test, PathPartners* found);
};

// The level is a supported one.
const PathKernels& path_kernels(SimdLevel level, bool equal_radii);

// Those of one level, only where the processor has it.
const PathKernels& path_kernels_avx2(bool equal_radii);
const PathKernels& path_kernels_avx512(bool equal_radii);

}  // namespace fts::physics
