#include "common/physics/broadphase.h"

#include <algorithm>
#include <cmath>

#include "common/physics/crowd_range.h"

namespace fts::physics {

template <typename Scalar>
std::uint32_t Broadphase<Scalar>::Axis::cell_of(Scalar x_m) const {
    const Scalar cell = (x_m - origin_m) * cells_per_m;
    if (!(cell > Scalar(0))) return 0;
    if (cell >= static_cast<Scalar>(last_cell)) return last_cell;
    return static_cast<std::uint32_t>(cell);
}

template <typename Scalar>
void Broadphase<Scalar>::fit_axis(Axis& axis, Scalar low_m, Scalar high_m, Scalar cell_m,
                                  std::size_t bodies) {
    axis.origin_m = low_m;
    const Scalar wanted = cell_m > Scalar(0) ? (high_m - low_m) / cell_m : Scalar(0);
    axis.last_cell = static_cast<std::uint32_t>(std::min(wanted, static_cast<Scalar>(bodies)));
    axis.cells_per_m = axis.last_cell == 0
                           ? Scalar(0)
                           : static_cast<Scalar>(axis.last_cell + 1) / (high_m - low_m);
}

template <typename Scalar>
void Broadphase<Scalar>::reserve(std::uint32_t slots) {
    first_node_.reserve(kUsualCellsPerBody * (slots + 1));
    nodes_.reserve(kUsualCellsPerBody * slots);
    box_.reserve(slots);
    cells_.reserve(slots);
    place_.reserve(slots);
    seen_in_query_.reserve(slots);
    placed_.reserve(slots);
    wide_.reserve(slots);
    scratch_.reserve(slots);
}

template <typename Scalar>
void Broadphase<Scalar>::begin(std::span<const Box<Scalar>> boxes, std::uint32_t slots) {
    Scalar low[2] = {}, high[2] = {};
    Scalar cell = Scalar(0);
    constexpr Scalar Box<Scalar>::*kMin[2] = {&Box<Scalar>::min_x_m, &Box<Scalar>::min_y_m};
    constexpr Scalar Box<Scalar>::*kMax[2] = {&Box<Scalar>::max_x_m, &Box<Scalar>::max_y_m};
    for (int axis = 0; axis < 2 && !boxes.empty(); ++axis) {
        scratch_.clear();
        for (const auto& box : boxes) {
            scratch_.push_back(Scalar(0.5) * (box.*kMin[axis] + box.*kMax[axis]));
        }
        const CrowdRange<Scalar> range = crowd_range(scratch_);
        low[axis] = range.low - range.margin;
        high[axis] = range.high + range.margin;
        scratch_.clear();
        for (const auto& box : boxes) scratch_.push_back(box.*kMax[axis] - box.*kMin[axis]);
        cell = std::max(cell, Scalar(2) * quantile(scratch_, 0.5));
    }
    const Scalar area = (high[0] - low[0]) * (high[1] - low[1]);
    cell = std::max(cell, std::sqrt(area / static_cast<Scalar>(boxes.size() + 1)));
    for (int axis = 0; axis < 2; ++axis) {
        fit_axis(axis_[axis], low[axis], high[axis], cell, boxes.size());
    }
    first_node_.assign(std::size_t{axis_[0].last_cell + 1} * (axis_[1].last_cell + 1), kNoNode);
    nodes_.clear();
    placed_.clear();
    wide_.clear();
    box_.resize(slots);
    cells_.resize(slots);
    seen_in_query_.resize(slots, 0);
    place_.assign(slots, Place::kNowhere);
}

template <typename Scalar>
auto Broadphase<Scalar>::cells_of(const Box<Scalar>& box) const -> Cells {
    return {axis_[0].cell_of(box.min_x_m), axis_[1].cell_of(box.min_y_m),
            axis_[0].cell_of(box.max_x_m), axis_[1].cell_of(box.max_y_m)};
}

template <typename Scalar>
void Broadphase<Scalar>::place(std::uint32_t body, const Box<Scalar>& box) {
    box_[body] = box;
    const bool known = place_[body] != Place::kNowhere;
    if (!known) placed_.push_back(body);
    if (place_[body] == Place::kWide) return;

    const Cells before = cells_[body];
    Cells cells = cells_of(box);
    if (known) {
        cells = {std::min(cells.x0, before.x0), std::min(cells.y0, before.y0),
                 std::max(cells.x1, before.x1), std::max(cells.y1, before.y1)};
    }
    if (cells.count() > kMaxCellsPerBody) {
        place_[body] = Place::kWide;
        wide_.push_back(body);
        return;
    }
    for (std::uint32_t y = cells.y0; y <= cells.y1; ++y) {
        for (std::uint32_t x = cells.x0; x <= cells.x1; ++x) {
            if (known && before.holds(x, y)) continue;
            std::uint32_t& first = first_node_[y * (axis_[0].last_cell + 1) + x];
            nodes_.push_back({body, first});
            first = static_cast<std::uint32_t>(nodes_.size() - 1);
        }
    }
    cells_[body] = cells;
    place_[body] = Place::kInCells;
}

template class Broadphase<double>;
template class Broadphase<float>;

}  // namespace fts::physics
