#include "common/physics/swept_lanes.h"

#include <cassert>

#include "common/physics/swept_kernels.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace fts::physics {

#if defined(__x86_64__)
const LaneKernels& lane_kernels_avx2(bool equal_radii);  // swept_lanes_avx2.cpp
#endif

namespace {

struct PlainPack {
    static constexpr std::uint32_t kWidth = 4;
    struct Vector {
        float lane[kWidth];
    };
    template <typename Operation>
    static Vector each(Operation operation) {
        return {operation(0), operation(1), operation(2), operation(3)};
    }
    static Vector load(const float* from) {
        return each([&](int k) { return from[k]; });
    }
    static Vector all(float value) {
        return each([&](int) { return value; });
    }
    static Vector add(const Vector& a, const Vector& b) {
        return each([&](int k) { return a.lane[k] + b.lane[k]; });
    }
    static Vector sub(const Vector& a, const Vector& b) {
        return each([&](int k) { return a.lane[k] - b.lane[k]; });
    }
    static Vector mul(const Vector& a, const Vector& b) {
        return each([&](int k) { return a.lane[k] * b.lane[k]; });
    }
    static std::uint32_t at_most(const Vector& a, const Vector& b) {
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < kWidth; ++k) {
            bits |= static_cast<std::uint32_t>(a.lane[k] <= b.lane[k]) << k;
        }
        return bits;
    }
};

#if defined(__SSE2__)
struct Sse2Pack {
    static constexpr std::uint32_t kWidth = 4;
    using Vector = __m128;
    static Vector load(const float* from) { return _mm_loadu_ps(from); }
    static Vector all(float value) { return _mm_set1_ps(value); }
    static Vector add(Vector a, Vector b) { return _mm_add_ps(a, b); }
    static Vector sub(Vector a, Vector b) { return _mm_sub_ps(a, b); }
    static Vector mul(Vector a, Vector b) { return _mm_mul_ps(a, b); }
    static std::uint32_t at_most(Vector a, Vector b) {
        return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmple_ps(a, b)));
    }
};
#endif

template <typename Pack>
const LaneKernels& kernels_of(bool equal_radii) {
    return equal_radii ? SweptKernels<Pack, true>::kTable : SweptKernels<Pack, false>::kTable;
}

}  // namespace

const LaneKernels& lane_kernels(SimdLevel level, bool equal_radii) {
    assert(is_supported(level));
#if defined(__x86_64__)
    if (level >= SimdLevel::kAvx2) return lane_kernels_avx2(equal_radii);
#endif
#if defined(__SSE2__)
    if (level >= SimdLevel::kSse2) return kernels_of<Sse2Pack>(equal_radii);
#endif
    return kernels_of<PlainPack>(equal_radii);
}

}  // namespace fts::physics
