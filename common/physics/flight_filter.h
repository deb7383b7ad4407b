// Those about a body in straight flight, and when it meets them: most of the time of an
// event-driven simulation goes into this, so it is done for several at a time and without branches.
#pragma once

#include <cstdint>
#include <limits>

#include "common/physics/flight.h"
#include "common/physics/simd_level.h"

namespace fts::physics {

// So many more follow the bodies that are listed, and are to be left out.
inline constexpr std::uint32_t kGatherSpare = 8;

// Who of those about a body may meet it; a bit for each.
template <typename Scalar>
struct Ahead {
    std::uint32_t any = 0;    // all that do, and few others
    std::uint32_t first = 0;  // of these, those whose bounds are the least
    // Not later than they meet. Only of those who may.
    alignas(64) double earliest_s[Neighbours<Scalar>::kMost] = {};
};

// A time before which two do not meet is found with one root. With d the distance, R the reach, v
// the speed, b = d.v < 0 and c = d x v, it takes (d^2 - R^2) / (s - b) where s^2 = R^2 v^2 - c^2.
// What time_until_contact computes differs from it by round-off, which is below these parts: of
// d^2 + R^2 in the dividend, of R^2 v^2 in s^2, and of the quotient.
inline constexpr double kGapSlack = 16.0 * std::numeric_limits<double>::epsilon();
inline constexpr double kChordSlack = 32.0 * std::numeric_limits<double>::epsilon();
inline constexpr double kQuotientSlack = 1e-12;

// So many pairs are looked at at once.
inline constexpr std::uint32_t kMeetingsAtOnce = 32;

template <typename Scalar>
struct FlightKernels {
    // Of the bodies listed, Neighbours::kMost at most, `self` and `partner` are left out; `since_s`
    // is when the flight of `self` began.
    void (*gather)(const Flight<Scalar>* flights, const std::uint32_t* bodies, std::uint32_t count,
                   std::uint32_t self, std::uint32_t partner, double since_s,
                   Neighbours<Scalar>& found);
    // A bit for each that is nearer to a body than `factor` times their reach.
    std::uint32_t (*close)(const Neighbours<Scalar>& about, const Vec2<Scalar>& position_m,
                           Scalar radius_m, Scalar factor);
    // Who of `which` of those about `self`, shifted by `shift_m`, may meet it. Times are those of
    // time_until_contact since the later of two flights began, but not before `now_s`.
    void (*look_ahead)(const Neighbours<Scalar>& about, std::uint32_t which,
                       const Flight<Scalar>& self, const Vec2<Scalar>& shift_m, double now_s,
                       Ahead<Scalar>& ahead);
    // Who of them may do so up to a time.
    std::uint32_t (*until)(const Ahead<Scalar>& ahead, std::uint32_t count, double time_s);
    // When each of `one` meets that of `other`, kMeetingsAtOnce of them: exactly what
    // time_until_contact says since the later of two flights began, but not before `now_s`.
    // Returns a bit for each pair that may have been kept apart.
    std::uint32_t (*meet)(const Flight<Scalar>* flights, const std::uint32_t* one,
                          const std::uint32_t* other, double now_s, double* time_s);
};

// The level is a supported one. All levels give the same bits.
template <typename Scalar>
const FlightKernels<Scalar>& flight_kernels(SimdLevel level, bool equal_radii);

// Those of one level, only where the processor has it.
const FlightKernels<double>& flight_kernels_avx2(bool equal_radii);
const FlightKernels<double>& flight_kernels_avx512(bool equal_radii);

}  // namespace fts::physics
