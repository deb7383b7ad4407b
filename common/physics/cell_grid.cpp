#include "common/physics/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/physics/crowd_range.h"

namespace fts::physics {
namespace {

constexpr double kCellsPerDisc = 2.0;
constexpr std::uint32_t kFewestCells = 16;
// By how much cells are wider than the largest disc, so that the round-off of a cell's number never
// parts what touches: that grows with the number of cells.
constexpr double kMargin = 8.0;
// How many discs tell where most of them are.
constexpr std::size_t kSample = 256;
// With less of a margin, in units of the largest sum of radii, hardly any discs are near.
constexpr double kFewMargin = 0.02;
constexpr std::uint32_t kBeyondCells = 3;

std::uint32_t most_cells_for(std::uint32_t discs) {
    return static_cast<std::uint32_t>(kCellsPerDisc * discs) + kFewestCells;
}

}  // namespace

template <typename Scalar>
void CellGrid<Scalar>::fit_axis(Axis& axis, std::span<const Scalar> x_m) {
    sample_.clear();
    const std::size_t step = std::max<std::size_t>(1, x_m.size() / kSample);
    for (std::size_t i = 0; i < x_m.size(); i += step) sample_.push_back(x_m[i]);
    if (sample_.empty()) sample_.push_back(Scalar(0));
    const CrowdRange<Scalar> range = crowd_range(sample_);
    axis.origin_m = range.low - range.margin;
    axis.extent_m = (range.high - range.low) + Scalar(2) * range.margin;
}

template <typename Scalar>
void CellGrid<Scalar>::divide(Axis& axis, Scalar cell_m, std::uint32_t most_cells) {
    constexpr Scalar kRoundOff =
        static_cast<Scalar>(kMargin) * std::numeric_limits<Scalar>::epsilon();
    const Scalar at_most = std::min(axis.extent_m / cell_m, static_cast<Scalar>(most_cells));
    const Scalar wanted = at_most / (Scalar(1) + kRoundOff * at_most);
    axis.cells = wanted > Scalar(1) ? static_cast<std::uint32_t>(wanted) : 1;
    axis.last_cell = static_cast<Scalar>(axis.cells - 1);
    axis.cells_per_m = axis.cells > 1 ? static_cast<Scalar>(axis.cells) / axis.extent_m : Scalar(0);
}

template <typename Scalar>
void CellGrid<Scalar>::fit(const Discs<Scalar>& discs,
                           const std::optional<typename Model<Scalar>::Box>& box) {
    periodic_ = box.has_value();
    for (int a = 0; a < 2; ++a) {
        Axis& axis = axis_[a];
        if (box) {
            axis.origin_m = box->min_m[a];
            axis.extent_m = box->extent_m()[a];
        } else {
            fit_axis(axis, a == 0 ? discs.x_m : discs.y_m);
        }
    }
    first_.reserve(std::size_t{3} * (most_cells_for(discs.count()) + kBeyondCells));
    cell_.reserve(discs.count());
}

template <typename Scalar>
void CellGrid<Scalar>::lay_out(std::uint32_t discs, Scalar reach_m) {
    const std::uint32_t most_cells = most_cells_for(discs);
    const Scalar area = axis_[0].extent_m * axis_[1].extent_m;
    const Scalar height = std::max(reach_m, std::sqrt(area / static_cast<Scalar>(most_cells)));
    divide(axis_[1], height, most_cells);
    divide(axis_[0], reach_m, std::max(1U, most_cells / axis_[1].cells));
    stride_ = axis_[0].cells + 2;
    // A row of images above the last, and what is read beyond the last cell.
    first_.assign(std::size_t{stride_} * (axis_[1].cells + 1) + kBeyondCells, 0);
}

template <typename Scalar>
void CellGrid<Scalar>::find_near(const Discs<Scalar>& discs, Scalar margin_m, NearPairs& pairs) {
    const Scalar largest = discs.largest_radius_m + discs.largest_radius_m;
    lay_out(discs.count(), largest + margin_m);
    sort(discs);
    const bool few = margin_m < static_cast<Scalar>(kFewMargin) * largest;
    discs.radius_m.empty() ? search<true>(largest + margin_m, few, pairs)
                           : search<false>(margin_m, few, pairs);
}

template <typename Scalar>
void CellGrid<Scalar>::count_cells(const Discs<Scalar>& discs) {
    cell_.resize(discs.count());
    images_.clear();
    const Axis column = axis_[0], row = axis_[1];
    const std::uint32_t stride = stride_;
    std::uint32_t *const cells = cell_.data(), *const first = first_.data();
    const Scalar *const x = discs.x_m.data(), *const y = discs.y_m.data();
    for (std::uint32_t i = 0; i < discs.count(); ++i) {
        const std::uint32_t cell = row.cell_of(y[i]) * stride + column.cell_of(x[i]) + 1;
        cells[i] = cell;
        ++first[cell];
    }
}

// Half of the neighbours of every cell are looked at, so that images are needed left, right and
// above.
template <typename Scalar>
void CellGrid<Scalar>::add_images(const Discs<Scalar>& discs) {
    const std::uint32_t columns = axis_[0].cells, rows = axis_[1].cells;
    const auto add = [&](std::uint32_t disc, Scalar x_m, Scalar y_m, std::uint32_t cell) {
        images_.push_back({x_m, y_m, disc, cell});
        ++first_[cell];
    };
    const auto add_row = [&](std::uint32_t disc, Scalar y_m, std::uint32_t cell,
                             std::uint32_t column) {
        const Scalar x_m = discs.x_m[disc];
        if (column == 1) add(disc, x_m + axis_[0].extent_m, y_m, cell + columns);
        if (column == columns) add(disc, x_m - axis_[0].extent_m, y_m, cell - columns);
    };
    // Only what is near a side can be in a cell there.
    const auto inner = [](const Axis& axis) {
        const Scalar rim_m = Scalar(1.5) * (axis.extent_m / static_cast<Scalar>(axis.cells));
        return std::pair(axis.origin_m + rim_m, axis.origin_m + (axis.extent_m - rim_m));
    };
    const auto [left_m, right_m] = inner(axis_[0]);
    const auto [bottom_m, top_m] = inner(axis_[1]);
    at_side_.resize(discs.count());
    const std::size_t at_side =
        crowd_kernels<Scalar>(level_).outside(discs.x_m.data(), discs.y_m.data(), discs.count(),
                                              {left_m, right_m, bottom_m, top_m}, at_side_.data());
    for (std::size_t k = 0; k < at_side; ++k) {
        const std::uint32_t i = at_side_[k], column = cell_[i] % stride_;
        add_row(i, discs.y_m[i], cell_[i], column);
        if (cell_[i] < stride_) {
            const Scalar above_m = discs.y_m[i] + axis_[1].extent_m;
            const std::uint32_t cell_above = cell_[i] + rows * stride_;
            add(i, discs.x_m[i], above_m, cell_above);
            add_row(i, above_m, cell_above, column);
        }
    }
}

template <typename Scalar>
void CellGrid<Scalar>::sort(const Discs<Scalar>& discs) {
    count_cells(discs);
    if (periodic_) add_images(discs);
    std::uint32_t total = 0;
    most_in_cell_ = 0;
    for (std::uint32_t& first : first_) {
        most_in_cell_ = std::max(most_in_cell_, first);
        first = total += first;
    }

    x_m_.resize(total + kWidestLanes);
    y_m_.resize(total + kWidestLanes);
    disc_.resize(total + kWidestLanes);
    if (discs.radius_m.empty()) {
        put_into_cells<true>(discs);
    } else {
        radius_m_.resize(total + kWidestLanes);
        put_into_cells<false>(discs);
    }
}

// Every cell is filled from its end.
template <typename Scalar>
template <bool kEqualRadii>
void CellGrid<Scalar>::put_into_cells(const Discs<Scalar>& discs) {
    Scalar *const x = x_m_.data(), *const y = y_m_.data();
    std::uint32_t *const disc = disc_.data(), *const first = first_.data();
    const auto put = [&](Scalar x_m, Scalar y_m, std::uint32_t which, std::uint32_t cell) {
        const std::uint32_t to = --first[cell];
        x[to] = x_m;
        y[to] = y_m;
        disc[to] = which;
        if constexpr (!kEqualRadii) radius_m_[to] = discs.radius_m[which];
    };
    for (const Image& image : images_) put(image.x_m, image.y_m, image.disc, image.cell);
    const std::uint32_t* const cell = cell_.data();
    for (std::uint32_t i = discs.count(); i-- > 0;) put(discs.x_m[i], discs.y_m[i], i, cell[i]);
}

template <typename Scalar>
template <bool kEqualRadii>
void CellGrid<Scalar>::search(Scalar reach_m, bool few, NearPairs& pairs) const {
    const CrowdKernels<Scalar>& kernels = crowd_kernels<Scalar>(level_);
    // In its own cell, the next one and three of the next row.
    const std::size_t most_near_one = 5 * std::size_t{most_in_cell_};
    const std::size_t least_room = most_near_one + 4 * kWidestLanes;
    SearchProgress progress;
    for (;;) {
        if (pairs.a.size() < progress.found + least_room) {
            const std::size_t room = 2 * (progress.found + least_room) + disc_.size();
            pairs.a.resize(room);
            pairs.b.resize(room);
        }
        kernels.search(
            {x_m_.data(), y_m_.data(), kEqualRadii ? nullptr : radius_m_.data(), disc_.data(),
             cell_.data(), first_.data(), stride_, axis_[0].cells, axis_[1].cells, reach_m,
             pairs.a.data(), pairs.b.data(), pairs.a.size(), most_near_one, few},
            progress);
        pairs.count = progress.found;
        if (progress.row == axis_[1].cells) return;
    }
}

template <typename Scalar>
void CellGrid<Scalar>::read_order(RoomyVector<std::uint32_t>& order) const {
    order.clear();
    for (std::uint32_t row = 0; row < axis_[1].cells; ++row) {
        const std::uint32_t left = row * stride_ + 1;
        for (std::uint32_t i = first_[left]; i < first_[left + axis_[0].cells]; ++i) {
            order.push_back(disc_[i]);
        }
    }
}

template class CellGrid<double>;
template class CellGrid<float>;

}  // namespace fts::physics
