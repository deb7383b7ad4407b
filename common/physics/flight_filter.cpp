#include "common/physics/flight_filter.h"

#include <cstddef>
#include <limits>
#include <type_traits>

#if defined(__x86_64__)
#define FTS_HAS_FOURS
#include <immintrin.h>
#endif

namespace fts::physics {
namespace {

// One by one.
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

    static std::uint32_t may_meet(const Neighbours<Scalar>& about, const Flight<Scalar>& self,
                                  const Vec2<Scalar>& shift_m) {
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < about.count; ++k) {
            const Approach<Scalar> approach(self, about, k, shift_m);
            const Scalar reach = reach_m(about, k, self.radius_m);
            bits |= static_cast<std::uint32_t>(approach.may_meet(reach * reach)) << k;
        }
        return bits;
    }

    static constexpr FlightKernels<Scalar> kTable{gather, close, may_meet};
};

#if defined(FTS_HAS_FOURS)
#define FTS_AVX2 __attribute__((target("avx2")))

FTS_AVX2 inline __m256d four_of(const double& a, const double& b, const double& c,
                                const double& d) {
    const __m128d low = _mm_loadh_pd(_mm_load_sd(&a), &b);
    const __m128d high = _mm_loadh_pd(_mm_load_sd(&c), &d);
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(low), high, 1);
}

FTS_AVX2 inline __m256d sum_of_products(__m256d a, __m256d b, __m256d c, __m256d d) {
    return _mm256_add_pd(_mm256_mul_pd(a, b), _mm256_mul_pd(c, d));
}

FTS_AVX2 inline __m256d flown(__m256d from, __m256d speed, __m256d time) {
    return _mm256_add_pd(from, _mm256_mul_pd(speed, time));
}

struct FourFlights {
    __m256d x, y, x_speed, y_speed;
};

FTS_AVX2 inline FourFlights side_by_side(const Flight<double>& a, const Flight<double>& b,
                                         const Flight<double>& c, const Flight<double>& d) {
    static_assert(offsetof(Flight<double>, velocity_mps) == 2 * sizeof(double));
    const __m256d a_all = _mm256_load_pd(a.position_m.data());
    const __m256d b_all = _mm256_load_pd(b.position_m.data());
    const __m256d c_all = _mm256_load_pd(c.position_m.data());
    const __m256d d_all = _mm256_load_pd(d.position_m.data());
    const __m256d ab_x = _mm256_unpacklo_pd(a_all, b_all), ab_y = _mm256_unpackhi_pd(a_all, b_all);
    const __m256d cd_x = _mm256_unpacklo_pd(c_all, d_all), cd_y = _mm256_unpackhi_pd(c_all, d_all);
    return {_mm256_permute2f128_pd(ab_x, cd_x, 0x20), _mm256_permute2f128_pd(ab_y, cd_y, 0x20),
            _mm256_permute2f128_pd(ab_x, cd_x, 0x31), _mm256_permute2f128_pd(ab_y, cd_y, 0x31)};
}

// Four at a time, where the processor has AVX2. The arithmetic is that of Approach.
template <bool kEqualRadii>
struct FourByFour {
    FTS_AVX2 static void gather(const Flight<double>* flights, const std::uint32_t* bodies,
                                std::uint32_t count, std::uint32_t self, std::uint32_t partner,
                                double since_s, Neighbours<double>& found) {
        found.count = count;
        const __m256d since = _mm256_set1_pd(since_s);
        const __m128i all_self = _mm_set1_epi32(static_cast<int>(self));
        const __m128i all_partner = _mm_set1_epi32(static_cast<int>(partner));
        for (std::uint32_t k = 0; k < count; k += 4) {
            const Flight<double>&a = flights[bodies[k]], &b = flights[bodies[k + 1]];
            const Flight<double>&c = flights[bodies[k + 2]], &d = flights[bodies[k + 3]];
            const __m256d its_since = four_of(a.since_s, b.since_s, c.since_s, d.since_s);
            const __m256d from = _mm256_max_pd(since, its_since);
            const __m256d time = _mm256_sub_pd(from, its_since);
            const FourFlights four = side_by_side(a, b, c, d);
            const __m128i who = _mm_loadu_si128(reinterpret_cast<const __m128i*>(bodies + k));
            const __m128i left_out =
                _mm_or_si128(_mm_cmpeq_epi32(who, all_self), _mm_cmpeq_epi32(who, all_partner));
            const __m256d nan = _mm256_castsi256_pd(_mm256_cvtepi32_epi64(left_out));
            _mm256_store_pd(found.x_m + k, _mm256_or_pd(nan, flown(four.x, four.x_speed, time)));
            _mm256_store_pd(found.y_m + k, flown(four.y, four.y_speed, time));
            _mm256_store_pd(found.x_mps + k, four.x_speed);
            _mm256_store_pd(found.y_mps + k, four.y_speed);
            _mm256_store_pd(found.from_s + k, from);
            if constexpr (!kEqualRadii) {
                _mm256_store_pd(found.radius_m + k,
                                four_of(a.radius_m, b.radius_m, c.radius_m, d.radius_m));
            }
            _mm_store_si128(reinterpret_cast<__m128i*>(found.body + k), who);
        }
    }

