// Which bodies may meet within a span: their straight paths, sorted by the cell of a uniform grid
// that they start in, and searched many at a time (swept_lanes.h). What is found is a superset of
// all pairs that touch, in an order that is of no account.
//
// The grid is fitted to where most bodies are and to what most of them are like, and kept for many
// spans. Who starts elsewhere, moves further within the span than most, or is larger, is a stray,
// whom the caller must keep elsewhere; when there are many more strays than after the last fit, the
// grid is fitted anew. No allocation after warm-up.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/physics/bodies.h"
#include "common/physics/broadphase.h"
#include "common/physics/path_limits.h"
#include "common/physics/swept_lanes.h"
#include "common/physics/swept_start.h"

namespace fts::physics {

template <typename Scalar>
class SweptPaths {
  public:
    using Vec = Vec2<Scalar>;
    struct Motion {
        Vec position_m = Vec::Zero();  // at `since_s` of the span
        Vec velocity_mps = Vec::Zero();
        Scalar radius_m = Scalar(0);
        Scalar since_s = Scalar(0);
    };
    // The same in cells.
    struct Course {
        float x, y;
        float way_x, way_y;  // twice that of the span
        float radius;
        float half_time;
    };
    struct Touching {
        Vec position_m = Vec::Zero();
        Scalar radius_m = Scalar(0);  // 0: nobody touches it
        Scalar tolerance_m = Scalar(0);
    };

    // Sorts where everybody is at the start of a span of `span_s` >= 0: by slot in `places_m`.
    void begin(const Bodies<Scalar>& bodies, std::span<const Vec> places_m, bool equal_radii,
               Scalar span_s);

    std::span<const std::uint32_t> strays() const { return strays_; }
    bool is_stray(std::uint32_t body) const { return cell_[body] == kNoCell; }
    // Those that are not strays stay so near to their span's start on each axis, or to the cell of
    // that when they have turned, and none of them is larger.
    Scalar longest_way_m() const { return static_cast<Scalar>(longest_way_) * cell_m_; }
    Scalar largest_radius_m() const { return largest_radius_m_; }
    // The largest coordinate of one that is no stray, and how far it may come in the span when it
    // has turned.
    Scalar farthest_m() const;
    Scalar longest_way_turned_m() const {
        return static_cast<Scalar>(kWayWhenTurned) * longest_way_m();
    }

    // visit(a, b) once for each pair that may touch within the span, strays aside.
    template <typename Visit>
    void for_each_pair(Visit&& visit);

    // visit(body) for each that does not certainly start within the box, strays aside.
    template <typename Visit>
    void for_each_outside(const Box<Scalar>& box, Visit&& visit) const;

    [[gnu::always_inline]] Course course_of(const Motion& motion) const;
    // The body moves like this from now on. False when that makes it a stray.
    bool follow(std::uint32_t body, const Course& course);
    void remove(std::uint32_t body);

    // visit(other) for each that may touch who moves like this and is no stray, or an image of such
    // a one; itself among them.
    template <typename Visit>
    void for_each_meeting(const Course& course, Visit&& visit);
    // The same for a stray that stays within the box.
    template <typename Visit>
    void for_each_in(const Box<Scalar>& box, Scalar since_s, Visit&& visit) const;
    // Whom two that have just hit may meet, and who is near them.
    struct Sight {
        std::vector<Meeting> meetings;  // the first `count`; none of the two with each other
        std::size_t count = 0;
        bool are_alone = false;    // nobody else may touch one of them now
        bool keep_inside = false;  // of what they were told to keep inside
        std::uint32_t paths[2] = {};
        Course courses[2] = {};
    };
    // To be called before `see`, after each `begin`: who is within `tolerance_m` of touching is
    // near, and who keeps within `inside` keeps inside.
    void begin_sights(Scalar tolerance_m, const Box<Scalar>& inside);
    // If they move like this from now on; they are where they were so far. False when one of them
    // is a stray, or would become one. Expects room for twice as many meetings as there are bodies.
    bool see(const std::array<std::uint32_t, 2>& bodies, const Motion (&motions)[2], Sight& sight);
    // They do move like this from now on.
    void follow(const Sight& sight) {
        for (const int k : {0, 1}) write_path(sight.paths[k], sight.courses[k]);
    }
    // visit(other) for each that may touch one of two discs at this time; themselves among them.
    template <typename Visit>
    void for_each_touching(const Touching& first, const Touching& second, Scalar since_s,
                           Visit&& visit);

