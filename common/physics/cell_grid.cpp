#include "common/physics/cell_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "common/physics/crowd_range.h"
#include "common/physics/near_lanes.h"

namespace fts::physics {
namespace {

constexpr double kCellsPerDisc = 2.0;
constexpr std::uint32_t kFewestCells = 16;
// By how much cells are wider than the largest disc, so that the round-off of a cell's number never
// parts what touches: that grows with the number of cells.
constexpr double kMargin = 8.0;
// How many discs tell where most of them are.
constexpr std::size_t kSample = 256;

}  // namespace

template <typename Scalar>
std::uint32_t CellGrid<Scalar>::Axis::cell_of(Scalar x_m) const {
    const Scalar cell = (x_m - origin_m) * cells_per_m;
    const Scalar inside = std::min(std::max(Scalar(0), cell), last_cell);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(inside));
}

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
    const auto most_cells =
        static_cast<std::uint32_t>(kCellsPerDisc * discs.count()) + kFewestCells;
    const Scalar reach = Scalar(2) * discs.largest_radius_m;
    const Scalar area = axis_[0].extent_m * axis_[1].extent_m;
    const Scalar height = std::max(reach, std::sqrt(area / static_cast<Scalar>(most_cells)));
    divide(axis_[1], height, most_cells);
    divide(axis_[0], reach, std::max(1U, most_cells / axis_[1].cells));
    stride_ = axis_[0].cells + 2;

    // A row of images above the last, and what is read beyond the last cell.
    first_.resize(std::size_t{stride_} * (axis_[1].cells + 1) + 3);
    cell_.reserve(discs.count());
}

template <typename Scalar>
void CellGrid<Scalar>::find_overlaps(const Discs<Scalar>& discs, std::vector<DiscPair>& pairs) {
    sort(discs);
    if (discs.radius_m.empty()) {
        const Scalar reach = discs.largest_radius_m + discs.largest_radius_m;
        search<true>(reach * reach, pairs);
    } else {
        search<false>(Scalar(0), pairs);
    }
}

template <typename Scalar>
void CellGrid<Scalar>::count_cells(const Discs<Scalar>& discs) {
    std::fill(first_.begin(), first_.end(), 0);
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
        images_.push_back({x_m, y_m, {disc, cell}});
        ++first_[cell];
    };
    const auto add_row = [&](std::uint32_t disc, Scalar y_m, std::uint32_t cell,
                             std::uint32_t column) {
        const Scalar x_m = discs.x_m[disc];
        if (column == 1) add(disc, x_m + axis_[0].extent_m, y_m, cell + columns);
        if (column == columns) add(disc, x_m - axis_[0].extent_m, y_m, cell - columns);
    };
    for (std::uint32_t i = 0; i < discs.count(); ++i) {
        const std::uint32_t column = cell_[i] % stride_;
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
    for (std::uint32_t& first : first_) first = total += first;

    // What pads the last run is near to nothing.
    constexpr Scalar kFarAway = std::numeric_limits<Scalar>::infinity();
    for (std::vector<Scalar>* values : {&x_m_, &y_m_}) {
        values->resize(total + kLanes);
        std::fill(values->end() - kLanes, values->end(), kFarAway);
    }
    placed_.resize(total + kLanes);
    if (discs.radius_m.empty()) {
        put_into_cells<true>(discs);
    } else {
        radius_m_.resize(total + kLanes);
        put_into_cells<false>(discs);
    }
}

// Every cell is filled from its end.
template <typename Scalar>
template <bool kEqualRadii>
void CellGrid<Scalar>::put_into_cells(const Discs<Scalar>& discs) {
    Scalar *const x = x_m_.data(), *const y = y_m_.data();
    Placed* const placed = placed_.data();
    std::uint32_t* const first = first_.data();
    const auto put = [&](Scalar x_m, Scalar y_m, Placed what) {
        const std::uint32_t to = --first[what.cell];
        x[to] = x_m;
        y[to] = y_m;
        placed[to] = what;
        if constexpr (!kEqualRadii) radius_m_[to] = discs.radius_m[what.disc];
    };
    for (const Image& image : images_) put(image.x_m, image.y_m, image.placed);
    const std::uint32_t* const cell = cell_.data();
    for (std::uint32_t i = discs.count(); i-- > 0;) {
        put(discs.x_m[i], discs.y_m[i], {i, cell[i]});
    }
}

// The first lanes of a run are always looked at, since whether a run is empty cannot be foreseen.
template <typename Scalar>
template <bool kEqualRadii>
void CellGrid<Scalar>::search(Scalar reach_squared, std::vector<DiscPair>& pairs) const {
    const Scalar *const x = x_m_.data(), *const y = y_m_.data(), *const radius = radius_m_.data();
    const Placed* const placed = placed_.data();
    const std::uint32_t* const first = first_.data();
    const auto search_run = [&](std::uint32_t i, std::uint32_t j, std::uint32_t end) {
        do {
            std::uint32_t near = 0;
            if constexpr (kEqualRadii) {
                near = near_lanes(x + j, y + j, x[i], y[i], reach_squared);
            } else {
                near = overlapping_lanes(x + j, y + j, radius + j, x[i], y[i], radius[i]);
            }
            if (near != 0) [[unlikely]]
                add_pairs(i, j, near, end, pairs);
            j += kLanes;
        } while (j < end);
    };
    for (std::uint32_t row = 0; row < axis_[1].cells; ++row) {
        const std::uint32_t left = row * stride_ + 1;
        const std::uint32_t end = first[left + axis_[0].cells];
        for (std::uint32_t i = first[left]; i < end; ++i) {
            const std::uint32_t* const here = first + placed[i].cell;
            search_run(i, i + 1, here[2]);
            search_run(i, here[stride_ - 1], here[stride_ + 2]);
        }
    }
}

// Lanes beyond the run's end are another run's to find.
template <typename Scalar>
void CellGrid<Scalar>::add_pairs(std::uint32_t i, std::uint32_t begin, std::uint32_t lanes,
                                 std::uint32_t end, std::vector<DiscPair>& pairs) const {
    for (; lanes != 0; lanes &= lanes - 1) {
        const std::uint32_t j = begin + static_cast<std::uint32_t>(std::countr_zero(lanes));
        if (j < end) pairs.push_back({placed_[i].disc, placed_[j].disc});
    }
}

template <typename Scalar>
void CellGrid<Scalar>::read_order(std::vector<std::uint32_t>& order) const {
    order.clear();
    for (std::uint32_t row = 0; row < axis_[1].cells; ++row) {
        const std::uint32_t left = row * stride_ + 1;
        for (std::uint32_t i = first_[left]; i < first_[left + axis_[0].cells]; ++i) {
            order.push_back(placed_[i].disc);
        }
    }
}

template class CellGrid<double>;
template class CellGrid<float>;

}  // namespace fts::physics
