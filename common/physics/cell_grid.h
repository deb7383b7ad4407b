// Which discs are near each other: a uniform grid whose cells are at least as wide as the largest
// disc and the margin, so that only neighbouring cells need be looked at. Made anew for every look
// by a counting sort, after which the discs of neighbouring cells of a row are one run of memory.
//
// A periodic box costs nothing in the search: what is near a side is placed a second time, as its
// image beyond the opposite one.
//
// Right for any places: coordinates beyond the grid count to its border cells, and the number of
// cells is bound by the number of discs however far they spread. The largest disc sets the size of
// all cells, so that very unequal discs are found rightly but slowly.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/physics/crowd_kernels.h"
#include "common/physics/roomy_vector.h"
#include "common/physics/solver.h"

namespace fts::physics {

template <typename Scalar>
struct Discs {
    std::span<const Scalar> x_m, y_m;
    std::span<const Scalar> radius_m;  // empty: all have the largest
    Scalar largest_radius_m = Scalar(0);

    std::uint32_t count() const { return static_cast<std::uint32_t>(x_m.size()); }
    Scalar radius_of(std::uint32_t i) const {
        return radius_m.empty() ? largest_radius_m : radius_m[i];
    }
};

struct NearPairs {
    RoomyVector<std::uint32_t> a, b;  // with room for more
    std::size_t count = 0;
};

template <typename Scalar>
class CellGrid {
  public:
    explicit CellGrid(SimdLevel level = best_simd_level()) : level_(level) {}

    // Chooses the cells by where most of the discs are. To be called before the first search, when
    // the number of discs grows, or the box; after that only the speed depends on it.
    void fit(const Discs<Scalar>& discs, const std::optional<typename Model<Scalar>::Box>& box);

    // Every pair whose distance is below the sum of its radii and `margin_m` >= 0, in any order,
    // but each once: with a box (then all places must be inside, and no pair that near through two
    // images) the distance to the nearest image, to round-off.
    void find_near(const Discs<Scalar>& discs, Scalar margin_m, NearPairs& pairs);

    // Calls `look(disc)` for every disc that was inside `range` at the last search, and for others
    // near it. Not with a box.
    template <typename Look>
    void visit(const typename Model<Scalar>::Box& range, Look look) const;

    // The discs of the last search, neighbours near each other.
    void read_order(RoomyVector<std::uint32_t>& order) const;

  private:
    struct Axis {
        Scalar origin_m = Scalar(0);
        Scalar extent_m = Scalar(0);
        Scalar cells_per_m = Scalar(0);
        std::uint32_t cells = 1;
        Scalar last_cell = Scalar(0);

        std::uint32_t cell_of(Scalar x_m) const;  // never decreases with x_m
    };
    struct Image {
        Scalar x_m, y_m;
        std::uint32_t disc, cell;
    };

    void fit_axis(Axis& axis, std::span<const Scalar> x_m);
    void divide(Axis& axis, Scalar cell_m, std::uint32_t most_cells);
    void lay_out(std::uint32_t discs, Scalar reach_m);
    void sort(const Discs<Scalar>& discs);
    void count_cells(const Discs<Scalar>& discs);
    // What only some scenes need is never inlined, so that a count of instructions shows it apart
    // (scripts/feature-cost).
    [[gnu::noinline]] void add_images(const Discs<Scalar>& discs);
    template <bool kEqualRadii>
    [[gnu::noinline]] void put_into_cells(const Discs<Scalar>& discs);
    template <bool kEqualRadii>
    [[gnu::noinline]] void search(Scalar reach_m, bool few, NearPairs& pairs) const;

    SimdLevel level_;
    Axis axis_[2];
    std::uint32_t stride_ = 3;  // cells in a row, with a column of images at each end
    std::uint32_t most_in_cell_ = 0;
    bool periodic_ = false;

    RoomyVector<std::uint32_t> cell_;           // by disc
    RoomyVector<std::uint32_t> first_;          // by cell: the first place of its discs
    RoomyVector<Scalar> x_m_, y_m_, radius_m_;  // by place
    RoomyVector<std::uint32_t> disc_;           // by place
    std::vector<Image> images_;
    std::vector<std::uint32_t> at_side_;
    std::vector<Scalar> sample_;
};

template <typename Scalar>
inline std::uint32_t CellGrid<Scalar>::Axis::cell_of(Scalar x_m) const {
    const Scalar cell = (x_m - origin_m) * cells_per_m;
    const Scalar inside = std::min(std::max(Scalar(0), cell), last_cell);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(inside));
}

template <typename Scalar>
template <typename Look>
void CellGrid<Scalar>::visit(const typename Model<Scalar>::Box& range, Look look) const {
    const Axis &column = axis_[0], &row = axis_[1];
    const std::uint32_t left = column.cell_of(range.min_m.x()) + 1;
    const std::uint32_t beyond_right = column.cell_of(range.max_m.x()) + 2;
    const std::uint32_t last_row = row.cell_of(range.max_m.y());
    for (std::uint32_t r = row.cell_of(range.min_m.y()); r <= last_row; ++r) {
        const std::uint32_t* const first = first_.data() + std::size_t{r} * stride_;
        for (std::uint32_t i = first[left]; i < first[beyond_right]; ++i) look(disc_[i]);
    }
}

extern template class CellGrid<double>;
extern template class CellGrid<float>;

}  // namespace fts::physics
