// A body in straight flight, and those about it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "common/physics/scene.h"

namespace fts::physics {

// The number of no body.
inline constexpr std::uint32_t kNobody = 0xffffffff;

// By how many units of round-off a pair may seem to miss and still be computed exactly.
template <typename Scalar>
inline constexpr Scalar kFilterSlack = Scalar(1) +
                                       Scalar(16) * std::numeric_limits<Scalar>::epsilon();

// Of bodies kept apart, how far the gap may be open and the approach differ from none, as parts of
// reach and speed: far above round-off.
inline constexpr double kApartSlack = 1e-2;

// What must be read of a body to predict others: one cache line.
template <typename Scalar>
struct alignas(64) Flight {
    Vec2<Scalar> position_m = Vec2<Scalar>::Zero();  // at `since_s`
    Vec2<Scalar> velocity_mps = Vec2<Scalar>::Zero();
    double since_s = 0.0;
    Scalar radius_m = Scalar(0);
    Scalar mass_kg = Scalar(0);
    std::uint32_t events = 0;
    std::uint32_t index = 0;  // of the body, for others

    Vec2<Scalar> position_at(double time_s) const {
        const Scalar since = static_cast<Scalar>(time_s - since_s);
        return {position_m.x() + velocity_mps.x() * since,
                position_m.y() + velocity_mps.y() * since};
    }
};

// Flights side by side, for vector instructions.
template <typename Scalar>
struct Neighbours {
    static constexpr std::uint32_t kMost = 32;

    std::uint32_t count = 0;
    // Where each is when the later of two flights began, its own and that of the body they are
    // about; NaN for those that are left out.
    alignas(64) Scalar x_m[kMost] = {};
    alignas(64) Scalar y_m[kMost] = {};
    alignas(64) Scalar x_mps[kMost] = {};
    alignas(64) Scalar y_mps[kMost] = {};
    alignas(64) double from_s[kMost] = {};
    alignas(64) Scalar radius_m[kMost] = {};  // not there where all radii are equal
    alignas(64) std::uint32_t body[kMost] = {};
};

// Of a flight and one of those about it since the later one began, the first less the second.
template <typename Scalar>
struct Approach {
    double from_s;
    Scalar x_m, y_m;
    Scalar x_mps, y_mps;

    Approach(const Flight<Scalar>& one, const Neighbours<Scalar>& about, std::uint32_t k,
             const Vec2<Scalar>& shift_m)
        : from_s(about.from_s[k]),
          x_mps(one.velocity_mps.x() - about.x_mps[k]),
          y_mps(one.velocity_mps.y() - about.y_mps[k]) {
        const Vec2<Scalar> here = one.position_at(from_s);
        x_m = (here.x() - about.x_m[k]) - shift_m.x();
        y_m = (here.y() - about.y_m[k]) - shift_m.y();
    }
    // The same of two flights.
    Approach(const Flight<Scalar>& one, const Flight<Scalar>& other)
        : from_s(std::max(one.since_s, other.since_s)),
          x_mps(one.velocity_mps.x() - other.velocity_mps.x()),
          y_mps(one.velocity_mps.y() - other.velocity_mps.y()) {
        const Vec2<Scalar> here = one.position_at(from_s), there = other.position_at(from_s);
        x_m = here.x() - there.x();
        y_m = here.y() - there.y();
    }
    // Not to be mistaken for round-off. The filters of flight_filter.h do the same for several.
    bool surely_misses(Scalar reach_m) const {
        const Scalar limit = kFilterSlack<Scalar> * (reach_m * reach_m) * speed_squared() +
                             std::numeric_limits<Scalar>::min();
        return aside() * aside() > limit;
    }
    // Those kept apart touch when they are left together, and approach by round-off only. `squares`
    // is of both speeds.
    bool may_be_kept_apart(Scalar reach_m, Scalar squares) const {
        constexpr Scalar kNear = static_cast<Scalar>(1.0 + kApartSlack);
        constexpr Scalar kBarely = static_cast<Scalar>(kApartSlack * kApartSlack);
        return distance_squared() < kNear * reach_m * reach_m ||
               rate() * rate() < kBarely * distance_squared() * squares;
    }
    Scalar rate() const { return x_m * x_mps + y_m * y_mps; }
    Scalar aside() const { return x_m * y_mps - y_m * x_mps; }
    Scalar distance_squared() const { return x_m * x_m + y_m * y_m; }
    Scalar speed_squared() const { return x_mps * x_mps + y_mps * y_mps; }
};

}  // namespace fts::physics
