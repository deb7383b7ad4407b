// Compiled with -mavx2 -mpopcnt.
#include <immintrin.h>

#include "common/physics/crowd_kernels_x86.h"
#include "common/physics/crowd_loops.h"

namespace fts::physics {
namespace {

// For four bits: the bytes of the marked ones of four 32-bit numbers, moved to the front.
constexpr std::uint8_t kSkip = 0x80;
struct Fronts {
    alignas(16) std::uint8_t bytes[16][16];
};
constexpr Fronts fronts() {
    Fronts all{};
    for (unsigned bits = 0; bits < 16; ++bits) {
        unsigned to = 0;
        for (unsigned k = 0; k < 4; ++k) {
            for (unsigned byte = 0; byte < 4 && (bits >> k & 1U) != 0; ++byte) {
                all.bytes[bits][to++] = static_cast<std::uint8_t>(4 * k + byte);
            }
        }
        while (to < 16) all.bytes[bits][to++] = kSkip;
    }
    return all;
}
constexpr Fronts kFronts = fronts();

std::uint32_t take_of_four(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
    const auto* const front = reinterpret_cast<const __m128i*>(kFronts.bytes[bits]);
    const __m128i all = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_shuffle_epi8(all, _mm_load_si128(front)));
    return static_cast<std::uint32_t>(__builtin_popcount(bits));
}

struct Doubles {
    using Scalar = double;
    using Greatest = __m256d;
    static constexpr std::uint32_t kLanes = 4;
    static constexpr bool kHasSse2 = true;

    static __m256d squared(const double* x, const double* y, double at_x, double at_y) {
        const __m256d dx = _mm256_sub_pd(_mm256_loadu_pd(x), _mm256_set1_pd(at_x));
        const __m256d dy = _mm256_sub_pd(_mm256_loadu_pd(y), _mm256_set1_pd(at_y));
        return _mm256_add_pd(_mm256_mul_pd(dx, dx), _mm256_mul_pd(dy, dy));
    }
    static std::uint32_t below(__m256d value, __m256d limit) {
        return static_cast<std::uint32_t>(
            _mm256_movemask_pd(_mm256_cmp_pd(value, limit, _CMP_LT_OQ)));
    }
    static std::uint32_t near(const double* x, const double* y, double at_x, double at_y,
                              double reach_squared) {
        return below(squared(x, y, at_x, at_y), _mm256_set1_pd(reach_squared));
    }
    static std::uint32_t within(const double* x, const double* y, const double* radius, double at_x,
                                double at_y, double at_radius) {
        const __m256d reach = _mm256_add_pd(_mm256_loadu_pd(radius), _mm256_set1_pd(at_radius));
        return below(squared(x, y, at_x, at_y), _mm256_mul_pd(reach, reach));
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        return take_of_four(bits, from, to);
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_set1_epi32(static_cast<int>(value)));
    }
    static std::uint32_t outside(const double* x, const double* y, const Range2<double>& range) {
        const auto inside = [](const double* at, double low, double high) {
            const __m256d values = _mm256_loadu_pd(at);
            return _mm256_and_pd(_mm256_cmp_pd(values, _mm256_set1_pd(low), _CMP_GE_OQ),
                                 _mm256_cmp_pd(values, _mm256_set1_pd(high), _CMP_LE_OQ));
        };
        const __m256d both = _mm256_and_pd(inside(x, range.low_x_m, range.high_x_m),
                                           inside(y, range.low_y_m, range.high_y_m));
        return static_cast<std::uint32_t>(_mm256_movemask_pd(both)) ^ 15U;
    }
    static void move(double* x, double* y, const double* vx, const double* vy, double span,
                     Greatest& greatest) {
        const __m256d u = _mm256_loadu_pd(vx), v = _mm256_loadu_pd(vy);
        const __m256d all_span = _mm256_set1_pd(span);
        const __m256d speed = _mm256_add_pd(_mm256_mul_pd(u, u), _mm256_mul_pd(v, v));
        _mm256_storeu_pd(x, _mm256_add_pd(_mm256_loadu_pd(x), _mm256_mul_pd(u, all_span)));
        _mm256_storeu_pd(y, _mm256_add_pd(_mm256_loadu_pd(y), _mm256_mul_pd(v, all_span)));
        greatest = _mm256_max_pd(greatest, speed);
    }
    static double greatest_of(const Greatest& greatest) {
        alignas(32) double all[4];
        _mm256_store_pd(all, greatest);
        double most = all[0];
        for (const double one : all) most = most < one ? one : most;
        return most;
    }
};

