// Compiled with -mavx512f -mavx512vl -mavx512dq -mavx512bw -mpopcnt.
#include <immintrin.h>

#include "common/physics/crowd_kernels_x86.h"
#include "common/physics/crowd_loops.h"

namespace fts::physics {
namespace {

struct Doubles {
    using Scalar = double;
    using Greatest = __m512d;
    static constexpr std::uint32_t kLanes = 8;
    static constexpr bool kHasSse2 = true;

    static __m512d squared(const double* x, const double* y, double at_x, double at_y) {
        const __m512d dx = _mm512_sub_pd(_mm512_loadu_pd(x), _mm512_set1_pd(at_x));
        const __m512d dy = _mm512_sub_pd(_mm512_loadu_pd(y), _mm512_set1_pd(at_y));
        return _mm512_add_pd(_mm512_mul_pd(dx, dx), _mm512_mul_pd(dy, dy));
    }
    static std::uint32_t below(__m512d value, __m512d limit) {
        return _mm512_cmp_pd_mask(value, limit, _CMP_LT_OQ);
    }
    static std::uint32_t near(const double* x, const double* y, double at_x, double at_y,
                              double reach_squared) {
        return below(squared(x, y, at_x, at_y), _mm512_set1_pd(reach_squared));
    }
    static std::uint32_t within(const double* x, const double* y, const double* radius, double at_x,
                                double at_y, double at_radius) {
        const __m512d reach = _mm512_add_pd(_mm512_loadu_pd(radius), _mm512_set1_pd(at_radius));
        return below(squared(x, y, at_x, at_y), _mm512_mul_pd(reach, reach));
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        _mm256_storeu_epi32(
            to, _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), _mm256_loadu_epi32(from)));
        return static_cast<std::uint32_t>(__builtin_popcount(bits));
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        _mm256_storeu_epi32(to, _mm256_set1_epi32(static_cast<int>(value)));
    }
    static std::uint32_t outside(const double* x, const double* y, const Range2<double>& range) {
        const auto inside = [](__mmask8 among, const double* at, double low, double high) {
            const __m512d values = _mm512_loadu_pd(at);
            among = _mm512_mask_cmp_pd_mask(among, values, _mm512_set1_pd(low), _CMP_GE_OQ);
            return _mm512_mask_cmp_pd_mask(among, values, _mm512_set1_pd(high), _CMP_LE_OQ);
        };
        const __mmask8 in_x =
            inside(static_cast<__mmask8>(0xffU), x, range.low_x_m, range.high_x_m);
        return inside(in_x, y, range.low_y_m, range.high_y_m) ^ 0xffU;
    }
    static void move(double* x, double* y, const double* vx, const double* vy, double span,
                     Greatest& greatest) {
        const __m512d u = _mm512_loadu_pd(vx), v = _mm512_loadu_pd(vy);
        const __m512d all_span = _mm512_set1_pd(span);
        const __m512d speed = _mm512_add_pd(_mm512_mul_pd(u, u), _mm512_mul_pd(v, v));
        _mm512_storeu_pd(x, _mm512_add_pd(_mm512_loadu_pd(x), _mm512_mul_pd(u, all_span)));
        _mm512_storeu_pd(y, _mm512_add_pd(_mm512_loadu_pd(y), _mm512_mul_pd(v, all_span)));
        greatest = _mm512_max_pd(greatest, speed);
    }
    static double greatest_of(const Greatest& greatest) { return _mm512_reduce_max_pd(greatest); }
};

struct Floats {
    using Scalar = float;
    using Greatest = __m512;
    static constexpr std::uint32_t kLanes = 16;
    static constexpr bool kHasSse2 = true;

    static __m512 squared(const float* x, const float* y, float at_x, float at_y) {
        const __m512 dx = _mm512_sub_ps(_mm512_loadu_ps(x), _mm512_set1_ps(at_x));
        const __m512 dy = _mm512_sub_ps(_mm512_loadu_ps(y), _mm512_set1_ps(at_y));
        return _mm512_add_ps(_mm512_mul_ps(dx, dx), _mm512_mul_ps(dy, dy));
    }
    static std::uint32_t below(__m512 value, __m512 limit) {
        return _mm512_cmp_ps_mask(value, limit, _CMP_LT_OQ);
    }
    static std::uint32_t near(const float* x, const float* y, float at_x, float at_y,
                              float reach_squared) {
        return below(squared(x, y, at_x, at_y), _mm512_set1_ps(reach_squared));
    }
    static std::uint32_t within(const float* x, const float* y, const float* radius, float at_x,
                                float at_y, float at_radius) {
        const __m512 reach = _mm512_add_ps(_mm512_loadu_ps(radius), _mm512_set1_ps(at_radius));
        return below(squared(x, y, at_x, at_y), _mm512_mul_ps(reach, reach));
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        _mm512_storeu_epi32(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits),
                                                            _mm512_loadu_epi32(from)));
        return static_cast<std::uint32_t>(__builtin_popcount(bits));
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        _mm512_storeu_epi32(to, _mm512_set1_epi32(static_cast<int>(value)));
    }
    static std::uint32_t outside(const float* x, const float* y, const Range2<float>& range) {
        const auto inside = [](__mmask16 among, const float* at, float low, float high) {
            const __m512 values = _mm512_loadu_ps(at);
            among = _mm512_mask_cmp_ps_mask(among, values, _mm512_set1_ps(low), _CMP_GE_OQ);
            return _mm512_mask_cmp_ps_mask(among, values, _mm512_set1_ps(high), _CMP_LE_OQ);
        };
        const __mmask16 in_x =
            inside(static_cast<__mmask16>(0xffffU), x, range.low_x_m, range.high_x_m);
        return inside(in_x, y, range.low_y_m, range.high_y_m) ^ 0xffffU;
    }
    static void move(float* x, float* y, const float* vx, const float* vy, float span,
                     Greatest& greatest) {
        const __m512 u = _mm512_loadu_ps(vx), v = _mm512_loadu_ps(vy);
        const __m512 all_span = _mm512_set1_ps(span);
        const __m512 speed = _mm512_add_ps(_mm512_mul_ps(u, u), _mm512_mul_ps(v, v));
        _mm512_storeu_ps(x, _mm512_add_ps(_mm512_loadu_ps(x), _mm512_mul_ps(u, all_span)));
        _mm512_storeu_ps(y, _mm512_add_ps(_mm512_loadu_ps(y), _mm512_mul_ps(v, all_span)));
        greatest = _mm512_max_ps(greatest, speed);
    }
    static float greatest_of(const Greatest& greatest) { return _mm512_reduce_max_ps(greatest); }
};

}  // namespace

const CrowdKernels<double> kAvx512OfDoubles = kKernelsOf<Doubles>;
const CrowdKernels<float> kAvx512OfFloats = kKernelsOf<Floats>;

}  // namespace fts::physics
