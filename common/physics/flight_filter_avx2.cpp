// Compiled with -mavx2 -mpopcnt.
#include <immintrin.h>

#include "common/physics/flight_loops.h"

namespace fts::physics {
namespace {

struct Avx2Pack {
    static constexpr std::uint32_t kWidth = 4;
    using Vector = __m256d;
    using Mask = __m256d;

    static Vector load(const double* from) { return _mm256_load_pd(from); }
    static void store(double* to, Vector a) { _mm256_store_pd(to, a); }
    static Vector all(double value) { return _mm256_set1_pd(value); }
    static Vector add(Vector a, Vector b) { return _mm256_add_pd(a, b); }
    static Vector sub(Vector a, Vector b) { return _mm256_sub_pd(a, b); }
    static Vector mul(Vector a, Vector b) { return _mm256_mul_pd(a, b); }
    static Vector min(Vector a, Vector b) { return _mm256_min_pd(a, b); }
    static Vector max(Vector a, Vector b) { return _mm256_max_pd(a, b); }
    static Vector root(Vector a) { return _mm256_sqrt_pd(a); }
    static Vector quotient(Vector a, Vector b) { return _mm256_div_pd(a, b); }
    static Vector root_above(Vector a) { return root(a); }
    static Vector quotient_below(Vector a, Vector b) {
        return mul(_mm256_div_pd(a, b), all(1.0 - kQuotientSlack));
    }
    static double least_of(Vector a) {
        const Vector two = min(a, _mm256_permute2f128_pd(a, a, 1));
        return _mm256_cvtsd_f64(min(two, _mm256_permute_pd(two, 5)));
    }
    static Mask below(Vector a, Vector b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
    static Mask at_most(Vector a, Vector b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
    static Mask not_above(Mask among, Vector a, Vector b) {
        return _mm256_andnot_pd(_mm256_cmp_pd(a, b, _CMP_GT_OQ), among);
    }
    static Mask either(Mask one, Mask other) { return _mm256_or_pd(one, other); }
    static Mask both(Mask one, Mask other) { return _mm256_and_pd(one, other); }
    static Mask of_bits(Mask among, std::uint32_t bits) {
        const __m256i place = _mm256_setr_epi64x(1, 2, 4, 8);
        const __m256i all_bits = _mm256_set1_epi64x(static_cast<long long>(bits));
        const __m256i set = _mm256_cmpeq_epi64(_mm256_and_si256(all_bits, place), place);
        return _mm256_and_pd(among, _mm256_castsi256_pd(set));
    }
    static Vector chosen(Mask mask, Vector yes, Vector no) {
        return _mm256_blendv_pd(no, yes, mask);
    }
    static std::uint32_t bits_of(Mask mask) {
        return static_cast<std::uint32_t>(_mm256_movemask_pd(mask));
    }
    static Vector not_a_number_at(Mask mask, Vector a) { return _mm256_or_pd(mask, a); }
    static __m128i whole(const std::uint32_t* from) {
        return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
    }
    static Mask is_any(const std::uint32_t* bodies, std::uint32_t one, std::uint32_t other) {
        const auto is = [&](std::uint32_t body) {
            return _mm_cmpeq_epi32(whole(bodies), _mm_set1_epi32(static_cast<int>(body)));
        };
        return _mm256_castsi256_pd(_mm256_cvtepi32_epi64(_mm_or_si128(is(one), is(other))));
    }
    static void copy(const std::uint32_t* from, std::uint32_t* to) {
        _mm_store_si128(reinterpret_cast<__m128i*>(to), whole(from));
    }

    static Vector each(const double* a, const double* b, const double* c, const double* d) {
        const __m128d low = _mm_loadh_pd(_mm_load_sd(a), b);
        const __m128d high = _mm_loadh_pd(_mm_load_sd(c), d);
        return _mm256_insertf128_pd(_mm256_castpd128_pd256(low), high, 1);
    }
    static Lines<Avx2Pack> side_by_side(const Flight<double>* flights,
                                        const std::uint32_t* bodies) {
        const auto line = [&](int k) { return numbers_of<Avx2Pack>(flights[bodies[k]]); };
        const double *const a = line(0), *const b = line(1);
        const double *const c = line(2), *const d = line(3);
        const Vector x_ab = _mm256_unpacklo_pd(load(a), load(b));
        const Vector y_ab = _mm256_unpackhi_pd(load(a), load(b));
        const Vector x_cd = _mm256_unpacklo_pd(load(c), load(d));
        const Vector y_cd = _mm256_unpackhi_pd(load(c), load(d));
        return {_mm256_permute2f128_pd(x_ab, x_cd, 0x20), _mm256_permute2f128_pd(y_ab, y_cd, 0x20),
                _mm256_permute2f128_pd(x_ab, x_cd, 0x31), _mm256_permute2f128_pd(y_ab, y_cd, 0x31),
                each(a + 4, b + 4, c + 4, d + 4),         each(a + 5, b + 5, c + 5, d + 5)};
    }
};

}  // namespace

const FlightKernels<double>& flight_kernels_avx2(bool equal_radii) {
    return equal_radii ? WideFlights<Avx2Pack, true>::kTable : WideFlights<Avx2Pack, false>::kTable;
}

}  // namespace fts::physics
