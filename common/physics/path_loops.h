// The kernels of path_kernels.h for one kind of vector. For the sources that are compiled for one
// instruction set each: everything is a template of Pack, which is local to its source, so that
// nothing compiled for one of them is ever shared with another.
//
// Pack is made of a test, holds what is asked of all paths of it, and answers
// bits_of<kEqualRadii, kClose>(path, radius): of kPathsAtOnce paths a bit for each that passes,
// and, where it is asked for, beyond these one for each that is close. ask_for(path, radius) makes
// it the same test for somebody else.
#pragma once

#include "common/physics/path_kernels.h"

namespace fts::physics {

template <typename Pack, bool kEqualRadii>
struct PathLoops {
    static constexpr std::uint32_t kAll = (1U << kPathsAtOnce) - 1U;

    template <bool kClose = false>
    static std::uint32_t bits_of(const AllPaths& all, PathRow row, const Pack& pack) {
        const std::uint32_t count = row.end - row.first;
        const std::uint32_t there = count >= kPathsAtOnce ? kAll : (1U << count) - 1U;
        const float* const radius = kEqualRadii ? nullptr : all.radius + row.first;
        return pack.template bits_of<kEqualRadii, kClose>(all.path + row.first, radius) &
               (kClose ? there | there << kPathsAtOnce : there);
    }

    static std::uint32_t long_row(PathRow row) {
        return row.end - row.first > kPathsAtOnce ? kHasLongRow : 0;
    }

    static std::uint32_t find(const AllPaths& all, PathRow row, const PathTest& test) {
        return bits_of(all, row, Pack(test));
    }

    static std::uint32_t find_about(const AllPaths& all, std::uint32_t cell, const PathTest& test) {
        const Pack pack(test);
        const auto [below, beside, above] = all.rows_about(cell);
        return bits_of(all, below, pack) | bits_of(all, beside, pack) << kPathsAtOnce |
               bits_of(all, above, pack) << 2 * kPathsAtOnce | long_row(below) | long_row(beside) |
               long_row(above);
    }

    static PathSight see_about(const AllPaths& all, std::uint32_t cell, const PathTest& test) {
        const Pack pack(test);
        const auto [below, beside, above] = all.rows_about(cell);
        const std::uint32_t one = bits_of<true>(all, below, pack);
        const std::uint32_t two = bits_of<true>(all, beside, pack);
        const std::uint32_t three = bits_of<true>(all, above, pack);
        const std::uint32_t is_long = long_row(below) | long_row(beside) | long_row(above);
        const auto side_by_side = [&](std::uint32_t from) {
            return (one >> from & kAll) | (two >> from & kAll) << kPathsAtOnce |
                   (three >> from & kAll) << 2 * kPathsAtOnce | is_long;
        };
        return {side_by_side(0), side_by_side(kPathsAtOnce)};
    }

    static std::size_t find_pairs(const AllPaths& all, const PathTest& test, PathPartners* found) {
        Pack pack(test);
        PathPartners* out = found;
        for (std::uint32_t i = 0; i < all.count; ++i) {
            pack.ask_for(all.path[i], kEqualRadii ? 0.0F : all.radius[i]);
            const auto [beside, above] = all.rows_after(i);
            const std::uint32_t bits = bits_of(all, beside, pack) |
                                       bits_of(all, above, pack) << kPathsAtOnce |
                                       long_row(beside) | long_row(above);
            *out = {i, bits};
            out += bits != 0 ? 1 : 0;
        }
        return static_cast<std::size_t>(out - found);
    }

    static constexpr PathKernels kTable{find, find_about, see_about, find_pairs};
};

}  // namespace fts::physics
