// Where a crowd flies within a window of time: straight paths in single precision, sorted by the
// cell of a uniform grid that they start in, so that whom one may meet, or touches, lies in three
// short rows of memory. What is found is a superset of that.
//
// The grid is fitted to where most bodies are and to what most of them are like, and with it the
// length of a window: in it most bodies stay within `longest_way_m` of the cell they start in. Who
// does not, or is larger than most, or elsewhere, is no path: a stray.
//
// Not thread-safe. No allocation after warm-up.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/physics/flight.h"
#include "common/physics/flights.h"
#include "common/physics/path_kernels.h"
#include "common/physics/roomy_vector.h"
#include "common/physics/solver.h"
#include "common/physics/swept_start.h"

namespace fts::physics {

template <typename Scalar>
class FlightPaths {
  public:
    using Vec = Vec2<Scalar>;
    using Flight = physics::Flight<Scalar>;
    using Box = typename Model<Scalar>::Box;

    // Suits cells and the length of a window to `flights`, at `now_s`, of which those in `living`
    // count. There must be some. `bounds`: walls, if there are any.
    void fit(const RoomyVector<Flight>& flights, std::span<const std::uint32_t> living,
             double now_s, const std::optional<Box>& bounds, bool equal_radii);
    double window_s() const { return window_s_; }

    // A window begins: sorts the flights of those in `living`.
    void begin(const RoomyVector<Flight>& flights, std::span<const std::uint32_t> living,
               double from_s);

    bool is_stray(std::uint32_t body) const { return places_[body].path == kStray; }
    // In which its path starts; any cell for one that was a stray when the window began.
    std::uint32_t cell_of(std::uint32_t body) const { return places_[body].cell; }
    // Whether its path starts where a wall may matter.
    bool is_at_border(std::uint32_t body) const { return borders_[places_[body].cell] != 0; }

    // The body's flight has changed; `now_s` is within the window. False when it is a stray, or
    // that makes it one.
    bool follow(std::uint32_t body, const Flight& flight, double now_s);
    void remove(std::uint32_t body);

    // visit(a, b) once for each two paths that may meet in the window.
    template <typename Visit>
    void for_each_pair(Visit&& visit);
    // visit(other) for each path that may meet that of the body from `now_s` on; itself among them,
    // as it is in the next.
    template <typename Visit>
    void for_each_meeting(std::uint32_t body, double now_s, Visit&& visit) const;
    // visit(other) for each path that is nearer to it than `factor` times their reach; now.
    template <typename Visit>
    void for_each_close(std::uint32_t body, double now_s, Scalar factor, Visit&& visit) const;
    // What a body would see, and would be seen as, if it flew on like this from `now_s` on: whom it
    // may meet, and who is close to it now, itself among them. It is not a sight when that makes it
    // a stray, or it is one.
    struct Sight {
        bool is_one = false;
        std::uint32_t body = 0;
        PathTest test = {};
        PathSight seen = {};
    };
    Sight see(const Turning<Scalar>& turning, double now_s, Scalar factor) const;
    template <typename Visit>
    void for_each_meeting(const Sight& sight, Visit&& visit) const {
        const AllPaths all = all_paths();
        visit_found(all, all.rows_about(places_[sight.body].cell), sight.seen.meeting, sight.test,
                    visit);
    }
    // Of two that meet: itself and the other one are close to it, and else nobody.
    bool sees_but_one(const Sight& sight) const {
        const std::uint32_t close = sight.seen.close, others = close & (close - 1);
        if ((close & kHasLongRow) != 0) return false;
        assert(others != 0);
        return (others & (others - 1)) == 0;
    }
    template <typename Visit>
    void for_each_close(const Sight& sight, Visit&& visit) const {
        const AllPaths all = all_paths();
        PathTest test = sight.test;
        test.to = test.from;
        test.limit = test.close_limit;
        visit_found(all, all.rows_about(places_[sight.body].cell), sight.seen.close, test, visit);
    }
    // It flies on like this.
    void follow(const Sight& sight) { paths_[places_[sight.body].path] = sight.test.self; }