struct Floats {
    using Scalar = float;
    using Greatest = __m256;
    static constexpr std::uint32_t kLanes = 8;
    static constexpr bool kHasSse2 = true;

    static __m256 squared(const float* x, const float* y, float at_x, float at_y) {
        const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(x), _mm256_set1_ps(at_x));
        const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(y), _mm256_set1_ps(at_y));
        return _mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy));
    }
    static std::uint32_t below(__m256 value, __m256 limit) {
        return static_cast<std::uint32_t>(
            _mm256_movemask_ps(_mm256_cmp_ps(value, limit, _CMP_LT_OQ)));
    }
    static std::uint32_t near(const float* x, const float* y, float at_x, float at_y,
                              float reach_squared) {
        return below(squared(x, y, at_x, at_y), _mm256_set1_ps(reach_squared));
    }
    static std::uint32_t within(const float* x, const float* y, const float* radius, float at_x,
                                float at_y, float at_radius) {
        const __m256 reach = _mm256_add_ps(_mm256_loadu_ps(radius), _mm256_set1_ps(at_radius));
        return below(squared(x, y, at_x, at_y), _mm256_mul_ps(reach, reach));
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        const std::uint32_t taken = take_of_four(bits & 15U, from, to);
        return taken + take_of_four(bits >> 4U, from + 4, to + taken);
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_set1_epi32(static_cast<int>(value)));
    }
    static std::uint32_t outside(const float* x, const float* y, const Range2<float>& range) {
        const auto inside = [](const float* at, float low, float high) {
            const __m256 values = _mm256_loadu_ps(at);
            return _mm256_and_ps(_mm256_cmp_ps(values, _mm256_set1_ps(low), _CMP_GE_OQ),
                                 _mm256_cmp_ps(values, _mm256_set1_ps(high), _CMP_LE_OQ));
        };
        const __m256 both = _mm256_and_ps(inside(x, range.low_x_m, range.high_x_m),
                                          inside(y, range.low_y_m, range.high_y_m));
        return static_cast<std::uint32_t>(_mm256_movemask_ps(both)) ^ 255U;
    }
    static void move(float* x, float* y, const float* vx, const float* vy, float span,
                     Greatest& greatest) {
        const __m256 u = _mm256_loadu_ps(vx), v = _mm256_loadu_ps(vy);
        const __m256 all_span = _mm256_set1_ps(span);
        const __m256 speed = _mm256_add_ps(_mm256_mul_ps(u, u), _mm256_mul_ps(v, v));
        _mm256_storeu_ps(x, _mm256_add_ps(_mm256_loadu_ps(x), _mm256_mul_ps(u, all_span)));
        _mm256_storeu_ps(y, _mm256_add_ps(_mm256_loadu_ps(y), _mm256_mul_ps(v, all_span)));
        greatest = _mm256_max_ps(greatest, speed);
    }
    static float greatest_of(const Greatest& greatest) {
        alignas(32) float all[8];
        _mm256_store_ps(all, greatest);
        float most = all[0];
        for (const float one : all) most = most < one ? one : most;
        return most;
    }
};

}  // namespace

const CrowdKernels<double> kAvx2OfDoubles = kKernelsOf<Doubles>;
const CrowdKernels<float> kAvx2OfFloats = kKernelsOf<Floats>;

}  // namespace fts::physics
