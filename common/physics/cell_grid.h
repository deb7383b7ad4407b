// Which discs overlap: a uniform grid whose cells are at least as wide as the largest disc, so that
// only neighbouring cells need be looked at. Made anew for every look by a counting sort, after
// which the discs of neighbouring cells of a row are one run of memory.
//
// A periodic box costs nothing in the search: what is near a side is placed a second time, as its
// image beyond the opposite one.
//
// Right for any places: coordinates beyond the grid count to its border cells, and the number of
// cells is bound by the number of discs however far they spread. The largest disc sets the size of
// all cells, so that very unequal discs are found rightly but slowly.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/physics/solver.h"

namespace fts::physics {

template <typename Scalar>
struct Discs {
    std::span<const Scalar> x_m, y_m;
    std::span<const Scalar> radius_m;  // empty: all have the largest
    Scalar largest_radius_m = Scalar(0);

    std::uint32_t count() const { return static_cast<std::uint32_t>(x_m.size()); }
};

struct DiscPair {
    std::uint32_t a, b;
};

template <typename Scalar>
class CellGrid {
  public:
    // Chooses the cells by where most of the discs are. To be called before the first search, when
    // the number of discs grows, or the largest of them; after that only the speed depends on it.
    void fit(const Discs<Scalar>& discs, const std::optional<typename Model<Scalar>::Box>& box);

    // Appends every pair whose distance is below the sum of its radii, in any order, but each once:
    // with a box (then all places must be inside) the distance to the nearest image.
    void find_overlaps(const Discs<Scalar>& discs, std::vector<DiscPair>& pairs);

    // The discs of the last search, neighbours near each other.
    void read_order(std::vector<std::uint32_t>& order) const;

  private:
    struct Axis {
        Scalar origin_m = Scalar(0);
        Scalar extent_m = Scalar(0);
        Scalar cells_per_m = Scalar(0);
        std::uint32_t cells = 1;
        Scalar last_cell = Scalar(0);

        std::uint32_t cell_of(Scalar x_m) const;  // never decreases with x_m
    };
    struct Placed {
        std::uint32_t disc;
        std::uint32_t cell;
    };
    struct Image {
        Scalar x_m, y_m;
        Placed placed;
    };

    void fit_axis(Axis& axis, std::span<const Scalar> x_m);
    void divide(Axis& axis, Scalar cell_m, std::uint32_t most_cells);
    void sort(const Discs<Scalar>& discs);
    void count_cells(const Discs<Scalar>& discs);
    // What only some scenes need is never inlined, so that a count of instructions shows it apart
    // (scripts/feature-cost).
    [[gnu::noinline]] void add_images(const Discs<Scalar>& discs);
    template <bool kEqualRadii>
    [[gnu::noinline]] void put_into_cells(const Discs<Scalar>& discs);
    template <bool kEqualRadii>
    [[gnu::noinline]] void search(Scalar reach_squared, std::vector<DiscPair>& pairs) const;
    void add_pairs(std::uint32_t i, std::uint32_t begin, std::uint32_t lanes, std::uint32_t end,
                   std::vector<DiscPair>& pairs) const;

    Axis axis_[2];
    std::uint32_t stride_ = 3;  // cells in a row, with a column of images at each end
    bool periodic_ = false;

    std::vector<std::uint32_t> cell_;   // by disc
    std::vector<std::uint32_t> first_;  // by cell: where in the next four its discs begin
    std::vector<Scalar> x_m_, y_m_, radius_m_;
    std::vector<Placed> placed_;
    std::vector<Image> images_;
    std::vector<Scalar> sample_;
};

extern template class CellGrid<double>;
extern template class CellGrid<float>;

}  // namespace fts::physics
