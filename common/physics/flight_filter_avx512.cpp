// FlightKernels<double> for eight at a time. The arithmetic is that of OneByOne in
// flight_filter.cpp.
#if defined(__x86_64__)

#include <cstddef>
#include <immintrin.h>
#include <limits>

#include "common/physics/flight_filter.h"
#include "common/physics/time_of_impact.h"

// gcc 12's own headers leave values undefined on purpose (GCC bug 105593).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace fts::physics {
namespace {

#define FTS_AVX512 __attribute__((target("avx512f,avx512vl,avx512dq,avx512bw,popcnt")))

FTS_AVX512 inline __m512d sum_of_products8(__m512d a, __m512d b, __m512d c, __m512d d) {
    return _mm512_add_pd(_mm512_mul_pd(a, b), _mm512_mul_pd(c, d));
}

FTS_AVX512 inline __m512d flown8(__m512d from, __m512d speed, __m512d time) {
    return _mm512_add_pd(from, _mm512_mul_pd(speed, time));
}

struct EightFlights {
    __m512d x, y, vx, vy, since, radius;
};

// Half of what is known of two bodies.
FTS_AVX512 inline __m512d two_of(const double* one, const double* other) {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(one)), _mm256_load_pd(other),
                              1);
}

FTS_AVX512 inline EightFlights side_by_side(const Flight<double>* flights,
                                            const std::uint32_t* bodies) {
    static_assert(offsetof(Flight<double>, velocity_mps) == 2 * sizeof(double));
    static_assert(offsetof(Flight<double>, since_s) == 4 * sizeof(double));
    static_assert(offsetof(Flight<double>, radius_m) == 5 * sizeof(double));
    const auto lines = [&](std::uint32_t k, std::uint32_t at) FTS_AVX512 {
        return two_of(flights[bodies[k]].position_m.data() + at,
                      flights[bodies[k + 4]].position_m.data() + at);
    };
    const __m512i low = _mm512_set_epi64(13, 12, 5, 4, 9, 8, 1, 0);
    const __m512i high = _mm512_set_epi64(15, 14, 7, 6, 11, 10, 3, 2);
    const __m512d a = lines(0, 0), b = lines(1, 0), c = lines(2, 0), d = lines(3, 0);
    const __m512d x_ab = _mm512_unpacklo_pd(a, b), x_cd = _mm512_unpacklo_pd(c, d);
    const __m512d y_ab = _mm512_unpackhi_pd(a, b), y_cd = _mm512_unpackhi_pd(c, d);
    const __m512d e = lines(0, 4), f = lines(1, 4), g = lines(2, 4), h = lines(3, 4);
    const __m512d since_ab = _mm512_unpacklo_pd(e, f), since_cd = _mm512_unpacklo_pd(g, h);
    const __m512d radius_ab = _mm512_unpackhi_pd(e, f), radius_cd = _mm512_unpackhi_pd(g, h);
    return {_mm512_permutex2var_pd(x_ab, low, x_cd),
            _mm512_permutex2var_pd(y_ab, low, y_cd),
            _mm512_permutex2var_pd(x_ab, high, x_cd),
            _mm512_permutex2var_pd(y_ab, high, y_cd),
            _mm512_permutex2var_pd(since_ab, low, since_cd),
            _mm512_permutex2var_pd(radius_ab, low, radius_cd)};
}

struct EightWaits {
    __mmask8 may_meet;
    __m512d least;
};

// Of one flight with eight others.
struct WaysOfEight {
    __m512d since, radius, x, y, vx, vy, shift_x, shift_y;

    FTS_AVX512 WaysOfEight(const Flight<double>& self, const Vec2d& shift_m)
        : since(_mm512_set1_pd(self.since_s)),
          radius(_mm512_set1_pd(self.radius_m)),
          x(_mm512_set1_pd(self.position_m[0])),
          y(_mm512_set1_pd(self.position_m[1])),
          vx(_mm512_set1_pd(self.velocity_mps[0])),
          vy(_mm512_set1_pd(self.velocity_mps[1])),
          shift_x(_mm512_set1_pd(shift_m[0])),
          shift_y(_mm512_set1_pd(shift_m[1])) {}