    // visit(body) for each path, in the order of cells.
    template <typename Visit>
    void for_each(Visit&& visit) const {
        for (const WhosePath& path : whose_) visit(path.body);
    }
    // visit(other) for each path that may come within the box in the window.
    template <typename Visit>
    void for_each_within(const Box& box, Visit&& visit) const;
    // Those whose paths start where a wall may matter, and the strays, when the window began.
    std::span<const std::uint32_t> at_border() const { return at_border_; }
    std::span<const std::uint32_t> strays() const { return strays_; }

    // Read what will be asked for about a body, and return something of it: the cells about it,
    // and what is in them.
    std::uint32_t read_cells(std::uint32_t body) const {
        const std::uint32_t* const beside = first_.data() + places_[body].cell;
        return *(beside - width_) + *beside + *(beside + width_);
    }
    std::uint32_t read_paths(std::uint32_t body) const {
        std::uint32_t read = 0;
        for (const PathRow& row : all_paths().rows_about(places_[body].cell)) {
            for (const std::uint32_t path : {row.first, row.first + kPathsAtOnce / 2}) {
                read += std::bit_cast<std::uint32_t>(paths_[path].x);
            }
        }
        return read;
    }

  private:
    using Path = FlightPath;
    static constexpr std::uint32_t kStray = 0xffffffff;
    struct Place {
        std::uint32_t path, cell;
    };

    float part_of(double time_s) const {
        return static_cast<float>((time_s - from_s_) * windows_per_s_);
    }
    void fit_cells(const Vec& low_m, const Vec& high_m, std::size_t bodies);
    void fit_limits(std::size_t bodies);
    void fit_borders(const std::optional<Box>& bounds);
    float close_limit(Scalar factor) const;
    void sort_starts(std::size_t count);
    // False when that is no path that starts in the cell.
    bool find_path(const Vec& position_m, const Vec& velocity_mps, float part, std::uint32_t cell,
                   Path& path) const;
    PathTest test_from(std::uint32_t body, float from, float to, float limit) const;
    template <std::size_t kRows, typename Visit>
    void visit_found(const AllPaths& all, const std::array<PathRow, kRows>& rows,
                     std::uint32_t found, const PathTest& test, Visit&& visit) const;
    template <typename Visit>
    void search_about(std::uint32_t body, const PathTest& test, Visit&& visit) const;
    AllPaths all_paths() const {
        return {paths_.data(), equal_radii_ ? nullptr : radii_.data(),    whose_.data(),
                first_.data(), static_cast<std::uint32_t>(whose_.size()), width_};
    }
    float limit_of_meetings() const {
        const float reach = equal_radii_ ? 2.0F * largest_radius_ : 0.0F;
        return reach * reach + slack_;
    }

    // The fit.
    Vec origin_m_ = Vec::Zero();
    Scalar cell_m_ = Scalar(0), per_m_ = Scalar(0);
    Scalar largest_radius_m_ = Scalar(0);
    double window_s_ = 1.0, windows_per_s_ = 1.0;
    Scalar way_of_mps_ = Scalar(0);         // the cells that one metre a second leads in the window
    std::uint32_t columns_ = 0, rows_ = 0;  // in which paths may start
    std::uint32_t width_ = 0, height_ = 0;
    float longest_way_ = 0.0F;  // of one that is no stray, on an axis
    float largest_radius_ = 0.0F;
    float blur_ = 0.0F;   // how far off a place may be for round-off
    float slack_ = 0.0F;  // what that does to the square of a distance
    bool equal_radii_ = false;

