// Those about a body in straight flight, and which of them may meet it: most of the time of an
// event-driven simulation goes into this, so it is done for several at a time and without branches.
#pragma once

#include <cstdint>

#include "common/physics/flight.h"
#include "common/physics/simd_level.h"

namespace fts::physics {

// So many more follow the bodies that are listed, and are to be left out.
inline constexpr std::uint32_t kGatherSpare = 3;

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
    // A bit for each that may meet `self` (Approach::may_meet).
    std::uint32_t (*may_meet)(const Neighbours<Scalar>& about, const Flight<Scalar>& self,
                              const Vec2<Scalar>& shift_m);
};

// The level is a supported one. All levels give the same bits.
template <typename Scalar>
const FlightKernels<Scalar>& flight_kernels(SimdLevel level, bool equal_radii);

}  // namespace fts::physics
