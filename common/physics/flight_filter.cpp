#include "common/physics/flight_filter.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "common/physics/time_of_impact.h"

#if defined(__x86_64__)
#define FTS_HAS_FOURS
#include <immintrin.h>
#endif

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

    static void look_ahead(const Neighbours<Scalar>& about, const Flight<Scalar>& self,
                           const Vec2<Scalar>& shift_m, double now_s, Ahead<Scalar>& ahead) {
        ahead.any = 0;
        for (std::uint32_t k = 0; k < about.count; ++k) {
            const Approach<Scalar> way(self, about, k, shift_m);
            const Scalar reach = reach_m(about, k, self.radius_m), aside = way.aside();
            const Scalar limit = (kFilterSlack<Scalar> * (reach * reach)) * way.speed_squared() +
                                 std::numeric_limits<Scalar>::min();
            const bool misses = aside * aside > limit;
            ahead.any |= static_cast<std::uint32_t>(way.rate() < Scalar(0) && !misses) << k;
            ahead.earliest_s[k] = now_s;
        }
        ahead.first = ahead.any;
    }

    static std::uint32_t until(const Ahead<Scalar>& ahead, std::uint32_t count, double time_s) {
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < count; ++k) {
            bits |= static_cast<std::uint32_t>(ahead.earliest_s[k] <= time_s) << k;
        }
        return bits & ahead.any;
    }

    static constexpr FlightKernels<Scalar> kTable{gather, close, look_ahead, until};
};

#if defined(FTS_HAS_FOURS)
#define FTS_AVX2 __attribute__((target("avx2,popcnt")))

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

FTS_AVX2 inline std::uint32_t bits_of(__m256d mask) {
    return static_cast<std::uint32_t>(_mm256_movemask_pd(mask));
}

struct FourFlights {
    __m256d x, y, vx, vy;
};

FTS_AVX2 inline FourFlights side_by_side(const Flight<double>& a, const Flight<double>& b,
                                         const Flight<double>& c, const Flight<double>& d) {
    static_assert(offsetof(Flight<double>, velocity_mps) == 2 * sizeof(double));
    const __m256d all_a = _mm256_load_pd(a.position_m.data());
    const __m256d all_b = _mm256_load_pd(b.position_m.data());
    const __m256d all_c = _mm256_load_pd(c.position_m.data());
    const __m256d all_d = _mm256_load_pd(d.position_m.data());
    const __m256d x_ab = _mm256_unpacklo_pd(all_a, all_b), y_ab = _mm256_unpackhi_pd(all_a, all_b);
    const __m256d x_cd = _mm256_unpacklo_pd(all_c, all_d), y_cd = _mm256_unpackhi_pd(all_c, all_d);
    return {_mm256_permute2f128_pd(x_ab, x_cd, 0x20), _mm256_permute2f128_pd(y_ab, y_cd, 0x20),
            _mm256_permute2f128_pd(x_ab, x_cd, 0x31), _mm256_permute2f128_pd(y_ab, y_cd, 0x31)};
}

struct FourWaits {
    __m256d may_meet;  // a mask
    __m256d least;
};

// Of one flight with four others.
struct Ways {
    __m256d since, radius, x, y, vx, vy, shift_x, shift_y;

    FTS_AVX2 Ways(const Flight<double>& self, const Vec2d& shift_m)
        : since(_mm256_set1_pd(self.since_s)),
          radius(_mm256_set1_pd(self.radius_m)),
          x(_mm256_set1_pd(self.position_m[0])),
          y(_mm256_set1_pd(self.position_m[1])),
          vx(_mm256_set1_pd(self.velocity_mps[0])),
          vy(_mm256_set1_pd(self.velocity_mps[1])),
          shift_x(_mm256_set1_pd(shift_m[0])),
          shift_y(_mm256_set1_pd(shift_m[1])) {}

