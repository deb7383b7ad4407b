#include "common/physics/crowd_kernels.h"

#include <cassert>

#include "common/physics/crowd_kernels_x86.h"
#include "common/physics/crowd_loops.h"

namespace fts::physics {
namespace {

// The oracle of all others.
template <typename Value>
struct PlainLanes {
    using Scalar = Value;
    using Greatest = Value;
    static constexpr std::uint32_t kLanes = 4;
    static constexpr bool kHasSse2 = false;

    static std::uint32_t near(const Value* x, const Value* y, Value at_x, Value at_y,
                              Value reach_squared) {
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < kLanes; ++k) {
            const Value dx = x[k] - at_x, dy = y[k] - at_y;
            bits |= static_cast<std::uint32_t>(dx * dx + dy * dy < reach_squared) << k;
        }
        return bits;
    }
    static std::uint32_t within(const Value* x, const Value* y, const Value* radius, Value at_x,
                                Value at_y, Value at_radius) {
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < kLanes; ++k) {
            const Value dx = x[k] - at_x, dy = y[k] - at_y, reach = radius[k] + at_radius;
            bits |= static_cast<std::uint32_t>(dx * dx + dy * dy < reach * reach) << k;
        }
        return bits;
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        std::uint32_t taken = 0;
        for (std::uint32_t k = 0; k < kLanes; ++k) {
            to[taken] = from[k];
            taken += bits >> k & 1U;
        }
        return taken;
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        for (std::uint32_t k = 0; k < kLanes; ++k) to[k] = value;
    }
    static std::uint32_t outside(const Value* x, const Value* y, const Range2<Value>& range) {
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < kLanes; ++k) {
            const bool is_inside = (x[k] >= range.low_x_m) & (x[k] <= range.high_x_m) &
                                   (y[k] >= range.low_y_m) & (y[k] <= range.high_y_m);
            bits |= static_cast<std::uint32_t>(!is_inside) << k;
        }
        return bits;
    }
    static std::uint32_t move(const Motion<Value>& in, std::size_t i, Greatest& greatest) {
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < kLanes; ++k, ++i) {
            in.x_m[i] += in.vx_mps[i] * in.span_s;
            in.y_m[i] += in.vy_mps[i] * in.span_s;
            const Value squared = in.vx_mps[i] * in.vx_mps[i] + in.vy_mps[i] * in.vy_mps[i];
            greatest = greatest < squared ? squared : greatest;
            bits |= static_cast<std::uint32_t>(in.usual_squared < squared) << k;
        }
        return bits;
    }
    static Value greatest_of(const Greatest& greatest) { return greatest; }
};

#if defined(__SSE2__)

// Four doubles are two vectors.
struct Sse2Doubles {
    using Scalar = double;
    struct Vector {
        __m128d low, high;
    };
    static constexpr std::uint32_t kWidth = 4;

    static Vector load(const double* from) { return {_mm_loadu_pd(from), _mm_loadu_pd(from + 2)}; }
    static void store(double* to, Vector a) {
        _mm_storeu_pd(to, a.low);
        _mm_storeu_pd(to + 2, a.high);
    }
    static Vector all(double value) { return {_mm_set1_pd(value), _mm_set1_pd(value)}; }
    static Vector add(Vector a, Vector b) {
        return {_mm_add_pd(a.low, b.low), _mm_add_pd(a.high, b.high)};
    }
    static Vector sub(Vector a, Vector b) {
        return {_mm_sub_pd(a.low, b.low), _mm_sub_pd(a.high, b.high)};
    }
    static Vector mul(Vector a, Vector b) {
        return {_mm_mul_pd(a.low, b.low), _mm_mul_pd(a.high, b.high)};
    }
    static Vector max(Vector a, Vector b) {
        return {_mm_max_pd(a.low, b.low), _mm_max_pd(a.high, b.high)};
    }
    static std::uint32_t bits_of(__m128d low, __m128d high) {
        return static_cast<std::uint32_t>(_mm_movemask_pd(low) | _mm_movemask_pd(high) << 2);
    }
    static std::uint32_t below(Vector a, Vector b) {
        return bits_of(_mm_cmplt_pd(a.low, b.low), _mm_cmplt_pd(a.high, b.high));
    }
    static std::uint32_t inside(Vector x, Vector y, const Range2<double>& range) {
        const auto within = [](__m128d a, double low, double high) {
            return _mm_and_pd(_mm_cmpge_pd(a, _mm_set1_pd(low)),
                              _mm_cmple_pd(a, _mm_set1_pd(high)));
        };
        const auto two = [&](__m128d at_x, __m128d at_y) {
            return _mm_and_pd(within(at_x, range.low_x_m, range.high_x_m),
                              within(at_y, range.low_y_m, range.high_y_m));
        };
        return bits_of(two(x.low, y.low), two(x.high, y.high));
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        return PlainLanes<double>::take(bits, from, to);
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_set1_epi32(static_cast<int>(value)));
    }
    static double greatest_of(Vector a) {
        const __m128d two = _mm_max_pd(a.low, a.high);
        return _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)));
    }
};