  private:
    static constexpr std::uint32_t kNoCell = 0xffffffff;
    // By how many blurs a search goes further than it need.
    static constexpr float kNearBlurs = 4.0F;

    bool must_fit(const Bodies<Scalar>& all, bool equal_radii, Scalar span_s) const;
    void fit(const Bodies<Scalar>& bodies, std::span<const Vec> places_m, bool equal_radii,
             Scalar span_s);
    void reserve(std::size_t bodies);
    void fit_cells(const Vec& low_m, const Vec& high_m, Scalar way_m, std::size_t bodies);
    void fit_limits(bool equal_radii);
    bool is_known_order(const Bodies<Scalar>& bodies) const;
    template <bool kEqualRadii>
    void find_cells(const Bodies<Scalar>& bodies, std::span<const Vec> places_m);
    template <bool kEqualRadii>
    void sort(const Bodies<Scalar>& bodies);
    void pad();
    std::uint32_t path_of(std::uint32_t body) const;
    float cells_x(Scalar x_m) const { return static_cast<float>((x_m - origin_m_.x()) * per_m_); }
    float cells_y(Scalar y_m) const { return static_cast<float>((y_m - origin_m_.y()) * per_m_); }
    float half_time(Scalar since_s) const { return static_cast<float>(since_s * half_per_s_); }
    // Those that lie between the two whatever the round-off: [first, end), end >= first.
    std::pair<std::uint32_t, std::uint32_t> cells_within(float low, float high,
                                                         std::uint32_t cells) const;
    [[gnu::always_inline]] CellWindow window(float min_x, float min_y, float max_x,
                                             float max_y) const;
    PathLanes lanes() const;
    // Who is close enough to touch a disc: the square of the distance is at most `limit`; by `more`
    // he may be further away than the sum of radii.
    struct Close {
        float more, limit;
    };
    Close close_to(float x, float y, float radius, Scalar tolerance_m) const;
    // Where a course leads: between these.
    struct Bounds {
        float min_x, min_y, max_x, max_y;
    };
    [[gnu::always_inline]] Bounds bounds_of(const Course& course) const;
    static Bounds united(const Bounds& a, const Bounds& b) {
        return {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y), std::max(a.max_x, b.max_x),
                std::max(a.max_y, b.max_y)};
    }
    [[gnu::always_inline]] PathSearch search_for(const Course& course) const;
    [[gnu::always_inline]] CellWindow window_about(const Bounds& course, float radius,
                                                   float more) const;
    [[gnu::always_inline]] bool stays(const Course& course, const Bounds& bounds,
                                      std::uint32_t cell) const;
    [[gnu::always_inline]] void write_path(std::uint32_t path, const Course& course);
    CellWindow prepare(const Touching& first, const Touching& second, Scalar since_s,
                       TouchSearch& search) const;

    // The fit.
    Vec origin_m_ = Vec::Zero();
    Scalar cell_m_ = Scalar(0), per_m_ = Scalar(0);
    Scalar largest_radius_m_ = Scalar(0);
    Scalar fitted_span_s_ = Scalar(-1);
    std::size_t fitted_bodies_ = 0, fitted_strays_ = 0;
    std::uint32_t spans_since_fit_ = 0;
    bool equal_radii_ = false;
    std::uint32_t columns_ = 0, rows_ = 0;  // in which paths may start
    std::uint32_t margin_ = 0;              // cells round them
    std::uint32_t width_ = 0, height_ = 0;
    float longest_way_ = 0.0F;  // of one that is no stray, on an axis
    float largest_radius_ = 0.0F;
    float blur_ = 0.0F;   // how far off a place may be for round-off
    float slack_ = 0.0F;  // what that does to the square of a distance
    float limit_ = 0.0F;
    float reach_ = 0.0F;  // within which, on each axis, two start that may meet