    FTS_AVX512 EightWaits waits(const Neighbours<double>& about, std::uint32_t k, __m512d from,
                                __m512d reach) const {
        const __m512d zero = _mm512_setzero_pd();
        const __m512d time = _mm512_sub_pd(from, since);
        const __m512d dx = _mm512_sub_pd(
            _mm512_sub_pd(flown8(x, vx, time), _mm512_load_pd(about.x_m + k)), shift_x);
        const __m512d dy = _mm512_sub_pd(
            _mm512_sub_pd(flown8(y, vy, time), _mm512_load_pd(about.y_m + k)), shift_y);
        const __m512d wx = _mm512_sub_pd(vx, _mm512_load_pd(about.x_mps + k));
        const __m512d wy = _mm512_sub_pd(vy, _mm512_load_pd(about.y_mps + k));
        const __m512d aside = _mm512_sub_pd(_mm512_mul_pd(dx, wy), _mm512_mul_pd(dy, wx));
        const __m512d aside_squared = _mm512_mul_pd(aside, aside);
        const __m512d rate = sum_of_products8(dx, wx, dy, wy);
        const __m512d reach_squared = _mm512_mul_pd(reach, reach);
        const __m512d speed_squared = sum_of_products8(wx, wx, wy, wy);
        const __m512d limit = _mm512_add_pd(
            _mm512_mul_pd(_mm512_mul_pd(_mm512_set1_pd(kFilterSlack<double>), reach_squared),
                          speed_squared),
            _mm512_set1_pd(std::numeric_limits<double>::min()));
        const __mmask8 approaches = _mm512_cmp_pd_mask(rate, zero, _CMP_LT_OQ);
        const __mmask8 may_meet =
            _mm512_mask_cmp_pd_mask(approaches, aside_squared, limit, _CMP_NGT_UQ);
        const __m512d widest = _mm512_mul_pd(reach_squared, speed_squared);
        const __m512d chord = _mm512_sub_pd(widest, aside_squared);
        const __m512d chord_slack = _mm512_mul_pd(_mm512_set1_pd(kChordSlack), widest);
        const __m512d root = _mm512_sqrt_pd(_mm512_add_pd(_mm512_max_pd(chord, zero), chord_slack));
        const __m512d divisor = _mm512_sub_pd(root, rate);
        const __m512d distance_squared = sum_of_products8(dx, dx, dy, dy);
        const __m512d gap = _mm512_sub_pd(distance_squared, reach_squared);
        const __m512d gap_slack = _mm512_mul_pd(_mm512_set1_pd(kGapSlack),
                                                _mm512_add_pd(distance_squared, reach_squared));
        const __m512d wait =
            _mm512_div_pd(_mm512_max_pd(_mm512_sub_pd(gap, gap_slack), zero), divisor);
        return {may_meet, _mm512_mul_pd(wait, _mm512_set1_pd(1.0 - kQuotientSlack))};
    }
};

