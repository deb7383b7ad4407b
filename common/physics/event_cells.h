// The cells in which bodies in straight flight are looked up: a uniform grid whose cells are at
// least as wide as the largest disc, so that two discs that touch are in the same cell or in
// neighbouring ones. Lists of bodies are linked through the bodies themselves.
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

#include "common/physics/solver.h"

namespace fts::physics {

template <typename Scalar>
class EventCells {
  public:
    static constexpr std::uint32_t kNobody = 0xffffffff;

    // Makes empty cells, at least `least_width_m` wide, that suit bodies at `positions_m`; the
    // bounds of what is bounded, and whether opposite sides are one.
    void fit(std::span<const Vec2<Scalar>> positions_m, Scalar least_width_m,
             const std::optional<typename Model<Scalar>::Box>& bounds, bool periodic);

    // Whether bodies have spread, gathered or moved on so much that other cells would suit them.
    bool still_suits(std::span<const Vec2<Scalar>> sample_m);

    std::uint32_t cell_of(std::uint32_t axis, Scalar x_m) const;
    std::uint32_t last(std::uint32_t axis) const { return axis_[axis].last; }
    // Where cell `index` begins, and the one below it ends.
    Scalar edge_m(std::uint32_t axis, std::uint32_t index) const {
        return axis_[axis].origin_m + axis_[axis].width_m * static_cast<Scalar>(index);
    }

    // The first body of a cell. Around the grid is a ring of cells in which nobody ever is: the
    // cells of three rows about (x, y) begin at corner(x, y), corner(x, y) + stride() and so on.
    std::uint32_t& first(std::uint32_t x, std::uint32_t y) {
        return first_[corner(x, y) + stride_ + 1];
    }
    std::uint32_t first(std::uint32_t x, std::uint32_t y) const {
        return first_[corner(x, y) + stride_ + 1];
    }
    const std::uint32_t* corner_of(std::uint32_t x, std::uint32_t y) const {
        return first_.data() + corner(x, y);
    }
    std::uint32_t stride() const { return stride_; }

  private:
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

    std::size_t corner(std::uint32_t x, std::uint32_t y) const {
        return std::size_t{y} * stride_ + x;
    }
    Range range_of(std::uint32_t axis, std::span<const Vec2<Scalar>> positions_m);
    void divide(Axis& axis, const Range& range, Scalar width_m, std::size_t bodies);

    std::array<Axis, 2> axis_;
    std::uint32_t stride_ = 3;
    std::vector<std::uint32_t> first_;
    std::vector<Scalar> scratch_;
};

extern template class EventCells<double>;
extern template class EventCells<float>;

}  // namespace fts::physics
