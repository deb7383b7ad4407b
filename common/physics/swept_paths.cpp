#include "common/physics/swept_paths.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/physics/crowd_range.h"

namespace fts::physics {
namespace {

// A fit looks at about so many bodies, and holds for so many spans.
constexpr std::size_t kSampledBodies = 1024;
constexpr std::uint32_t kSpansPerFit = 64;

// Who moves more than so many times what most do is a stray.
constexpr double kMost = 0.9;
constexpr double kWaysOfMost = 2.6;
// A span may be so much shorter than what the grid was fitted to before that is wasteful.
constexpr double kShortestSpan = 0.5;
constexpr double kLongestSpan = 1.05;

constexpr std::size_t kFoundAtOnce = 256;
constexpr std::size_t kCellsPerBody = 1;
// So many cells round them bodies may come to before the next fit.
constexpr std::uint32_t kBorder = 2;
// With the margins, however the bodies lie.
constexpr std::size_t kMostCellsPerBody = 40;
constexpr std::uint32_t kMostRows = 4;  // of cells, on which an end of a pair may lie

template <typename Scalar>
Scalar sampled(std::vector<Scalar>& values, double q) {
    return values.empty() ? Scalar(0) : quantile(values, q);
}

}  // namespace

template <typename Scalar>
void SweptPaths<Scalar>::begin(const Bodies<Scalar>& bodies, std::span<const Vec> places_m,
                               bool equal_radii, Scalar span_s) {
    if (must_fit(bodies, equal_radii, span_s)) fit(bodies, places_m, equal_radii, span_s);
    ++spans_since_fit_;
    span_s_ = span_s;
    half_per_s_ = span_s > Scalar(0) ? Scalar(0.5) / span_s : Scalar(0);
    per_mps_ = Scalar(2) * span_s * per_m_;
    if (!is_known_order(bodies)) {
        order_.clear();
        for (const BodyId id : bodies.ids) order_.push_back(id.index);
    }
    if (equal_radii) {
        find_cells<true>(bodies, places_m);
        sort<true>(bodies);
    } else {
        find_cells<false>(bodies, places_m);
        sort<false>(bodies);
    }
    lanes_ = lanes();
    if (spans_since_fit_ == 1) fitted_strays_ = strays_.size();
}

template <typename Scalar>
bool SweptPaths<Scalar>::must_fit(const Bodies<Scalar>& all, bool equal_radii,
                                  Scalar span_s) const {
    const std::size_t bodies = all.ids.size();
    // Where all are equal, none is asked whether it is too large.
    const bool is_other_radius =
        equal_radii && bodies > 0 && all.radius_m[all.ids[0].index] != largest_radius_m_;
    return is_other_radius || spans_since_fit_ >= kSpansPerFit || equal_radii != equal_radii_ ||
           span_s > static_cast<Scalar>(kLongestSpan) * fitted_span_s_ ||
           span_s < static_cast<Scalar>(kShortestSpan) * fitted_span_s_ ||
           strays_.size() > 2 * fitted_strays_ + bodies / 64 + 4 || bodies > 2 * fitted_bodies_ ||
           2 * bodies < fitted_bodies_;
}

template <typename Scalar>
void SweptPaths<Scalar>::fit(const Bodies<Scalar>& bodies, std::span<const Vec> places_m,
                             bool equal_radii, Scalar span_s) {
    const std::size_t count = bodies.ids.size();
    const std::size_t stride = 1 + count / kSampledBodies;
    const auto sample = [&](auto&& value_of) {
        sample_.clear();
        for (std::size_t i = 0; i < count; i += stride) {
            sample_.push_back(value_of(bodies.ids[i].index));
        }
    };
    Vec low = Vec::Zero(), high = Vec::Zero();
    for (int axis = 0; axis < 2 && count > 0; ++axis) {
        Scalar least = places_m[bodies.ids[0].index][axis], most = least;
        for (const BodyId id : bodies.ids) {
            least = std::min(least, places_m[id.index][axis]);
            most = std::max(most, places_m[id.index][axis]);
        }
        sample([&](std::uint32_t body) { return places_m[body][axis]; });
        const CrowdRange<Scalar> range = crowd_range(sample_);
        low[axis] = std::max(least, range.low - range.margin);
        high[axis] = std::min(most, range.high + range.margin);
    }
    sample([&](std::uint32_t body) { return bodies.velocity_mps[body].cwiseAbs().maxCoeff(); });
    const Scalar way = static_cast<Scalar>(kWaysOfMost) * sampled(sample_, kMost) * span_s;
    sample([&](std::uint32_t body) { return bodies.radius_m[body]; });
    largest_radius_m_ = sampled(sample_, 1.0);
    if (!equal_radii) {
        largest_radius_m_ = std::min(largest_radius_m_,
                                     static_cast<Scalar>(kRadiiOfMost) * sampled(sample_, kMost));
    }
    reserve(bodies.slots());
    fitted_span_s_ = span_s;
    fitted_bodies_ = count;
    spans_since_fit_ = 0;
    equal_radii_ = equal_radii;
    fit_cells(low, high, way, count);
    fit_limits(equal_radii);
}

template <typename Scalar>
void SweptPaths<Scalar>::reserve(std::size_t bodies) {
    first_.reserve(kMostCellsPerBody * (bodies + 2 * kExtraCells));
    for (std::vector<float>* lane : {&x_, &y_, &ahead_x_, &ahead_y_, &radius_}) {
        lane->reserve(bodies + kMostLanes);
    }
    for (std::vector<std::uint32_t>* by_body : {&order_, &cell_, &body_, &strays_, &near_}) {
        by_body->reserve(bodies);
    }
    starts_.reserve(bodies + 1);
    found_.reserve(most_found(bodies, kMostRows) + kFoundAtOnce);
    sample_.reserve(kSampledBodies);
}

template <typename Scalar>
void SweptPaths<Scalar>::fit_cells(const Vec& low_m, const Vec& high_m, Scalar way_m,
                                   std::size_t bodies) {
    const Vec extent = high_m - low_m;
    const auto cells = static_cast<Scalar>(bodies + kExtraCells);
    const Scalar spacing = std::sqrt(extent.x() * extent.y() / cells);
    const Scalar least_way = Scalar(0.01) * largest_radius_m_;
    const Scalar way = std::max(way_m, least_way);
    const Scalar wanted = std::max(Scalar(2) * largest_radius_m_, Scalar(0.7) * spacing);
    // Of round-off, which grows with the number of columns.
    constexpr auto kBlurOfAColumn =
        static_cast<Scalar>(2.0F * kNearBlurs * kPlaceUnits * kFloatEpsilon);
    const Scalar rounded =
        Scalar(1.01) + std::min(kBlurOfAColumn * (extent.maxCoeff() / wanted), Scalar(1));
    const Scalar reach = rounded * (Scalar(2) * largest_radius_m_ + Scalar(2) * way);
    const Scalar rows =
        std::clamp(std::floor(reach / wanted), Scalar(1), static_cast<Scalar>(kMostRows));
    cell_m_ = std::max({reach / rows, spacing / std::sqrt(static_cast<Scalar>(kCellsPerBody)),
                        extent.maxCoeff() / cells});
    per_m_ = Scalar(1) / cell_m_;
    const bool fits = std::isfinite(per_m_) && std::isfinite(cell_m_) &&
                      std::isfinite(extent.maxCoeff() * per_m_);
    if (!fits) per_m_ = cell_m_ = Scalar(0);
    margin_ = static_cast<std::uint32_t>(fits ? rows : Scalar(1));
    columns_ = fits ? static_cast<std::uint32_t>(extent.x() * per_m_) + 1 + 2 * kBorder : 0;
    rows_ = fits ? static_cast<std::uint32_t>(extent.y() * per_m_) + 1 + 2 * kBorder : 0;
    const Scalar border = static_cast<Scalar>(margin_ + kBorder) * cell_m_;
    origin_m_ = low_m - Vec::Constant(border);
    width_ = columns_ + 2 * margin_;
    height_ = rows_ + 2 * margin_;
    longest_way_ = static_cast<float>(way * per_m_);
    largest_radius_ = static_cast<float>(largest_radius_m_ * per_m_);
}

template <typename Scalar>
void SweptPaths<Scalar>::fit_limits(bool equal_radii) {
    const float size = static_cast<float>(std::max(width_, height_));
    const auto far = static_cast<float>(origin_m_.cwiseAbs().maxCoeff() * per_m_);
    blur_ = kPlaceUnits * kFloatEpsilon * (size + 2.0F * kWayWhenTurned * longest_way_) +
            kPlaceUnits * static_cast<float>(std::numeric_limits<Scalar>::epsilon()) * (far + size);
    reach_ = 2.0F * largest_radius_ + 2.0F * longest_way_ + kNearBlurs * blur_;
    if (!(reach_ <= static_cast<float>(margin_))) columns_ = 0;
    const float longest = 2.0F * largest_radius_ + 8.0F * longest_way_ + 1.0F;
    slack_ = kSlackBlurs * longest * blur_;
    const float reach = 2.0F * largest_radius_;
    limit_ = equal_radii ? reach * reach + slack_ : slack_;
}

template <typename Scalar>
bool SweptPaths<Scalar>::is_known_order(const Bodies<Scalar>& bodies) const {
    return order_.size() == bodies.ids.size() &&
           std::all_of(order_.begin(), order_.end(), [&](std::uint32_t body) {
               return body < bodies.slots() && bodies.alive[body] != 0;
           });
}

template <typename Scalar>
template <bool kEqualRadii>
void SweptPaths<Scalar>::find_cells(const Bodies<Scalar>& bodies, std::span<const Vec> places_m) {
    const auto low = static_cast<float>(margin_);
    const float high_x = std::nextafter(static_cast<float>(margin_ + columns_), 0.0F);
    const float high_y = std::nextafter(static_cast<float>(margin_ + rows_), 0.0F);
    const float way = 2.0F * longest_way_;
    const StartRules<Scalar> rules = {
        origin_m_, per_m_, per_mps_, {low, low, -way, -way}, {high_x, high_y, way, way}, width_};
    cell_.resize(bodies.slots());
    starts_.resize(order_.size() + 1);
    first_.assign(std::size_t{width_} * height_ + 2, 0);
    strays_.clear();
    PathStart* start = starts_.data();
    std::uint32_t *const counts = first_.data() + 2, *const cells = cell_.data();
    const Vec *const positions = places_m.data(), *const velocities = bodies.velocity_mps.data();
    for (const std::uint32_t body : order_) {
        bool fits = find_start<Scalar>(rules, positions[body], velocities[body], *start);
        if constexpr (!kEqualRadii) fits = fits && bodies.radius_m[body] <= largest_radius_m_;
        if (!fits) {
            strays_.push_back(body);
            cells[body] = kNoCell;
            continue;
        }
        cells[body] = start->cell;
        ++counts[start->cell];
        start->body = body;
        ++start;
    }
    starts_.resize(static_cast<std::size_t>(start - starts_.data()));
}

// Counts lie two places on, so that they turn into the first path of each cell while it is filled.
template <typename Scalar>
template <bool kEqualRadii>
void SweptPaths<Scalar>::sort(const Bodies<Scalar>& bodies) {
    std::uint32_t sum = 0;
    for (std::uint32_t& first : first_) first = sum += first;
    pad();
    std::uint32_t *const next = first_.data() + 1, *const body = body_.data();
    float *const x = x_.data(), *const y = y_.data();
    float *const ahead_x = ahead_x_.data(), *const ahead_y = ahead_y_.data();
    for (const PathStart& start : starts_) {
        const std::uint32_t path = next[start.cell]++;
        x[path] = start.x;
        y[path] = start.y;
        ahead_x[path] = start.x + start.way_x;
        ahead_y[path] = start.y + start.way_y;
        if constexpr (!kEqualRadii) {
            radius_[path] = static_cast<float>(bodies.radius_m[start.body] * per_m_);
        }
        body[path] = start.body;
    }
    std::copy(body_.begin(), body_.end(), order_.begin());
    std::copy(strays_.begin(), strays_.end(),
              order_.begin() + static_cast<std::ptrdiff_t>(body_.size()));
}

template <typename Scalar>
void SweptPaths<Scalar>::pad() {
    constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
    const std::size_t paths = starts_.size();
    body_.resize(paths);
    near_.resize(paths);
    found_.resize(most_found(paths, margin_) + kFoundAtOnce);
    kernels_ = &lane_kernels(best_simd_level(), equal_radii_);
    for (std::vector<float>* lane : {&x_, &y_, &ahead_x_, &ahead_y_}) {
        lane->resize(paths + kMostLanes);
        std::fill_n(lane->begin() + static_cast<std::ptrdiff_t>(paths), kMostLanes, kNowhere);
    }
    if (!equal_radii_) radius_.resize(paths + kMostLanes, 0.0F);
}

template <typename Scalar>
std::uint32_t SweptPaths<Scalar>::path_of(std::uint32_t body) const {
    std::uint32_t path = first_[cell_[body]];
    while (body_[path] != body) ++path;
    return path;
}

template <typename Scalar>
bool SweptPaths<Scalar>::follow(std::uint32_t body, const Course& course) {
    const std::uint32_t cell = cell_[body];
    if (cell == kNoCell) return false;
    if (!stays(course, bounds_of(course), cell)) {
        remove(body);
        return false;
    }
    write_path(path_of(body), course);
    return true;
}

template <typename Scalar>
void SweptPaths<Scalar>::remove(std::uint32_t body) {
    if (cell_[body] == kNoCell) return;
    x_[path_of(body)] = std::numeric_limits<float>::quiet_NaN();
    cell_[body] = kNoCell;
}

template <typename Scalar>
std::pair<std::uint32_t, std::uint32_t> SweptPaths<Scalar>::cells_within(
    float low, float high, std::uint32_t cells) const {
    const auto last = static_cast<float>(cells);
    const float first = std::ceil(low + kNearBlurs * blur_);
    const float end = std::floor(high - kNearBlurs * blur_);
    if (!(first < end)) return {0, 0};
    return {static_cast<std::uint32_t>(std::clamp(first, 0.0F, last)),
            static_cast<std::uint32_t>(std::clamp(end, 0.0F, last))};
}

template <typename Scalar>
PathLanes SweptPaths<Scalar>::lanes() const {
    return {x_.data(),       y_.data(),
            ahead_x_.data(), ahead_y_.data(),
            radius_.data(),  body_.data(),
            first_.data(),   width_,
            height_,         static_cast<std::uint32_t>(body_.size())};
}

// Who asks may be large, or far from the grid, and its place in it then is coarse.
template <typename Scalar>
auto SweptPaths<Scalar>::close_to(float x, float y, float radius, Scalar tolerance_m) const
    -> Close {
    const float reach = radius + largest_radius_;
    const float coarse = kPlaceUnits * kFloatEpsilon * (std::max(std::abs(x), std::abs(y)) + reach);
    const float more = static_cast<float>(tolerance_m * per_m_) + kNearBlurs * blur_ + coarse;
    const float slack = slack_ + (2.0F * reach + more) * more;
    return {more, equal_radii_ ? reach * reach + slack : slack};
}

template <typename Scalar>
Scalar SweptPaths<Scalar>::farthest_m() const {
    const Scalar size_m = static_cast<Scalar>(std::max(width_, height_)) * cell_m_;
    return origin_m_.cwiseAbs().maxCoeff() + size_m;
}

template <typename Scalar>
void SweptPaths<Scalar>::begin_sights(Scalar tolerance_m, const Box<Scalar>& inside) {
    close_ = close_to(0.0F, 0.0F, largest_radius_, tolerance_m);
    const float blur = kNearBlurs * blur_;
    inside_ = {cells_x(inside.min_x_m) + blur, cells_y(inside.min_y_m) + blur,
               cells_x(inside.max_x_m) - blur, cells_y(inside.max_y_m) - blur};
}

template <typename Scalar>
bool SweptPaths<Scalar>::see(const std::array<std::uint32_t, 2>& bodies, const Motion (&motions)[2],
                             Sight& sight) {
    const std::uint32_t cell_a = cell_[bodies[0]], cell_b = cell_[bodies[1]];
    if (cell_a == kNoCell || cell_b == kNoCell) return false;
    const Course a = course_of(motions[0]), b = course_of(motions[1]);
    const Bounds of_a = bounds_of(a), of_b = bounds_of(b);
    if (!stays(a, of_a, cell_a) || !stays(b, of_b, cell_b)) return false;
    sight.courses[0] = a;
    sight.courses[1] = b;
    const Bounds both = united(of_a, of_b);
    const SightSearch search = {
        {bodies[0], bodies[1]}, {search_for(a), search_for(b)}, close_.limit};
    sight.keep_inside = inside_.min_x <= both.min_x && both.max_x <= inside_.max_x &&
                        inside_.min_y <= both.min_y && both.max_y <= inside_.max_y;
    const CellWindow cells = window_about(both, std::max(a.radius, b.radius), close_.more);
    const Seen seen = kernels_->see(lanes_, cells, search, sight.meetings.data());
    assert(body_[seen.paths[0]] == bodies[0] && body_[seen.paths[1]] == bodies[1]);
    sight.count = seen.count;
    sight.are_alone = seen.close[0] == 2 && seen.close[1] == 2;
    std::copy(seen.paths, seen.paths + 2, sight.paths);
    return true;
}

template <typename Scalar>
CellWindow SweptPaths<Scalar>::prepare(const Touching& first, const Touching& second,
                                       Scalar since_s, TouchSearch& search) const {
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    float min_x = kInfinite, min_y = kInfinite, max_x = -kInfinite, max_y = -kInfinite;
    search.half_time = half_time(since_s);
    for (const int k : {0, 1}) {
        const Touching& disc = k == 0 ? first : second;
        const bool asked = disc.radius_m > Scalar(0);
        const float x = cells_x(disc.position_m.x()), y = cells_y(disc.position_m.y());
        const auto radius = static_cast<float>(disc.radius_m * per_m_);
        const Close close = close_to(x, y, radius, disc.tolerance_m);
        search.x[k] = x;
        search.y[k] = y;
        search.radius[k] = radius;
        search.limit[k] = asked ? close.limit : -kInfinite;
        if (!asked) continue;
        const float near =
            radius + largest_radius_ + longest_way_ + close.more + kNearBlurs * blur_;
        min_x = std::min(min_x, x - near);
        min_y = std::min(min_y, y - near);
        max_x = std::max(max_x, x + near);
        max_y = std::max(max_y, y + near);
    }
    return window(min_x, min_y, max_x, max_y);
}

template class SweptPaths<double>;
template class SweptPaths<float>;

}  // namespace fts::physics
