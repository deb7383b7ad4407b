// Compiled with -mavx512f -mavx512vl -mavx512dq -mavx512bw -mpopcnt.
#include <immintrin.h>

#include "common/physics/flight_loops.h"

namespace fts::physics {
namespace {

// The processor's estimates are right but for less than this part. As bounds they do, and are far
// quicker than exact ones.
constexpr double kEstimateSlack = 1.0 / 8192.0;

struct Avx512Pack {
    static constexpr std::uint32_t kWidth = 8;
    using Vector = __m512d;
    using Mask = __mmask8;

    static Vector load(const double* from) { return _mm512_load_pd(from); }
    static void store(double* to, Vector a) { _mm512_store_pd(to, a); }
    static Vector all(double value) { return _mm512_set1_pd(value); }
    static Vector add(Vector a, Vector b) { return _mm512_add_pd(a, b); }
    static Vector sub(Vector a, Vector b) { return _mm512_sub_pd(a, b); }
    static Vector mul(Vector a, Vector b) { return _mm512_mul_pd(a, b); }
    static Vector min(Vector a, Vector b) { return _mm512_min_pd(a, b); }
    static Vector max(Vector a, Vector b) { return _mm512_max_pd(a, b); }
    static Vector root(Vector a) { return _mm512_sqrt_pd(a); }
    static Vector quotient(Vector a, Vector b) { return _mm512_div_pd(a, b); }
    static Vector at_least_normal(Vector a) {
        return max(a, all(std::numeric_limits<double>::min()));
    }
    static Vector root_above(Vector a) {
        const Vector inverse = _mm512_rsqrt14_pd(at_least_normal(a));
        return mul(mul(a, inverse), all(1.0 + kEstimateSlack));
    }
    static Vector quotient_below(Vector a, Vector b) {
        return mul(mul(a, _mm512_rcp14_pd(at_least_normal(b))), all(1.0 - kEstimateSlack));
    }
    static double least_of(Vector a) { return _mm512_reduce_min_pd(a); }
    static Mask below(Vector a, Vector b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
    static Mask at_most(Vector a, Vector b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
    static Mask not_above(Mask among, Vector a, Vector b) {
        return _mm512_mask_cmp_pd_mask(among, a, b, _CMP_NGT_UQ);
    }
    static Mask either(Mask one, Mask other) { return static_cast<Mask>(one | other); }
    static Mask both(Mask one, Mask other) { return static_cast<Mask>(one & other); }
    static Mask of_bits(Mask among, std::uint32_t bits) { return static_cast<Mask>(among & bits); }
    static Vector chosen(Mask mask, Vector yes, Vector no) {
        return _mm512_mask_blend_pd(mask, no, yes);
    }
    static std::uint32_t bits_of(Mask mask) { return mask; }
    static Vector not_a_number_at(Mask mask, Vector a) {
        constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
        return _mm512_mask_blend_pd(mask, a, all(kNan));
    }
    static __m256i whole(const std::uint32_t* from) {
        return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    }
    static Mask is_any(const std::uint32_t* bodies, std::uint32_t one, std::uint32_t other) {
        const auto is = [&](std::uint32_t body) -> unsigned {
            return _mm256_cmpeq_epi32_mask(whole(bodies),
                                           _mm256_set1_epi32(static_cast<int>(body)));
        };
        return static_cast<Mask>(is(one) | is(other));
    }
    static void copy(const std::uint32_t* from, std::uint32_t* to) {
        _mm256_store_si256(reinterpret_cast<__m256i*>(to), whole(from));
    }

    // Half of what is known of each of two flights.
    static Vector two_of(const double* one, const double* other) {
        return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(one)),
                                  _mm256_load_pd(other), 1);
    }
    static Lines<Avx512Pack> side_by_side(const Flight<double>* flights,
                                          const std::uint32_t* bodies) {
        const auto lines = [&](int k, int at) {
            return two_of(numbers_of<Avx512Pack>(flights[bodies[k]]) + at,
                          numbers_of<Avx512Pack>(flights[bodies[k + 4]]) + at);
        };
        const __m512i low = _mm512_set_epi64(13, 12, 5, 4, 9, 8, 1, 0);
        const __m512i high = _mm512_set_epi64(15, 14, 7, 6, 11, 10, 3, 2);
        const Vector a = lines(0, 0), b = lines(1, 0), c = lines(2, 0), d = lines(3, 0);
        const Vector x_ab = _mm512_unpacklo_pd(a, b), x_cd = _mm512_unpacklo_pd(c, d);
        const Vector y_ab = _mm512_unpackhi_pd(a, b), y_cd = _mm512_unpackhi_pd(c, d);
        const Vector e = lines(0, 4), f = lines(1, 4), g = lines(2, 4), h = lines(3, 4);
        const Vector since_ab = _mm512_unpacklo_pd(e, f), since_cd = _mm512_unpacklo_pd(g, h);
        const Vector radius_ab = _mm512_unpackhi_pd(e, f), radius_cd = _mm512_unpackhi_pd(g, h);
        return {_mm512_permutex2var_pd(x_ab, low, x_cd),
                _mm512_permutex2var_pd(y_ab, low, y_cd),
                _mm512_permutex2var_pd(x_ab, high, x_cd),
                _mm512_permutex2var_pd(y_ab, high, y_cd),
                _mm512_permutex2var_pd(since_ab, low, since_cd),
                _mm512_permutex2var_pd(radius_ab, low, radius_cd)};
    }
};

}  // namespace

const FlightKernels<double>& flight_kernels_avx512(bool equal_radii) {
    return equal_radii ? WideFlights<Avx512Pack, true>::kTable
                       : WideFlights<Avx512Pack, false>::kTable;
}

}  // namespace fts::physics
