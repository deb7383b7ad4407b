#include "common/physics/flight_filter.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "common/physics/time_of_impact.h"

namespace fts::physics {
namespace {

template <typename Scalar, bool kEqualRadii>
struct OneByOne {
    static void gather(const Flight<Scalar>* flights, const std::uint32_t* bodies,
                       std::uint32_t count, std::uint32_t self, std::uint32_t partner,
                       double since_s, Neighbours<Scalar>& found) {
        found.count = count;
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::uint32_t body = bodies[k];
            const Flight<Scalar>& flight = flights[body];
            const double from_s = std::max(since_s, flight.since_s);
            const Vec2<Scalar> position = flight.position_at(from_s);
            const bool is_left_out = body == self || body == partner;
            found.x_m[k] = is_left_out ? std::numeric_limits<Scalar>::quiet_NaN() : position.x();
            found.y_m[k] = position.y();
            found.x_mps[k] = flight.velocity_mps.x();
            found.y_mps[k] = flight.velocity_mps.y();
            found.from_s[k] = from_s;
            if (!kEqualRadii) found.radius_m[k] = flight.radius_m;
            found.body[k] = body;
        }
    }

    static Scalar reach_m(const Neighbours<Scalar>& about, std::uint32_t k, Scalar radius_m) {
        return radius_m + (kEqualRadii ? radius_m : about.radius_m[k]);
    }

    static std::uint32_t close(const Neighbours<Scalar>& about, const Vec2<Scalar>& position_m,
                               Scalar radius_m, Scalar factor) {
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < about.count; ++k) {
            const Scalar x = position_m.x() - about.x_m[k], y = position_m.y() - about.y_m[k];
            const Scalar reach = reach_m(about, k, radius_m);
            const bool is_close = x * x + y * y <= (factor * factor) * (reach * reach);
            bits |= static_cast<std::uint32_t>(is_close) << k;
        }
        return bits;
    }

    static void look_ahead(const Neighbours<Scalar>& about, std::uint32_t which,
                           const Flight<Scalar>& self, const Vec2<Scalar>& shift_m, double now_s,
                           Ahead<Scalar>& ahead) {
        ahead.any = 0;
        for (std::uint32_t k = 0; k < about.count; ++k) {
            const Approach<Scalar> way(self, about, k, shift_m);
            const bool misses = way.surely_misses(reach_m(about, k, self.radius_m));
            ahead.any |= static_cast<std::uint32_t>(way.rate() < Scalar(0) && !misses) << k;
            ahead.earliest_s[k] = now_s;
        }
        ahead.any &= which;
        ahead.first = ahead.any;
    }

    static std::uint32_t until(const Ahead<Scalar>& ahead, std::uint32_t count, double time_s) {
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < count; ++k) {
            bits |= static_cast<std::uint32_t>(ahead.earliest_s[k] <= time_s) << k;
        }
        return bits & ahead.any;
    }

    static std::uint32_t meet(const Flight<Scalar>* flights, const std::uint32_t* one,
                              const std::uint32_t* other, double now_s, double* time_s) {
        std::uint32_t may_be_apart = 0;
        for (std::uint32_t k = 0; k < kMeetingsAtOnce; ++k) {
            const Flight<Scalar>&a = flights[one[k]], &b = flights[other[k]];
            const Approach<Scalar> way(a, b);
            const Scalar reach = a.radius_m + b.radius_m;
            const Scalar wait_s =
                time_until_contact<Scalar>({way.x_m, way.y_m}, {way.x_mps, way.y_mps}, reach);
            time_s[k] = std::max(now_s, way.from_s + static_cast<double>(wait_s));
            const Scalar squares = a.velocity_mps.squaredNorm() + b.velocity_mps.squaredNorm();
            may_be_apart |= static_cast<std::uint32_t>(way.may_be_kept_apart(reach, squares)) << k;
        }
        return may_be_apart;
    }

    static constexpr FlightKernels<Scalar> kTable{gather, close, look_ahead, until, meet};
};

}  // namespace

template <typename Scalar>
const FlightKernels<Scalar>& flight_kernels([[maybe_unused]] SimdLevel level, bool equal_radii) {
#if defined(__x86_64__)
    if constexpr (std::is_same_v<Scalar, double>) {
        if (level >= SimdLevel::kAvx512) return flight_kernels_avx512(equal_radii);
        if (level >= SimdLevel::kAvx2) return flight_kernels_avx2(equal_radii);
    }
#endif
    return equal_radii ? OneByOne<Scalar, true>::kTable : OneByOne<Scalar, false>::kTable;
}

template const FlightKernels<double>& flight_kernels(SimdLevel, bool);
template const FlightKernels<float>& flight_kernels(SimdLevel, bool);

}  // namespace fts::physics
