#include "common/physics/flight_paths.h"

#include <cmath>
#include <limits>

#include "common/physics/crowd_range.h"
#include "common/physics/path_limits.h"

namespace fts::physics {
namespace {

// A fit looks at about so many flights.
constexpr std::size_t kSampledFlights = 1024;

// All but one in so many, and but so few, are slower than this part of the speed that leads as far
// as a path may in a window; the rest is for collisions to come.
constexpr std::size_t kFlightsPerFast = 4096;
constexpr std::size_t kFewFast = 2;
constexpr double kSpeedToCome = 1.17;
// Most measure no more than this part of a sample.
constexpr double kMostRadii = 0.9;

// So many start in a cell, where that makes it wide enough.
constexpr double kPathsPerCell = 1.75;
// Cells are wider than the largest disc by at least this part of it.
constexpr double kLeastRoom = 0.2;
// A part of the cells' width, for round-off.
constexpr double kRounding = 0.01;
// So many cells round them bodies may come to before the next fit.
constexpr std::uint32_t kBorderCells = 2;
constexpr double kWindowAtRestS = 1e9;

constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();

}  // namespace

template <typename Scalar>
void FlightPaths<Scalar>::fit(const RoomyVector<Flight>& flights,
                              std::span<const std::uint32_t> living, double now_s,
                              const std::optional<Box>& bounds, bool equal_radii) {
    const std::size_t count = living.size(), stride = 1 + count / kSampledFlights;
    const auto sampled = [&](double q, auto&& value_of) {
        sample_.clear();
        for (std::size_t i = 0; i < count; i += stride) {
            sample_.push_back(value_of(flights[living[i]]));
        }
        return quantile(sample_, q);
    };
    Vec low = flights[living[0]].position_at(now_s), high = low;
    sample_.clear();
    for (const std::uint32_t body : living) {
        const Vec position = flights[body].position_at(now_s);
        low = low.cwiseMin(position);
        high = high.cwiseMax(position);
        sample_.push_back(flights[body].velocity_mps.cwiseAbs().maxCoeff());
    }
    const std::size_t fast = std::max(kFewFast, count / kFlightsPerFast);
    const auto fastest =
        sample_.begin() + static_cast<std::ptrdiff_t>(count - std::min(fast, count));
    std::nth_element(sample_.begin(), fastest, sample_.end());
    const Scalar speed = static_cast<Scalar>(kSpeedToCome) * *fastest;
    for (int axis = 0; axis < 2; ++axis) {
        sampled(0.0, [&](const Flight& flight) { return flight.position_at(now_s)[axis]; });
        const CrowdRange<Scalar> range = crowd_range(sample_);
        low[axis] = std::max(low[axis], range.low - range.margin);
        high[axis] = std::min(high[axis], range.high + range.margin);
    }
    const auto radius_of = [](const Flight& flight) { return flight.radius_m; };
    largest_radius_m_ = sampled(1.0, radius_of);
    if (!equal_radii) {
        largest_radius_m_ = std::min(
            largest_radius_m_, static_cast<Scalar>(kRadiiOfMost) * sampled(kMostRadii, radius_of));
    }
    equal_radii_ = equal_radii;
    fit_cells(low, high, count);
    const Scalar way = static_cast<Scalar>(longest_way_) * cell_m_;
    const bool moves = std::isnormal(speed) && std::isnormal(way / speed);
    window_s_ = moves ? static_cast<double>(way / speed) : kWindowAtRestS;
    windows_per_s_ = 1.0 / window_s_;
    way_of_mps_ = static_cast<Scalar>(window_s_) * per_m_;
    fit_limits(flights.size());
    fit_borders(bounds);
}

template <typename Scalar>
void FlightPaths<Scalar>::fit_cells(const Vec& low_m, const Vec& high_m, std::size_t bodies) {
    const Vec extent = high_m - low_m;
    const auto cells = static_cast<Scalar>(bodies + kExtraCells);
    const Scalar room = extent.x() * extent.y() / static_cast<Scalar>(bodies);
    const Scalar diameter = Scalar(2) * largest_radius_m_;
    cell_m_ =
        std::max({static_cast<Scalar>(1.0 + kLeastRoom) * diameter,
                  std::sqrt(static_cast<Scalar>(kPathsPerCell) * room), extent.maxCoeff() / cells});
    per_m_ = Scalar(1) / cell_m_;
    const bool fits = std::isfinite(per_m_) && std::isfinite(extent.maxCoeff() * per_m_);
    if (!fits) cell_m_ = per_m_ = Scalar(0);
    columns_ = fits ? static_cast<std::uint32_t>(extent.x() * per_m_) + 1 + 2 * kBorderCells : 1;
    rows_ = fits ? static_cast<std::uint32_t>(extent.y() * per_m_) + 1 + 2 * kBorderCells : 1;
    origin_m_ = low_m - Vec::Constant(static_cast<Scalar>(1 + kBorderCells) * cell_m_);
    width_ = columns_ + 2;
    height_ = rows_ + 2;
    largest_radius_ = static_cast<float>(largest_radius_m_ * per_m_);
    longest_way_ = 0.5F * (static_cast<float>(1.0 - kRounding) - 2.0F * largest_radius_);
}

template <typename Scalar>
void FlightPaths<Scalar>::fit_limits(std::size_t bodies) {
    const float size = static_cast<float>(std::max(width_, height_));
    const auto far = static_cast<float>(origin_m_.cwiseAbs().maxCoeff() * per_m_);
    blur_ = kPlaceUnits * kFloatEpsilon * (size + 2.0F * kWayWhenTurned * longest_way_) +
            kPlaceUnits * static_cast<float>(std::numeric_limits<Scalar>::epsilon()) * (far + size);
    const float longest =
        2.0F * largest_radius_ + 2.0F * (1.0F + kWayWhenTurned) * longest_way_ + 1.0F;
    slack_ = kSlackBlurs * longest * blur_;
    // Where places are too coarse for that all are strays.
    if (!(4.0F * blur_ <= static_cast<float>(kRounding))) columns_ = 0;
    const std::size_t cells = std::size_t{width_} * height_;
    first_.resize(cells + 2);
    borders_.resize(cells);
    border_cells_.reserve(cells);
    starts_.reserve(bodies);
    places_.reserve(bodies);
    whose_.reserve(bodies);
    paths_.resize(bodies + kPathsAtOnce);
    found_.resize(bodies);
    kernels_ = &path_kernels(best_simd_level(), equal_radii_);
    if (!equal_radii_) radii_.resize(bodies + kPathsAtOnce);
    at_border_.reserve(bodies);
    sample_.reserve(bodies);
    strays_.reserve(bodies);
}

template <typename Scalar>
void FlightPaths<Scalar>::fit_borders(const std::optional<Box>& bounds) {
    std::fill(borders_.begin(), borders_.end(), std::uint8_t{0});
    border_cells_.clear();
    if (!bounds) return;
    const Scalar far = static_cast<Scalar>(longest_way_ + largest_radius_ + 4.0F * blur_) * cell_m_;
    const auto is_within = [&](std::uint32_t axis, std::uint32_t cell) {
        const Scalar low = origin_m_[axis] + static_cast<Scalar>(cell) * cell_m_;
        return bounds->min_m[axis] < low - far && low + cell_m_ + far < bounds->max_m[axis];
    };
    for (std::uint32_t y = 0; y < height_; ++y) {
        for (std::uint32_t x = 0; x < width_; ++x) {
            if (is_within(0, x) && is_within(1, y)) continue;
            borders_[std::size_t{y} * width_ + x] = 1;
            border_cells_.push_back(y * width_ + x);
        }
    }
}

template <typename Scalar>
void FlightPaths<Scalar>::begin(const RoomyVector<Flight>& flights,
                                std::span<const std::uint32_t> living, double from_s) {
    from_s_ = from_s;
    strays_.clear();
    at_border_.clear();
    places_.resize(flights.size());
    starts_.resize(living.size());
    std::fill(first_.begin(), first_.end(), 0U);
    const float low = 1.0F, way = longest_way_;
    const float high_x = std::nextafter(static_cast<float>(1 + columns_), 0.0F);
    const float high_y = std::nextafter(static_cast<float>(1 + rows_), 0.0F);
    const StartRules<Scalar> rules = {
        origin_m_, per_m_, way_of_mps_, {low, low, -way, -way}, {high_x, high_y, way, way}, width_};
    // Counts lie two places on, so that they turn into the first path of each cell while it is
    // filled.
    std::uint32_t* const counts = first_.data() + 2;
    PathStart* start = starts_.data();
    for (const std::uint32_t body : living) {
        const Flight& flight = flights[body];
        const bool fits =
            find_start<Scalar>(rules, flight.position_at(from_s), flight.velocity_mps, *start);
        if (!fits || !(flight.radius_m <= largest_radius_m_)) [[unlikely]] {
            strays_.push_back(body);
            places_[body] = {kStray, width_ + 1};
            continue;
        }
        ++counts[start->cell];
        start->body = body;
        ++start;
    }
    std::uint32_t sum = 0;
    for (std::uint32_t& first : first_) first = sum += first;
    sort_starts(static_cast<std::size_t>(start - starts_.data()));
    if (!equal_radii_) {
        for (std::size_t path = 0; path < whose_.size(); ++path) {
            radii_[path] = static_cast<float>(flights[whose_[path].body].radius_m * per_m_);
        }
    }
    for (const std::uint32_t cell : border_cells_) {
        for (std::uint32_t path = first_[cell]; path < first_[cell + 1]; ++path) {
            at_border_.push_back(whose_[path].body);
        }
    }
}

template <typename Scalar>
void FlightPaths<Scalar>::sort_starts(std::size_t count) {
    whose_.resize(count);
    std::uint32_t* const next = first_.data() + 1;
    Path* const paths = paths_.data();
    WhosePath* const whose = whose_.data();
    Place* const places = places_.data();
    const PathStart* const end = starts_.data() + count;
    for (const PathStart* from = starts_.data(); from != end; ++from) {
        const std::uint32_t path = next[from->cell]++;
        paths[path] = {from->x, from->y, from->way_x, from->way_y};
        whose[path] = {from->body, from->cell};
        places[from->body] = {path, from->cell};
    }
    std::fill_n(paths + count, kPathsAtOnce, Path{kNowhere, kNowhere, kNowhere, kNowhere});
}

template <typename Scalar>
bool FlightPaths<Scalar>::find_path(const Vec& position_m, const Vec& velocity_mps, float part,
                                    std::uint32_t cell, Path& path) const {
    const Vec place = (position_m - origin_m_) * per_m_;
    const Vec ways = velocity_mps * way_of_mps_;
    const auto way_x = static_cast<float>(ways.x()), way_y = static_cast<float>(ways.y());
    path = {static_cast<float>(place.x()) - way_x * part,
            static_cast<float>(place.y()) - way_y * part, way_x, way_y};
    const auto stays = [&](float start, float way, std::uint32_t in) {
        const float low = static_cast<float>(in) - longest_way_;
        const float high = static_cast<float>(in + 1) + longest_way_;
        const float from = start + way * part, to = start + way;
        return low <= from && from <= high && low <= to && to <= high &&
               std::abs(way) <= kWayWhenTurned * longest_way_;
    };
    return stays(path.x, path.way_x, cell % width_) && stays(path.y, path.way_y, cell / width_);
}

template <typename Scalar>
bool FlightPaths<Scalar>::follow(std::uint32_t body, const Flight& flight, double now_s) {
    if (is_stray(body)) return false;
    Path path;
    if (!find_path(flight.position_at(now_s), flight.velocity_mps, part_of(now_s),
                   places_[body].cell, path)) {
        remove(body);
        return false;
    }
    paths_[places_[body].path] = path;
    return true;
}

template <typename Scalar>
auto FlightPaths<Scalar>::see(const Turning<Scalar>& turning, double now_s, Scalar factor) const
    -> Sight {
    Sight sight;
    sight.body = turning.body;
    if (is_stray(turning.body)) return sight;
    const auto [path, cell] = places_[turning.body];
    const float part = part_of(now_s);
    sight.test = {{},
                  part,
                  2.0F - part,
                  limit_of_meetings(),
                  equal_radii_ ? 0.0F : radii_[path],
                  close_limit(factor)};
    sight.is_one = find_path(turning.position_m, turning.velocity_mps, part, cell, sight.test.self);
    if (sight.is_one) sight.seen = kernels_->see_about(all_paths(), cell, sight.test);
    return sight;
}

// Where radii differ, what the factor adds for the largest is added for all.
template <typename Scalar>
float FlightPaths<Scalar>::close_limit(Scalar factor) const {
    const float most = 2.0F * largest_radius_ * static_cast<float>(factor);
    const float reach = equal_radii_ ? 0.0F : 2.0F * largest_radius_;
    return most * most - reach * reach + slack_;
}

template <typename Scalar>
void FlightPaths<Scalar>::remove(std::uint32_t body) {
    if (is_stray(body)) return;
    paths_[places_[body].path].x = kNowhere;
    places_[body].path = kStray;
}

template class FlightPaths<double>;
template class FlightPaths<float>;

}  // namespace fts::physics
