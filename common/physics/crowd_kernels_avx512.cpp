// Compiled with -mavx512f -mavx512vl -mavx512dq -mavx512bw -mpopcnt.
#include <immintrin.h>

#include "common/physics/crowd_kernels_x86.h"
#include "common/physics/crowd_loops.h"

namespace fts::physics {
namespace {

struct Doubles {
    using Scalar = double;
    using Vector = __m512d;
    static constexpr std::uint32_t kWidth = 8;

    static Vector load(const double* from) { return _mm512_loadu_pd(from); }
    static void store(double* to, Vector a) { _mm512_storeu_pd(to, a); }
    static Vector all(double value) { return _mm512_set1_pd(value); }
    static Vector add(Vector a, Vector b) { return _mm512_add_pd(a, b); }
    static Vector sub(Vector a, Vector b) { return _mm512_sub_pd(a, b); }
    static Vector mul(Vector a, Vector b) { return _mm512_mul_pd(a, b); }
    static Vector max(Vector a, Vector b) { return _mm512_max_pd(a, b); }
    static std::uint32_t below(Vector a, Vector b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
    static std::uint32_t inside(Vector x, Vector y, const Range2<double>& range) {
        const auto within = [](__mmask8 among, Vector a, double low, double high) {
            among = _mm512_mask_cmp_pd_mask(among, a, all(low), _CMP_GE_OQ);
            return _mm512_mask_cmp_pd_mask(among, a, all(high), _CMP_LE_OQ);
        };
        constexpr __mmask8 kEvery = 0xffU;
        return within(within(kEvery, x, range.low_x_m, range.high_x_m), y, range.low_y_m,
                      range.high_y_m);
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        _mm256_storeu_epi32(
            to, _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), _mm256_loadu_epi32(from)));
        return static_cast<std::uint32_t>(__builtin_popcount(bits));
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        _mm256_storeu_epi32(to, _mm256_set1_epi32(static_cast<int>(value)));
    }
    static double greatest_of(Vector a) { return _mm512_reduce_max_pd(a); }
};

struct Floats {
    using Scalar = float;
    using Vector = __m512;
    static constexpr std::uint32_t kWidth = 16;

    static Vector load(const float* from) { return _mm512_loadu_ps(from); }
    static void store(float* to, Vector a) { _mm512_storeu_ps(to, a); }
    static Vector all(float value) { return _mm512_set1_ps(value); }
    static Vector add(Vector a, Vector b) { return _mm512_add_ps(a, b); }
    static Vector sub(Vector a, Vector b) { return _mm512_sub_ps(a, b); }
    static Vector mul(Vector a, Vector b) { return _mm512_mul_ps(a, b); }
    static Vector max(Vector a, Vector b) { return _mm512_max_ps(a, b); }
    static std::uint32_t below(Vector a, Vector b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
    static std::uint32_t inside(Vector x, Vector y, const Range2<float>& range) {
        const auto within = [](__mmask16 among, Vector a, float low, float high) {
            among = _mm512_mask_cmp_ps_mask(among, a, all(low), _CMP_GE_OQ);
            return _mm512_mask_cmp_ps_mask(among, a, all(high), _CMP_LE_OQ);
        };
        constexpr __mmask16 kEvery = 0xffffU;
        return within(within(kEvery, x, range.low_x_m, range.high_x_m), y, range.low_y_m,
                      range.high_y_m);
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        _mm512_storeu_epi32(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits),
                                                            _mm512_loadu_epi32(from)));
        return static_cast<std::uint32_t>(__builtin_popcount(bits));
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        _mm512_storeu_epi32(to, _mm512_set1_epi32(static_cast<int>(value)));
    }
    static float greatest_of(Vector a) { return _mm512_reduce_max_ps(a); }
};

}  // namespace

const CrowdKernels<double> kAvx512OfDoubles = kKernelsOf<PackLanes<Doubles>>;
const CrowdKernels<float> kAvx512OfFloats = kKernelsOf<PackLanes<Floats>>;

}  // namespace fts::physics
