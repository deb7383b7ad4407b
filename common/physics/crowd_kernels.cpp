#include "common/physics/crowd_kernels.h"

#include <cassert>

#include "common/physics/crowd_kernels_x86.h"
#include "common/physics/crowd_loops.h"

namespace fts::physics {
namespace {

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
    static void move(Value* x, Value* y, const Value* vx, const Value* vy, Value span,
                     Greatest& greatest) {
        for (std::uint32_t k = 0; k < kLanes; ++k) {
            x[k] += vx[k] * span;
            y[k] += vy[k] * span;
            const Value squared = vx[k] * vx[k] + vy[k] * vy[k];
            greatest = greatest < squared ? squared : greatest;
        }
    }
    static Value greatest_of(const Greatest& greatest) { return greatest; }
};

#if defined(__SSE2__)

struct Sse2Doubles : PlainLanes<double> {
    using Greatest = __m128d;
    static constexpr bool kHasSse2 = true;

    static std::uint32_t near(const double* x, const double* y, double at_x, double at_y,
                              double reach_squared) {
        const auto two = [&](std::uint32_t k) {
            const __m128d dx = _mm_sub_pd(_mm_loadu_pd(x + k), _mm_set1_pd(at_x));
            const __m128d dy = _mm_sub_pd(_mm_loadu_pd(y + k), _mm_set1_pd(at_y));
            const __m128d squared = _mm_add_pd(_mm_mul_pd(dx, dx), _mm_mul_pd(dy, dy));
            const __m128d is_near = _mm_cmplt_pd(squared, _mm_set1_pd(reach_squared));
            return static_cast<std::uint32_t>(_mm_movemask_pd(is_near));
        };
        return two(0) | two(2) << 2U;
    }
    static std::uint32_t within(const double* x, const double* y, const double* radius, double at_x,
                                double at_y, double at_radius) {
        const auto two = [&](std::uint32_t k) {
            const __m128d dx = _mm_sub_pd(_mm_loadu_pd(x + k), _mm_set1_pd(at_x));
            const __m128d dy = _mm_sub_pd(_mm_loadu_pd(y + k), _mm_set1_pd(at_y));
            const __m128d reach = _mm_add_pd(_mm_loadu_pd(radius + k), _mm_set1_pd(at_radius));
            const __m128d squared = _mm_add_pd(_mm_mul_pd(dx, dx), _mm_mul_pd(dy, dy));
            const __m128d is_near = _mm_cmplt_pd(squared, _mm_mul_pd(reach, reach));
            return static_cast<std::uint32_t>(_mm_movemask_pd(is_near));
        };
        return two(0) | two(2) << 2U;
    }
    static std::uint32_t outside(const double* x, const double* y, const Range2<double>& range) {
        const auto inside = [](const double* at, double low, double high) {
            const __m128d values = _mm_loadu_pd(at);
            return _mm_and_pd(_mm_cmpge_pd(values, _mm_set1_pd(low)),
                              _mm_cmple_pd(values, _mm_set1_pd(high)));
        };
        const auto two = [&](std::uint32_t k) {
            const __m128d both = _mm_and_pd(inside(x + k, range.low_x_m, range.high_x_m),
                                            inside(y + k, range.low_y_m, range.high_y_m));
            return static_cast<std::uint32_t>(_mm_movemask_pd(both));
        };
        return (two(0) | two(2) << 2U) ^ 15U;
    }
    static void move(double* x, double* y, const double* vx, const double* vy, double span,
                     Greatest& greatest) {
        const __m128d all_span = _mm_set1_pd(span);
        for (std::uint32_t k = 0; k < kLanes; k += 2) {
            const __m128d u = _mm_loadu_pd(vx + k), v = _mm_loadu_pd(vy + k);
            _mm_storeu_pd(x + k, _mm_add_pd(_mm_loadu_pd(x + k), _mm_mul_pd(u, all_span)));
            _mm_storeu_pd(y + k, _mm_add_pd(_mm_loadu_pd(y + k), _mm_mul_pd(v, all_span)));
            greatest = _mm_max_pd(greatest, _mm_add_pd(_mm_mul_pd(u, u), _mm_mul_pd(v, v)));
        }
    }
    static double greatest_of(const Greatest& greatest) {
        const __m128d both = _mm_max_sd(greatest, _mm_unpackhi_pd(greatest, greatest));
        return _mm_cvtsd_f64(both);
    }
};

struct Sse2Floats : PlainLanes<float> {
    static constexpr bool kHasSse2 = true;

    static std::uint32_t near(const float* x, const float* y, float at_x, float at_y,
                              float reach_squared) {
        const __m128 dx = _mm_sub_ps(_mm_loadu_ps(x), _mm_set1_ps(at_x));
        const __m128 dy = _mm_sub_ps(_mm_loadu_ps(y), _mm_set1_ps(at_y));
        const __m128 squared = _mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy));
        const __m128 is_near = _mm_cmplt_ps(squared, _mm_set1_ps(reach_squared));
        return static_cast<std::uint32_t>(_mm_movemask_ps(is_near));
    }
    static std::uint32_t within(const float* x, const float* y, const float* radius, float at_x,
                                float at_y, float at_radius) {
        const __m128 dx = _mm_sub_ps(_mm_loadu_ps(x), _mm_set1_ps(at_x));
        const __m128 dy = _mm_sub_ps(_mm_loadu_ps(y), _mm_set1_ps(at_y));
        const __m128 reach = _mm_add_ps(_mm_loadu_ps(radius), _mm_set1_ps(at_radius));
        const __m128 squared = _mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy));
        const __m128 is_near = _mm_cmplt_ps(squared, _mm_mul_ps(reach, reach));
        return static_cast<std::uint32_t>(_mm_movemask_ps(is_near));
    }
};

#endif

template <typename Scalar>
struct KernelsByLevel;

template <>
struct KernelsByLevel<double> {
    static constexpr const CrowdKernels<double>* kPlain = &kKernelsOf<PlainLanes<double>>;
#if defined(__x86_64__)
    static constexpr const CrowdKernels<double>* kSse2 = &kKernelsOf<Sse2Doubles>;
    static constexpr const CrowdKernels<double>* kAvx2 = &kAvx2OfDoubles;
    static constexpr const CrowdKernels<double>* kAvx512 = &kAvx512OfDoubles;
#endif
};

template <>
struct KernelsByLevel<float> {
    static constexpr const CrowdKernels<float>* kPlain = &kKernelsOf<PlainLanes<float>>;
#if defined(__x86_64__)
    static constexpr const CrowdKernels<float>* kSse2 = &kKernelsOf<Sse2Floats>;
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