    FTS_AVX2 static __m256d reach(const Neighbours<double>& about, std::uint32_t k,
                                  __m256d radius) {
        return _mm256_add_pd(radius, kEqualRadii ? radius : _mm256_load_pd(about.radius_m + k));
    }

    FTS_AVX2 static std::uint32_t close(const Neighbours<double>& about, const Vec2d& position_m,
                                        double radius_m, double factor) {
        const __m256d at_x = _mm256_set1_pd(position_m[0]), at_y = _mm256_set1_pd(position_m[1]);
        const __m256d radius = _mm256_set1_pd(radius_m);
        const __m256d factor_squared = _mm256_set1_pd(factor * factor);
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < about.count; k += 4) {
            const __m256d x = _mm256_sub_pd(at_x, _mm256_load_pd(about.x_m + k));
            const __m256d y = _mm256_sub_pd(at_y, _mm256_load_pd(about.y_m + k));
            const __m256d within = reach(about, k, radius);
            const __m256d limit = _mm256_mul_pd(factor_squared, _mm256_mul_pd(within, within));
            const __m256d is_close = _mm256_cmp_pd(sum_of_products(x, x, y, y), limit, _CMP_LE_OQ);
            bits |= static_cast<std::uint32_t>(_mm256_movemask_pd(is_close)) << k;
        }
        return bits;
    }

    FTS_AVX2 static std::uint32_t may_meet(const Neighbours<double>& about,
                                           const Flight<double>& self, const Vec2d& shift_m) {
        const __m256d since = _mm256_set1_pd(self.since_s);
        const __m256d at_x = _mm256_set1_pd(self.position_m[0]);
        const __m256d at_y = _mm256_set1_pd(self.position_m[1]);
        const __m256d x_speed = _mm256_set1_pd(self.velocity_mps[0]);
        const __m256d y_speed = _mm256_set1_pd(self.velocity_mps[1]);
        const __m256d shift_x = _mm256_set1_pd(shift_m[0]), shift_y = _mm256_set1_pd(shift_m[1]);
        const __m256d radius = _mm256_set1_pd(self.radius_m);
        const __m256d slack = _mm256_set1_pd(kFilterSlack<double>);
        const __m256d least = _mm256_set1_pd(std::numeric_limits<double>::min());
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < about.count; k += 4) {
            const __m256d time = _mm256_sub_pd(_mm256_load_pd(about.from_s + k), since);
            const __m256d x = _mm256_sub_pd(
                _mm256_sub_pd(flown(at_x, x_speed, time), _mm256_load_pd(about.x_m + k)), shift_x);
            const __m256d y = _mm256_sub_pd(
                _mm256_sub_pd(flown(at_y, y_speed, time), _mm256_load_pd(about.y_m + k)), shift_y);
            const __m256d vx = _mm256_sub_pd(x_speed, _mm256_load_pd(about.x_mps + k));
            const __m256d vy = _mm256_sub_pd(y_speed, _mm256_load_pd(about.y_mps + k));
            const __m256d within = reach(about, k, radius);
            const __m256d wide = _mm256_mul_pd(slack, _mm256_mul_pd(within, within));
            const __m256d aside = _mm256_sub_pd(_mm256_mul_pd(x, vy), _mm256_mul_pd(y, vx));
            const __m256d limit =
                _mm256_add_pd(_mm256_mul_pd(wide, sum_of_products(vx, vx, vy, vy)), least);
            const __m256d misses = _mm256_cmp_pd(_mm256_mul_pd(aside, aside), limit, _CMP_GT_OQ);
            const __m256d approaches =
                _mm256_cmp_pd(sum_of_products(x, vx, y, vy), _mm256_setzero_pd(), _CMP_LT_OQ);
            const __m256d both = _mm256_andnot_pd(misses, approaches);
            bits |= static_cast<std::uint32_t>(_mm256_movemask_pd(both)) << k;
        }
        return bits;
    }

    static constexpr FlightKernels<double> kTable{gather, close, may_meet};
};

#endif

}  // namespace

template <typename Scalar>
const FlightKernels<Scalar>& flight_kernels([[maybe_unused]] SimdLevel level, bool equal_radii) {
#if defined(FTS_HAS_FOURS)
    if constexpr (std::is_same_v<Scalar, double>) {
        if (level >= SimdLevel::kAvx2) {
            return equal_radii ? FourByFour<true>::kTable : FourByFour<false>::kTable;
        }
    }
#endif
    return equal_radii ? OneByOne<Scalar, true>::kTable : OneByOne<Scalar, false>::kTable;
}

template const FlightKernels<double>& flight_kernels(SimdLevel, bool);
template const FlightKernels<float>& flight_kernels(SimdLevel, bool);

}  // namespace fts::physics