struct Sse2Floats {
    using Scalar = float;
    using Vector = __m128;
    static constexpr std::uint32_t kWidth = 4;

    static Vector load(const float* from) { return _mm_loadu_ps(from); }
    static void store(float* to, Vector a) { _mm_storeu_ps(to, a); }
    static Vector all(float value) { return _mm_set1_ps(value); }
    static Vector add(Vector a, Vector b) { return _mm_add_ps(a, b); }
    static Vector sub(Vector a, Vector b) { return _mm_sub_ps(a, b); }
    static Vector mul(Vector a, Vector b) { return _mm_mul_ps(a, b); }
    static Vector max(Vector a, Vector b) { return _mm_max_ps(a, b); }
    static std::uint32_t below(Vector a, Vector b) {
        return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmplt_ps(a, b)));
    }
    static std::uint32_t inside(Vector x, Vector y, const Range2<float>& range) {
        const auto within = [](Vector a, float low, float high) {
            return _mm_and_ps(_mm_cmpge_ps(a, all(low)), _mm_cmple_ps(a, all(high)));
        };
        return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_and_ps(
            within(x, range.low_x_m, range.high_x_m), within(y, range.low_y_m, range.high_y_m))));
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        return PlainLanes<float>::take(bits, from, to);
    }
    static void fill(std::uint32_t value, std::uint32_t* to) {
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_set1_epi32(static_cast<int>(value)));
    }
    static float greatest_of(Vector a) {
        const __m128 two = _mm_max_ps(a, _mm_movehl_ps(a, a));
        return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
    }
};

#endif

template <typename Scalar>
struct KernelsByLevel;

template <>
struct KernelsByLevel<double> {
    static constexpr const CrowdKernels<double>* kPlain = &kKernelsOf<PlainLanes<double>>;
#if defined(__x86_64__)
    static constexpr const CrowdKernels<double>* kSse2 = &kKernelsOf<PackLanes<Sse2Doubles>>;
    static constexpr const CrowdKernels<double>* kAvx2 = &kAvx2OfDoubles;
    static constexpr const CrowdKernels<double>* kAvx512 = &kAvx512OfDoubles;
#endif
};

template <>
struct KernelsByLevel<float> {
    static constexpr const CrowdKernels<float>* kPlain = &kKernelsOf<PlainLanes<float>>;
#if defined(__x86_64__)
    static constexpr const CrowdKernels<float>* kSse2 = &kKernelsOf<PackLanes<Sse2Floats>>;
    static constexpr const CrowdKernels<float>* kAvx2 = &kAvx2OfFloats;
    static constexpr const CrowdKernels<float>* kAvx512 = &kAvx512OfFloats;
#endif
};

}  // namespace

template <typename Scalar>
const CrowdKernels<Scalar>& crowd_kernels(SimdLevel level) {
    using Kernels = KernelsByLevel<Scalar>;
    assert(is_supported(level));
#if defined(__x86_64__)
    switch (level) {
        case SimdLevel::kSse2:
            return *Kernels::kSse2;
        case SimdLevel::kAvx2:
            return *Kernels::kAvx2;
        case SimdLevel::kAvx512:
            return *Kernels::kAvx512;
        case SimdLevel::kPlain:
            break;
    }
#endif
    return *Kernels::kPlain;
}

template const CrowdKernels<double>& crowd_kernels(SimdLevel);
template const CrowdKernels<float>& crowd_kernels(SimdLevel);

}  // namespace fts::physics