    // The window.
    double from_s_ = 0.0;
    RoomyVector<PathStart> starts_;
    RoomyVector<std::uint32_t> first_;  // path by cell
    RoomyVector<Path> paths_;
    RoomyVector<float> radii_;
    RoomyVector<WhosePath> whose_;  // by path
    RoomyVector<Place> places_;     // by body
    std::vector<std::uint32_t> at_border_, strays_;
    RoomyVector<PathPartners> found_;
    const PathKernels* kernels_ = nullptr;
    std::vector<std::uint8_t> borders_;  // by cell
    std::vector<std::uint32_t> border_cells_;
    std::vector<Scalar> sample_;
};

template <typename Scalar>
template <std::size_t kRows, typename Visit>
void FlightPaths<Scalar>::visit_found(const AllPaths& all, const std::array<PathRow, kRows>& rows,
                                      std::uint32_t found, const PathTest& test,
                                      Visit&& visit) const {
    for (std::uint32_t bits = found & ~kHasLongRow; bits != 0; bits &= bits - 1) {
        const auto bit = static_cast<std::uint32_t>(std::countr_zero(bits));
        visit(all.whose[rows[bit / kPathsAtOnce].first + bit % kPathsAtOnce].body);
    }
    if ((found & kHasLongRow) == 0) [[likely]]
        return;
    for (PathRow row : rows) {
        while (row.end - row.first > kPathsAtOnce) {
            row.first += kPathsAtOnce;
            std::uint32_t bits = kernels_->find(all, row, test);
            for (; bits != 0; bits &= bits - 1) {
                const auto bit = static_cast<std::uint32_t>(std::countr_zero(bits));
                visit(all.whose[row.first + bit].body);
            }
        }
    }
}

template <typename Scalar>
template <typename Visit>
void FlightPaths<Scalar>::for_each_pair(Visit&& visit) {
    PathTest test = {{}, 0.0F, 2.0F, limit_of_meetings(), 0.0F, 0.0F};
    const AllPaths all = all_paths();
    const std::size_t count = kernels_->find_pairs(all, test, found_.data());
    for (std::size_t i = 0; i < count; ++i) {
        const auto [path, found] = found_[i];
        if ((found & kHasLongRow) != 0) {
            test.self = paths_[path];
            if (!equal_radii_) test.radius = radii_[path];
        }
        visit_found(all, all.rows_after(path), found, test,
                    [&, one = whose_[path].body](std::uint32_t other) { visit(one, other); });
    }
}

template <typename Scalar>
template <typename Visit>
void FlightPaths<Scalar>::search_about(std::uint32_t body, const PathTest& test,
                                       Visit&& visit) const {
    const AllPaths all = all_paths();
    const std::uint32_t cell = places_[body].cell;
    const std::uint32_t found = kernels_->find_about(all, cell, test);
    visit_found(all, all.rows_about(cell), found, test, visit);
}

template <typename Scalar>
PathTest FlightPaths<Scalar>::test_from(std::uint32_t body, float from, float to,
                                        float limit) const {
    const std::uint32_t own = places_[body].path;
    return {paths_[own], from, to, limit, equal_radii_ ? 0.0F : radii_[own], 0.0F};
}

template <typename Scalar>
template <typename Visit>
void FlightPaths<Scalar>::for_each_meeting(std::uint32_t body, double now_s, Visit&& visit) const {
    const float part = part_of(now_s);
    search_about(body, test_from(body, part, 2.0F - part, limit_of_meetings()), visit);
}

template <typename Scalar>
template <typename Visit>
void FlightPaths<Scalar>::for_each_close(std::uint32_t body, double now_s, Scalar factor,
                                         Visit&& visit) const {
    const float part = part_of(now_s);
    search_about(body, test_from(body, part, part, close_limit(factor)), visit);
}

template <typename Scalar>
template <typename Visit>
void FlightPaths<Scalar>::for_each_within(const Box& box, Visit&& visit) const {
    const float more = longest_way_ + largest_radius_ + 4.0F * blur_;
    const auto cells = [&](std::uint32_t axis, Scalar x_m, float by, std::uint32_t most) {
        const float cell = static_cast<float>((x_m - origin_m_[axis]) * per_m_) + by;
        return static_cast<std::uint32_t>(
            std::min(std::max(0.0F, cell), static_cast<float>(most - 1)));
    };
    const std::uint32_t first_x = cells(0, box.min_m.x(), -more, width_);
    const std::uint32_t last_x = cells(0, box.max_m.x(), more, width_);
    const std::uint32_t first_y = cells(1, box.min_m.y(), -more, height_);
    const std::uint32_t last_y = cells(1, box.max_m.y(), more, height_);
    for (std::uint32_t y = first_y; y <= last_y; ++y) {
        const std::uint32_t* const row = first_.data() + y * width_;
        for (std::uint32_t j = row[first_x]; j < row[last_x + 1]; ++j) {
            if (paths_[j].x == paths_[j].x) visit(whose_[j].body);
        }
    }
}

extern template class FlightPaths<double>;
extern template class FlightPaths<float>;

}  // namespace fts::physics