template <bool kEqualRadii>
struct EightByEight {
    FTS_AVX512 static void gather(const Flight<double>* flights, const std::uint32_t* bodies,
                                  std::uint32_t count, std::uint32_t self, std::uint32_t partner,
                                  double since_s, Neighbours<double>& found) {
        found.count = count;
        const __m512d since = _mm512_set1_pd(since_s);
        const __m512d nan = _mm512_set1_pd(std::numeric_limits<double>::quiet_NaN());
        const __m256i all_self = _mm256_set1_epi32(static_cast<int>(self));
        const __m256i all_partner = _mm256_set1_epi32(static_cast<int>(partner));
        for (std::uint32_t k = 0; k < count; k += 8) {
            const EightFlights eight = side_by_side(flights, bodies + k);
            const __m512d from = _mm512_max_pd(since, eight.since);
            const __m512d time = _mm512_sub_pd(from, eight.since);
            const __m256i who = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(bodies + k));
            const auto left_out = static_cast<__mmask8>(_mm256_cmpeq_epi32_mask(who, all_self) |
                                                        _mm256_cmpeq_epi32_mask(who, all_partner));
            const __m512d x = flown8(eight.x, eight.vx, time);
            _mm512_store_pd(found.x_m + k, _mm512_mask_blend_pd(left_out, x, nan));
            _mm512_store_pd(found.y_m + k, flown8(eight.y, eight.vy, time));
            _mm512_store_pd(found.x_mps + k, eight.vx);
            _mm512_store_pd(found.y_mps + k, eight.vy);
            _mm512_store_pd(found.from_s + k, from);
            if constexpr (!kEqualRadii) _mm512_store_pd(found.radius_m + k, eight.radius);
            _mm256_store_si256(reinterpret_cast<__m256i*>(found.body + k), who);
        }
    }

    FTS_AVX512 static __m512d reach(const Neighbours<double>& about, std::uint32_t k,
                                    __m512d radius) {
        return _mm512_add_pd(radius, kEqualRadii ? radius : _mm512_load_pd(about.radius_m + k));
    }

    FTS_AVX512 static std::uint32_t close(const Neighbours<double>& about, const Vec2d& position_m,
                                          double radius_m, double factor) {
        const __m512d at_x = _mm512_set1_pd(position_m[0]), at_y = _mm512_set1_pd(position_m[1]);
        const __m512d radius = _mm512_set1_pd(radius_m);
        const __m512d factor_squared = _mm512_set1_pd(factor * factor);
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < about.count; k += 8) {
            const __m512d x = _mm512_sub_pd(at_x, _mm512_load_pd(about.x_m + k));
            const __m512d y = _mm512_sub_pd(at_y, _mm512_load_pd(about.y_m + k));
            const __m512d within = reach(about, k, radius);
            const __m512d limit = _mm512_mul_pd(factor_squared, _mm512_mul_pd(within, within));
            const __mmask8 is_close =
                _mm512_cmp_pd_mask(sum_of_products8(x, x, y, y), limit, _CMP_LE_OQ);
            bits |= std::uint32_t{is_close} << k;
        }
        return bits;
    }

    FTS_AVX512 static void look_ahead(const Neighbours<double>& about, const Flight<double>& self,
                                      const Vec2d& shift_m, double now_s, Ahead<double>& ahead) {
        const __m512d now = _mm512_set1_pd(now_s), never = _mm512_set1_pd(kNever<double>);
        const WaysOfEight ways(self, shift_m);
        __m512d least = never;
        ahead.any = 0;
        for (std::uint32_t k = 0; k < about.count; k += 8) {
            const __m512d from = _mm512_load_pd(about.from_s + k);
            const EightWaits waits = ways.waits(about, k, from, reach(about, k, ways.radius));
            ahead.any |= std::uint32_t{waits.may_meet} << k;
            const __m512d time = _mm512_max_pd(_mm512_add_pd(from, waits.least), now);
            const __m512d earliest = _mm512_mask_blend_pd(waits.may_meet, never, time);
            least = _mm512_min_pd(earliest, least);
            _mm512_store_pd(ahead.earliest_s + k, earliest);
        }
        ahead.first = until(ahead, about.count, _mm512_reduce_min_pd(least));
    }

    FTS_AVX512 static std::uint32_t until(const Ahead<double>& ahead, std::uint32_t count,
                                          double time_s) {
        const __m512d latest = _mm512_set1_pd(time_s);
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < count; k += 8) {
            const __m512d earliest = _mm512_load_pd(ahead.earliest_s + k);
            bits |= std::uint32_t{_mm512_cmp_pd_mask(earliest, latest, _CMP_NGT_UQ)} << k;
        }
        return bits & ahead.any;
    }

    static constexpr FlightKernels<double> kTable{gather, close, look_ahead, until};
};

}  // namespace

const FlightKernels<double>& flight_kernels_avx512(bool equal_radii) {
    return equal_radii ? EightByEight<true>::kTable : EightByEight<false>::kTable;
}

}  // namespace fts::physics

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#endif