    // The span.
    Scalar span_s_ = Scalar(0);
    Scalar half_per_s_ = Scalar(0);     // half the part of the span that a second is
    Scalar per_mps_ = Scalar(0);        // twice the cells that one metre a second leads in the span
    std::vector<std::uint32_t> order_;  // the bodies in the order of the last sort
    std::vector<PathStart> starts_;
    std::vector<std::uint32_t> cell_;   // by body; kNoCell for a stray
    std::vector<std::uint32_t> first_;  // by cell
    std::vector<float> x_, y_, ahead_x_, ahead_y_, radius_;
    std::vector<std::uint32_t> body_;  // by path
    std::vector<std::uint32_t> strays_;
    std::vector<FoundPairs> found_;
    std::vector<std::uint32_t> near_;  // who was found
    PathLanes lanes_ = {};
    Close close_ = {};  // of those that are no strays
    Bounds inside_ = {};
    const LaneKernels* kernels_ = nullptr;
    std::vector<Scalar> sample_;
};

template <typename Scalar>
inline auto SweptPaths<Scalar>::course_of(const Motion& motion) const -> Course {
    return {cells_x(motion.position_m.x()),
            cells_y(motion.position_m.y()),
            static_cast<float>(motion.velocity_mps.x() * per_mps_),
            static_cast<float>(motion.velocity_mps.y() * per_mps_),
            static_cast<float>(motion.radius_m * per_m_),
            half_time(motion.since_s)};
}

template <typename Scalar>
inline CellWindow SweptPaths<Scalar>::window(float min_x, float min_y, float max_x,
                                             float max_y) const {
    const auto last_x = static_cast<float>(width_ - 1), last_y = static_cast<float>(height_ - 1);
    const auto index = [](float place, float last) {
        return static_cast<std::uint32_t>(
            static_cast<std::int32_t>(std::min(last, std::max(0.0F, place))));
    };
    return {index(min_x, last_x), index(min_y, last_y), index(max_x, last_x), index(max_y, last_y)};
}

template <typename Scalar>
inline auto SweptPaths<Scalar>::bounds_of(const Course& course) const -> Bounds {
    const float left = 0.5F - course.half_time;
    const float x = course.x, y = course.y;
    const float to_x = x + left * course.way_x, to_y = y + left * course.way_y;
    return {std::min(x, to_x), std::min(y, to_y), std::max(x, to_x), std::max(y, to_y)};
}

template <typename Scalar>
inline PathSearch SweptPaths<Scalar>::search_for(const Course& course) const {
    const auto [x, y, way_x, way_y, radius, half] = course;
    const float left = 1.0F - 2.0F * half;
    return {x, y, x + left * way_x, y + left * way_y, radius, half, limit_};
}

template <typename Scalar>
inline CellWindow SweptPaths<Scalar>::window_about(const Bounds& course, float radius,
                                                   float more) const {
    const float near = radius + largest_radius_ + longest_way_ + more + kNearBlurs * blur_;
    return window(course.min_x - near, course.min_y - near, course.max_x + near,
                  course.max_y + near);
}

// Whether one that started in the cell is no stray with such a course, that leads there.
template <typename Scalar>
inline bool SweptPaths<Scalar>::stays(const Course& course, const Bounds& bounds,
                                      std::uint32_t cell) const {
    const float way = std::abs(course.way_x) + std::abs(course.way_y);
    const float left = 0.5F - course.half_time, from_middle = 0.5F + longest_way_;
    const std::uint32_t column = cell % width_, row = cell / width_;
    const float x = 0.5F + static_cast<float>(column), y = 0.5F + static_cast<float>(row);
    return way <= 2.0F * kWayWhenTurned * longest_way_ && left * way <= 2.0F * longest_way_ &&
           x - bounds.min_x <= from_middle && bounds.max_x - x <= from_middle &&
           y - bounds.min_y <= from_middle && bounds.max_y - y <= from_middle;
}

