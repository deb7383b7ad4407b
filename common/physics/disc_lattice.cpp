#include "common/physics/disc_lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fts::physics {
namespace {

constexpr int kBisections = 60;
// Small, so that a lattice of many more discs than asked for is never made.
constexpr double kStepDown = 0.75;
// In a long box so many numbers of columns are tried and no more.
constexpr std::size_t kMaxTried = 2048;

// Rows along one axis of a box; every second row may be shifted by half a column.
struct Rows {
    std::size_t count = 0;
    std::size_t rows = 0;
    std::size_t columns = 0;  // of the even rows
    double column_m = 0.0;
    bool shifted = false;
    bool odd_rows_are_shorter = false;
    bool along_y = false;
};

std::size_t whole(double number) {
    return static_cast<std::size_t>(std::clamp(std::floor(number), 0.0, 4e9));
}

// How far apart rows may be that are shifted by half of `column_m`, so that every second one
// clears its like as well.
double row_distance_m(double radius_m, double column_m) {
    const double half = 0.5 * column_m;
    const double squared = (2.0 * radius_m - half) * (2.0 * radius_m + half);
    return std::max(radius_m, std::sqrt(std::max(0.0, squared)));
}

void keep_better(Rows& best, const Rows& candidate) {
    if (candidate.count > best.count) best = candidate;
}

void try_columns_in_periodic(Rows& best, const Vec2d& extent, double radius_m,
                             std::size_t columns) {
    Rows rows = best;
    rows.columns = columns;
    rows.column_m = extent.x() / static_cast<double>(columns);
    if (rows.column_m < 2.0 * radius_m) return;
    rows.shifted = true;
    rows.odd_rows_are_shorter = false;
    rows.rows = 2 * whole(extent.y() / (2.0 * row_distance_m(radius_m, rows.column_m)));
    rows.count = rows.columns * rows.rows;
    keep_better(best, rows);
}

// `inner` is where centres may be.
void try_columns_in_walls(Rows& best, const Vec2d& inner, double radius_m, std::size_t columns) {
    for (const bool shorter : {false, true}) {
        Rows rows = best;
        rows.columns = columns;
        rows.shifted = true;
        rows.odd_rows_are_shorter = shorter;
        const double gaps = static_cast<double>(columns) - (shorter ? 1.0 : 0.5);
        if (!(gaps > 0.0)) continue;
        rows.column_m = inner.x() / gaps;
        if (columns > 1 && rows.column_m < 2.0 * radius_m) continue;
        rows.rows = 1 + whole(inner.y() / row_distance_m(radius_m, rows.column_m));
        rows.count = rows.columns * rows.rows - (shorter ? rows.rows / 2 : 0);
        keep_better(best, rows);
    }
}

Rows square_rows(const Region& region, const Vec2d& extent, double radius_m) {
    Rows rows;
    const double across = 2.0 * radius_m;
    rows.columns = whole(extent.x() / across);
    rows.rows = whole(extent.y() / across);
    if (rows.columns == 0 || rows.rows == 0) return {};
    const double columns = static_cast<double>(rows.columns);
    if (region.is_periodic) {
        rows.column_m = extent.x() / columns;
    } else {
        rows.column_m = rows.columns > 1 ? (extent.x() - across) / (columns - 1.0) : 0.0;
    }
    rows.count = rows.columns * rows.rows;
    return rows;
}

Rows best_rows(const Region& region, double radius_m) {
    Rows best;
    for (const bool along_y : {false, true}) {
        Vec2d extent = region.extent_m();
        if (along_y) std::swap(extent.x(), extent.y());
        Rows here = square_rows(region, extent, radius_m);
        here.along_y = along_y;
        if (here.count > 0) {
            // Wider columns than this let no more rows in.
            const double widest = 2.0 * std::numbers::sqrt3 * radius_m;
            const std::size_t most = whole(extent.x() / (2.0 * radius_m)) + 1;
            const std::size_t least = std::max<std::size_t>(1, whole(extent.x() / widest));
            const std::size_t stride = 1 + (most - std::min(most, least)) / kMaxTried;
            const Vec2d inner = extent - Vec2d::Constant(2.0 * radius_m);
            for (std::size_t columns = least; columns <= most; columns += stride) {
                if (region.is_periodic) {
                    try_columns_in_periodic(here, extent, radius_m, columns);
                } else {
                    try_columns_in_walls(here, inner, radius_m, columns);
                }
            }
        }
        keep_better(best, here);
    }
    return best;
}

std::vector<Vec2d> places_of(const Rows& rows, const Region& region, double radius_m) {
    Vec2d extent = region.extent_m();
    if (rows.along_y) std::swap(extent.x(), extent.y());
    const bool walled = !region.is_periodic;
    const double margin = walled ? radius_m : 0.0;
    const double height = extent.y() - 2.0 * margin;
    const double gaps = static_cast<double>(rows.rows) - (walled ? 1.0 : 0.0);
    const double row_m = gaps > 0.0 ? height / gaps : 0.0;
    std::vector<Vec2d> places;
    places.reserve(rows.count);
    for (std::size_t row = 0; row < rows.rows; ++row) {
        const bool odd = row % 2 == 1;
        const double shift = odd && rows.shifted ? 0.5 * rows.column_m : 0.0;
        const std::size_t columns = rows.columns - (odd && rows.odd_rows_are_shorter ? 1 : 0);
        for (std::size_t column = 0; column < columns; ++column) {
            Vec2d place(margin + shift + static_cast<double>(column) * rows.column_m,
                        margin + static_cast<double>(row) * row_m);
            if (rows.along_y) std::swap(place.x(), place.y());
            places.push_back(region.min_m + place);
        }
    }
    return places;
}

// A hexagonal lattice about the origin, as much of it as is on the platform.
template <typename Visit>
void for_each_round_place(const Region& region, double radius_m, Visit&& visit) {
    const double row_m = std::numbers::sqrt3 * radius_m;
    const auto rows = static_cast<std::int64_t>(whole(region.max_m.y() / row_m));
    const auto columns = static_cast<std::int64_t>(whole(region.max_m.x() / (2.0 * radius_m))) + 1;
    for (std::int64_t row = -rows; row <= rows; ++row) {
        const double shift = row % 2 == 0 ? 0.0 : radius_m;
        for (std::int64_t column = -columns; column <= columns; ++column) {
            const Vec2d place(2.0 * radius_m * static_cast<double>(column) + shift,
                              row_m * static_cast<double>(row));
            if (region.holds(place, radius_m)) visit(place);
        }
    }
}

}  // namespace

std::size_t lattice_capacity(const Region& region, double radius_m) {
    if (!region.round) return best_rows(region, radius_m).count;
    std::size_t count = 0;
    for_each_round_place(region, radius_m, [&](const Vec2d&) { ++count; });
    return count;
}

std::vector<Vec2d> lattice_places(const Region& region, double radius_m) {
    if (!region.round) return places_of(best_rows(region, radius_m), region, radius_m);
    std::vector<Vec2d> places;
    for_each_round_place(region, radius_m, [&](const Vec2d& place) { places.push_back(place); });
    return places;
}

double lattice_radius_m(const Region& region, std::size_t count) {
    // No arrangement covers more than all of the area.
    double high = std::sqrt(region.area_m2() / (std::numbers::pi * static_cast<double>(count)));
    double low = high;
    for (int i = 0; i < kBisections && lattice_capacity(region, low) < count; ++i) {
        high = low;
        low *= kStepDown;
    }
    if (lattice_capacity(region, low) < count) return 0.0;
    for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (low + high);
        (lattice_capacity(region, middle) >= count ? low : high) = middle;
    }
    return low;
}

}  // namespace fts::physics
