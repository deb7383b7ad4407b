// The cells in which bodies in straight flight are looked up: a uniform grid whose cells are at
// least as wide as the largest disc, so that two discs that touch are in the same cell or in
// neighbouring ones. A cell has places for a few bodies, next to those of the cells beside it, so
// that a look around reads three short rows; where more come together they are in a list besides.
//
// In an open scene the border cells extend to infinity; the grid covers where most bodies are, and
// has no more cells than there are bodies. In a periodic one it covers the box, and the columns
// (and rows) beyond a side are those at the opposite side.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/physics/flight.h"
#include "common/physics/roomy_vector.h"
#include "common/physics/simd_level.h"
#include "common/physics/solver.h"

namespace fts::physics {

template <typename Scalar>
class EventCells {
  public:
    // Makes empty cells, at least `least_width_m` wide, that suit bodies at `positions_m`; the
    // bounds of what is bounded, and whether opposite sides are one. `slots` is above every body's
    // index.
    void fit(std::span<const Vec2<Scalar>> positions_m, Scalar least_width_m,
             const std::optional<typename Model<Scalar>::Box>& bounds, bool periodic,
             std::uint32_t slots);

    // Whether bodies have spread, gathered or moved on so much that other cells would suit them.
    bool still_suits(std::span<const Vec2<Scalar>> sample_m);

    // Where (among `last() + 1`) along an axis a coordinate is.
    std::uint32_t cell_of(std::uint32_t axis, Scalar x_m) const;
    std::uint32_t last(std::uint32_t axis) const { return axis_[axis].last; }
    // Where cell `index` begins, and the one below it ends.
    Scalar edge_m(std::uint32_t axis, std::uint32_t index) const {
        return axis_[axis].origin_m + axis_[axis].width_m * static_cast<Scalar>(index);
    }

    // Nobody is in any cell.
    void clear();
    // A body that is in no cell comes into one, or leaves the one it is in.
    void put_in(std::uint32_t body, std::uint32_t x, std::uint32_t y);
    void take_out(std::uint32_t body, std::uint32_t x, std::uint32_t y);

    // Those in `columns` <= 3 cells from (x, y) on, of each of so many rows, in no order. `found`
    // has room for them, and for kSpare more that are written over. Returns one past the last.
    //
    // Around the grid is a ring of cells in which nobody ever is: coordinates are counted from
    // there, which makes them one more than those of `cell_of`.
    static constexpr std::uint32_t kSpare = 16;
    std::uint32_t* find(std::uint32_t x, std::uint32_t y, std::uint32_t columns, std::uint32_t rows,
                        std::uint32_t* found) const;

    // Those in the three cells that are next to that of a body and the two beside it, up or down
    // an axis. Returns one past the last.
    std::uint32_t* find_three(const std::uint32_t* cell, std::uint32_t axis, std::uint32_t up,
                              std::uint32_t* found) const;

    // Those in the cells about two bodies, up to `end`; bit k of about[i] is set where the k-th is
    // about the i-th of the two. No `end` where they are not in neighbouring cells, or too many are
    // about them: then they are to be found one by one.
    struct AboutTwo {
        std::uint32_t* end = nullptr;
        std::uint32_t about[2] = {0, 0};
    };
    static constexpr std::uint32_t kMostAboutTwo = 32;
    // Each is in the cell [0], [1], counted as those of `cell_of`.
    AboutTwo find_about_two(const std::uint32_t* one, const std::uint32_t* other,
                            std::uint32_t* found) const;

    // The cell (x, y), counted as those of `cell_of`, and those about it will be asked for.
    // Inlined, or gcc leaves calls away that only fetch.
    [[gnu::always_inline]] void fetch(std::uint32_t x, std::uint32_t y) const {
        for (std::uint32_t row = 0; row < 3; ++row) {
            const Cell* const cell = cells_.data() + index_of(x, y + row);
            __builtin_prefetch(cell);
            __builtin_prefetch(cell + 2);
        }
    }

  private:
    static constexpr std::uint32_t kPlaces = 4;
    // Vacant places hold kNobody, and are the last ones. Where more come together than there are
    // places, the last place holds kListed and the first of a list of at least two.
    static constexpr std::uint32_t kListed = 0x80000000;
    struct Cell {
        std::uint32_t place[kPlaces];
    };
    struct Range {
        Scalar low_m = Scalar(0), high_m = Scalar(0);
    };
    struct Axis {
        Scalar origin_m = Scalar(0);
        Scalar width_m = Scalar(1);
        Scalar cells_per_m = Scalar(0);
        std::uint32_t last = 0;
        Range fitted;
    };

    // The three by three cells about each of two, among those about both.
    struct Views {
        std::uint32_t columns, rows;
        std::uint32_t first_column[2], first_row[2];
    };

    template <std::uint32_t kColumns>
    std::uint32_t* find_in(const Cell* row, std::uint32_t rows, std::uint32_t* found) const;
    std::uint32_t* copy_list(const Cell& cell, std::uint32_t* found) const;
    static bool has_list(const Cell& cell) {
        return cell.place[kPlaces - 1] >= kListed && cell.place[kPlaces - 1] != kNobody;
    }
    std::size_t index_of(std::uint32_t x, std::uint32_t y) const {
        return std::size_t{y} * stride_ + x;
    }
    Range range_of(std::uint32_t axis, std::span<const Vec2<Scalar>> positions_m);
    void divide(Axis& axis, const Range& range, Scalar width_m, std::size_t bodies);

    std::array<Axis, 2> axis_;
    bool has_avx512_ = best_simd_level() >= SimdLevel::kAvx512;
    std::uint32_t stride_ = 3;
    RoomyVector<Cell> cells_;
    std::vector<std::uint32_t> next_;  // by body, in such a list
    std::vector<Scalar> scratch_;
};

extern template class EventCells<double>;
extern template class EventCells<float>;

}  // namespace fts::physics