template <typename Scalar>
inline void SweptPaths<Scalar>::write_path(std::uint32_t path, const Course& course) {
    x_[path] = course.x - course.way_x * course.half_time;
    y_[path] = course.y - course.way_y * course.half_time;
    ahead_x_[path] = x_[path] + course.way_x;
    ahead_y_[path] = y_[path] + course.way_y;
}

template <typename Scalar>
template <typename Visit>
void SweptPaths<Scalar>::for_each_pair(Visit&& visit) {
    const PathLanes all = lanes_;
    const PairSearch search = {reach_, margin_, limit_, most_found(all.paths, margin_)};
    PairCursor cursor;
    while (cursor.path < all.paths) {
        const std::size_t count =
            kernels_->find_pairs(all, search, cursor, found_.data(), found_.size());
        for (std::size_t i = 0; i < count; ++i) {
            const auto [path, first, bits] = found_[i];
            for (std::uint32_t left = bits; left != 0; left &= left - 1) {
                visit(body_[path],
                      body_[first + static_cast<std::uint32_t>(std::countr_zero(left))]);
            }
        }
    }
}

template <typename Scalar>
template <typename Visit>
void SweptPaths<Scalar>::for_each_outside(const Box<Scalar>& box, Visit&& visit) const {
    const auto [first_x, end_x] = cells_within(cells_x(box.min_x_m), cells_x(box.max_x_m), width_);
    const auto [first_y, end_y] = cells_within(cells_y(box.min_y_m), cells_y(box.max_y_m), height_);
    const auto visit_cells = [&](std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t i = first_[first]; i < first_[end]; ++i) visit(body_[i]);
    };
    for (std::uint32_t row = 0; row < height_; ++row) {
        const std::uint32_t cells = row * width_;
        if (row < first_y || row >= end_y) {
            visit_cells(cells, cells + width_);
        } else {
            visit_cells(cells, cells + first_x);
            visit_cells(cells + end_x, cells + width_);
        }
    }
}

template <typename Scalar>
template <typename Visit>
void SweptPaths<Scalar>::for_each_meeting(const Course& course, Visit&& visit) {
    const CellWindow cells = window_about(bounds_of(course), course.radius, 0.0F);
    const std::size_t count =
        kernels_->find_meeting(lanes_, cells, search_for(course), near_.data());
    for (std::size_t i = 0; i < count; ++i) visit(near_[i]);
}

template <typename Scalar>
template <typename Visit>
void SweptPaths<Scalar>::for_each_in(const Box<Scalar>& box, Scalar since_s, Visit&& visit) const {
    const float near = largest_radius_ + 2.0F * longest_way_ + kNearBlurs * blur_;
    const float min_x = cells_x(box.min_x_m) - near, max_x = cells_x(box.max_x_m) + near;
    const float min_y = cells_y(box.min_y_m) - near, max_y = cells_y(box.max_y_m) + near;
    const CellWindow cells = window(min_x, min_y, max_x, max_y);
    const float half = half_time(since_s);
    for (std::uint32_t row = cells.first_y; row <= cells.last_y; ++row) {
        const std::uint32_t last = first_[row * width_ + cells.last_x + 1];
        for (std::uint32_t j = first_[row * width_ + cells.first_x]; j < last; ++j) {
            const float x = x_[j] + (ahead_x_[j] - x_[j]) * half;
            const float y = y_[j] + (ahead_y_[j] - y_[j]) * half;
            if (min_x <= x && x <= max_x && min_y <= y && y <= max_y) visit(body_[j]);
        }
    }
}

template <typename Scalar>
template <typename Visit>
void SweptPaths<Scalar>::for_each_touching(const Touching& first, const Touching& second,
                                           Scalar since_s, Visit&& visit) {
    TouchSearch search = {};
    const CellWindow cells = prepare(first, second, since_s, search);
    const std::size_t count = kernels_->find_touching(lanes_, cells, search, near_.data());
    for (std::size_t i = 0; i < count; ++i) visit(near_[i]);
}

extern template class SweptPaths<double>;
extern template class SweptPaths<float>;

}  // namespace fts::physics
