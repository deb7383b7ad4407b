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
    using Vector = __m256d;
    static constexpr std::uint32_t kWidth = 4;

    static Vector load(const double* from) { return _mm256_loadu_pd(from); }
    static void store(double* to, Vector a) { _mm256_storeu_pd(to, a); }
    static Vector all(double value) { return _mm256_set1_pd(value); }
    static Vector add(Vector a, Vector b) { return _mm256_add_pd(a, b); }
    static Vector sub(Vector a, Vector b) { return _mm256_sub_pd(a, b); }
    static Vector mul(Vector a, Vector b) { return _mm256_mul_pd(a, b); }
    static Vector max(Vector a, Vector b) { return _mm256_max_pd(a, b); }
    static std::uint32_t below(Vector a, Vector b) {
        return static_cast<std::uint32_t>(_mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_LT_OQ)));
    }
    static std::uint32_t inside(Vector x, Vector y, const Range2<double>& range) {
        const auto within = [](Vector a, double low, double high) {
            return _mm256_and_pd(_mm256_cmp_pd(a, all(low), _CMP_GE_OQ),
                                 _mm256_cmp_pd(a, all(high), _CMP_LE_OQ));
        };
        return static_cast<std::uint32_t>(_mm256_movemask_pd(_mm256_and_pd(
            within(x, range.low_x_m, range.high_x_m), within(y, range.low_y_m, range.high_y_m))));
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        return take_of_four(bits, from, to);
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_set1_epi32(static_cast<int>(value)));
    }
    static double greatest_of(Vector a) {
        const __m128d two = _mm_max_pd(_mm256_castpd256_pd128(a), _mm256_extractf128_pd(a, 1));
        return _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)));
    }
};

struct Floats {
    using Scalar = float;
    using Vector = __m256;
    static constexpr std::uint32_t kWidth = 8;

    static Vector load(const float* from) { return _mm256_loadu_ps(from); }
    static void store(float* to, Vector a) { _mm256_storeu_ps(to, a); }
    static Vector all(float value) { return _mm256_set1_ps(value); }
    static Vector add(Vector a, Vector b) { return _mm256_add_ps(a, b); }
    static Vector sub(Vector a, Vector b) { return _mm256_sub_ps(a, b); }
    static Vector mul(Vector a, Vector b) { return _mm256_mul_ps(a, b); }
    static Vector max(Vector a, Vector b) { return _mm256_max_ps(a, b); }
    static std::uint32_t below(Vector a, Vector b) {
        return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
    }
    static std::uint32_t inside(Vector x, Vector y, const Range2<float>& range) {
        const auto within = [](Vector a, float low, float high) {
            return _mm256_and_ps(_mm256_cmp_ps(a, all(low), _CMP_GE_OQ),
                                 _mm256_cmp_ps(a, all(high), _CMP_LE_OQ));
        };
        return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_and_ps(
            within(x, range.low_x_m, range.high_x_m), within(y, range.low_y_m, range.high_y_m))));
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        const std::uint32_t taken = take_of_four(bits & 15U, from, to);
        return taken + take_of_four(bits >> 4U, from + 4, to + taken);
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_set1_epi32(static_cast<int>(value)));
    }
    static float greatest_of(Vector a) {
        alignas(32) float each[8];
        _mm256_store_ps(each, a);
        float most = each[0];
        for (const float one : each) most = most < one ? one : most;
        return most;
    }
};

}  // namespace

const CrowdKernels<double> kAvx2OfDoubles = kKernelsOf<PackLanes<Doubles>>;
const CrowdKernels<float> kAvx2OfFloats = kKernelsOf<PackLanes<Floats>>;

}  // namespace fts::physics