    FTS_AVX2 FourWaits waits(const Neighbours<double>& about, std::uint32_t k, __m256d from,
                             __m256d reach) const {
        const __m256d zero = _mm256_setzero_pd();
        const __m256d time = _mm256_sub_pd(from, since);
        const __m256d dx = _mm256_sub_pd(
            _mm256_sub_pd(flown(x, vx, time), _mm256_load_pd(about.x_m + k)), shift_x);
        const __m256d dy = _mm256_sub_pd(
            _mm256_sub_pd(flown(y, vy, time), _mm256_load_pd(about.y_m + k)), shift_y);
        const __m256d wx = _mm256_sub_pd(vx, _mm256_load_pd(about.x_mps + k));
        const __m256d wy = _mm256_sub_pd(vy, _mm256_load_pd(about.y_mps + k));
        const __m256d aside = _mm256_sub_pd(_mm256_mul_pd(dx, wy), _mm256_mul_pd(dy, wx));
        const __m256d aside_squared = _mm256_mul_pd(aside, aside);
        const __m256d rate = sum_of_products(dx, wx, dy, wy);
        const __m256d reach_squared = _mm256_mul_pd(reach, reach);
        const __m256d speed_squared = sum_of_products(wx, wx, wy, wy);
        const __m256d limit = _mm256_add_pd(
            _mm256_mul_pd(_mm256_mul_pd(_mm256_set1_pd(kFilterSlack<double>), reach_squared),
                          speed_squared),
            _mm256_set1_pd(std::numeric_limits<double>::min()));
        const __m256d misses = _mm256_cmp_pd(aside_squared, limit, _CMP_GT_OQ);
        const __m256d approaches = _mm256_cmp_pd(rate, zero, _CMP_LT_OQ);
        const __m256d widest = _mm256_mul_pd(reach_squared, speed_squared);
        const __m256d chord = _mm256_sub_pd(widest, aside_squared);
        const __m256d chord_slack = _mm256_mul_pd(_mm256_set1_pd(kChordSlack), widest);
        const __m256d root = _mm256_sqrt_pd(_mm256_add_pd(_mm256_max_pd(chord, zero), chord_slack));
        const __m256d divisor = _mm256_sub_pd(root, rate);
        const __m256d distance_squared = sum_of_products(dx, dx, dy, dy);
        const __m256d gap = _mm256_sub_pd(distance_squared, reach_squared);
        const __m256d gap_slack = _mm256_mul_pd(_mm256_set1_pd(kGapSlack),
                                                _mm256_add_pd(distance_squared, reach_squared));
        const __m256d wait =
            _mm256_div_pd(_mm256_max_pd(_mm256_sub_pd(gap, gap_slack), zero), divisor);
        return {_mm256_andnot_pd(misses, approaches),
                _mm256_mul_pd(wait, _mm256_set1_pd(1.0 - kQuotientSlack))};
    }
};

// Four at a time, where the processor has AVX2. The arithmetic is that of OneByOne.
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
            _mm256_store_pd(found.x_m + k, _mm256_or_pd(nan, flown(four.x, four.vx, time)));
            _mm256_store_pd(found.y_m + k, flown(four.y, four.vy, time));
            _mm256_store_pd(found.x_mps + k, four.vx);
            _mm256_store_pd(found.y_mps + k, four.vy);
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
            bits |= bits_of(_mm256_cmp_pd(sum_of_products(x, x, y, y), limit, _CMP_LE_OQ)) << k;
        }
        return bits;
    }

    FTS_AVX2 static void look_ahead(const Neighbours<double>& about, const Flight<double>& self,
                                    const Vec2d& shift_m, double now_s, Ahead<double>& ahead) {
        const __m256d now = _mm256_set1_pd(now_s), never = _mm256_set1_pd(kNever<double>);
        const Ways ways(self, shift_m);
        __m256d least = never;
        ahead.any = 0;
        for (std::uint32_t k = 0; k < about.count; k += 4) {
            const __m256d from = _mm256_load_pd(about.from_s + k);
            const FourWaits waits = ways.waits(about, k, from, reach(about, k, ways.radius));
            ahead.any |= bits_of(waits.may_meet) << k;
            const __m256d time = _mm256_max_pd(_mm256_add_pd(from, waits.least), now);
            const __m256d earliest = _mm256_blendv_pd(never, time, waits.may_meet);
            least = _mm256_min_pd(earliest, least);
            _mm256_store_pd(ahead.earliest_s + k, earliest);
        }
        least = _mm256_min_pd(least, _mm256_permute2f128_pd(least, least, 1));
        least = _mm256_min_pd(least, _mm256_permute_pd(least, 5));
        ahead.first = until(ahead, about.count, _mm256_cvtsd_f64(least));
    }

    FTS_AVX2 static std::uint32_t until(const Ahead<double>& ahead, std::uint32_t count,
                                        double time_s) {
        const __m256d latest = _mm256_set1_pd(time_s);
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < count; k += 4) {
            const __m256d earliest = _mm256_load_pd(ahead.earliest_s + k);
            bits |= bits_of(_mm256_cmp_pd(earliest, latest, _CMP_NGT_UQ)) << k;
        }
        return bits & ahead.any;
    }

    static constexpr FlightKernels<double> kTable{gather, close, look_ahead, until};
};

#endif

}  // namespace

template <typename Scalar>
const FlightKernels<Scalar>& flight_kernels([[maybe_unused]] SimdLevel level, bool equal_radii) {
#if defined(FTS_HAS_FOURS)
    if constexpr (std::is_same_v<Scalar, double>) {
        if (level >= SimdLevel::kAvx512) return flight_kernels_avx512(equal_radii);
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
