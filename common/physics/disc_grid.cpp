#include "common/physics/disc_grid.h"

#include <algorithm>
#include <cmath>

namespace fts::physics {
namespace {

// So that what has moved a little since it was put into its cell is still found.
constexpr double kCellSlack = 1.05;

}  // namespace

DiscGrid::DiscGrid(const Region& region, double widest_radius_m, std::size_t discs)
    : is_periodic_(region.is_periodic), min_m_(region.min_m) {
    const Vec2d extent = region.extent_m();
    const double number = static_cast<double>(discs) + 16.0;
    const double fair_m = std::sqrt(extent.x() * extent.y() / (2.0 * number));
    for (int axis = 0; axis < 2; ++axis) {
        const double cell_m =
            std::max({2.0 * kCellSlack * widest_radius_m, fair_m, extent[axis] / (4.0 * number)});
        cells_[axis] = std::max<std::int64_t>(1, static_cast<std::int64_t>(extent[axis] / cell_m));
        cells_per_m_[axis] = static_cast<double>(cells_[axis]) / extent[axis];
    }
    first_node_.assign(static_cast<std::size_t>(cells_[0] * cells_[1]), kNoNode);
    nodes_.reserve(discs);
}

void DiscGrid::clear() {
    std::fill(first_node_.begin(), first_node_.end(), kNoNode);
    nodes_.clear();
}

void DiscGrid::insert(std::uint32_t disc, const Vec2d& centre_m) {
    put(disc, cell_of(centre_m.x(), 0), cell_of(centre_m.y(), 1));
}

void DiscGrid::insert_wide(std::uint32_t disc, const Vec2d& centre_m, double radius_m) {
    std::int64_t low[2], high[2];
    for (int axis = 0; axis < 2; ++axis) {
        const double from = (centre_m[axis] - radius_m - min_m_[axis]) * cells_per_m_[axis];
        const double to = (centre_m[axis] + radius_m - min_m_[axis]) * cells_per_m_[axis];
        const double last = static_cast<double>(cells_[axis]) - 1.0;
        const double beyond = is_periodic_ ? last + 1.0 : 0.0;
        low[axis] = static_cast<std::int64_t>(std::floor(std::clamp(from, -beyond, last)));
        high[axis] = static_cast<std::int64_t>(std::floor(std::clamp(to, 0.0, last + beyond)));
        if (high[axis] - low[axis] >= cells_[axis]) {
            low[axis] = 0;
            high[axis] = cells_[axis] - 1;
        }
    }
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t x = low[0]; x <= high[0]; ++x) put(disc, x, y);
    }
}

std::int64_t DiscGrid::cell_of(double x_m, int axis) const {
    const double cell = (x_m - min_m_[axis]) * cells_per_m_[axis];
    const double last = static_cast<double>(cells_[axis]) - 1.0;
    return static_cast<std::int64_t>(std::clamp(cell, 0.0, last));
}

std::size_t DiscGrid::wrapped(std::int64_t cell, int axis) const {
    if (cell < 0) cell += cells_[axis];
    if (cell >= cells_[axis]) cell -= cells_[axis];
    return static_cast<std::size_t>(cell);
}

void DiscGrid::put(std::uint32_t disc, std::int64_t x, std::int64_t y) {
    const std::size_t cell = wrapped(y, 1) * static_cast<std::size_t>(cells_[0]) + wrapped(x, 0);
    nodes_.push_back({disc, first_node_[cell]});
    first_node_[cell] = static_cast<std::uint32_t>(nodes_.size() - 1);
}

}  // namespace fts::physics
