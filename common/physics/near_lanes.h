// The innermost test of a broad phase: which of a few points in a row are near one point. The same
// bits with and without vector instructions.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace fts::physics {

// So many points are tested at once. Rows of them are padded with so many that are near to nothing.
inline constexpr std::uint32_t kLanes = 4;

// Bit k is set when the point (x[k], y[k]) is nearer than `reach` to (at_x, at_y).
template <typename Scalar>
std::uint32_t near_lanes(const Scalar* x, const Scalar* y, Scalar at_x, Scalar at_y,
                         Scalar reach_squared) {
    std::uint32_t near = 0;
    for (std::uint32_t k = 0; k < kLanes; ++k) {
        const Scalar dx = x[k] - at_x, dy = y[k] - at_y;
        near |= static_cast<std::uint32_t>(dx * dx + dy * dy < reach_squared) << k;
    }
    return near;
}

// The same for discs: bit k is set when the distance is below at_radius + radius[k].
template <typename Scalar>
std::uint32_t overlapping_lanes(const Scalar* x, const Scalar* y, const Scalar* radius, Scalar at_x,
                                Scalar at_y, Scalar at_radius) {
    std::uint32_t overlapping = 0;
    for (std::uint32_t k = 0; k < kLanes; ++k) {
        const Scalar dx = x[k] - at_x, dy = y[k] - at_y;
        const Scalar reach = radius[k] + at_radius;
        overlapping |= static_cast<std::uint32_t>(dx * dx + dy * dy < reach * reach) << k;
    }
    return overlapping;
}

#if defined(__SSE2__)

template <>
inline std::uint32_t near_lanes<double>(const double* x, const double* y, double at_x, double at_y,
                                        double reach_squared) {
    const __m128d all_x = _mm_set1_pd(at_x), all_y = _mm_set1_pd(at_y);
    const __m128d all_reach = _mm_set1_pd(reach_squared);
    const auto two = [&](std::uint32_t k) {
        const __m128d dx = _mm_sub_pd(_mm_loadu_pd(x + k), all_x);
        const __m128d dy = _mm_sub_pd(_mm_loadu_pd(y + k), all_y);
        const __m128d squared = _mm_add_pd(_mm_mul_pd(dx, dx), _mm_mul_pd(dy, dy));
        return static_cast<std::uint32_t>(_mm_movemask_pd(_mm_cmplt_pd(squared, all_reach)));
    };
    return two(0) | two(2) << 2;
}

template <>
inline std::uint32_t near_lanes<float>(const float* x, const float* y, float at_x, float at_y,
                                       float reach_squared) {
    const __m128 dx = _mm_sub_ps(_mm_loadu_ps(x), _mm_set1_ps(at_x));
    const __m128 dy = _mm_sub_ps(_mm_loadu_ps(y), _mm_set1_ps(at_y));
    const __m128 squared = _mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy));
    return static_cast<std::uint32_t>(
        _mm_movemask_ps(_mm_cmplt_ps(squared, _mm_set1_ps(reach_squared))));
}

template <>
inline std::uint32_t overlapping_lanes<double>(const double* x, const double* y,
                                               const double* radius, double at_x, double at_y,
                                               double at_radius) {
    const __m128d all_x = _mm_set1_pd(at_x), all_y = _mm_set1_pd(at_y);
    const __m128d all_radius = _mm_set1_pd(at_radius);
    const auto two = [&](std::uint32_t k) {
        const __m128d dx = _mm_sub_pd(_mm_loadu_pd(x + k), all_x);
        const __m128d dy = _mm_sub_pd(_mm_loadu_pd(y + k), all_y);
        const __m128d reach = _mm_add_pd(_mm_loadu_pd(radius + k), all_radius);
        const __m128d squared = _mm_add_pd(_mm_mul_pd(dx, dx), _mm_mul_pd(dy, dy));
        return static_cast<std::uint32_t>(
            _mm_movemask_pd(_mm_cmplt_pd(squared, _mm_mul_pd(reach, reach))));
    };
    return two(0) | two(2) << 2;
}

template <>
inline std::uint32_t overlapping_lanes<float>(const float* x, const float* y, const float* radius,
                                              float at_x, float at_y, float at_radius) {
    const __m128 dx = _mm_sub_ps(_mm_loadu_ps(x), _mm_set1_ps(at_x));
    const __m128 dy = _mm_sub_ps(_mm_loadu_ps(y), _mm_set1_ps(at_y));
    const __m128 reach = _mm_add_ps(_mm_loadu_ps(radius), _mm_set1_ps(at_radius));
    const __m128 squared = _mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy));
    return static_cast<std::uint32_t>(
        _mm_movemask_ps(_mm_cmplt_ps(squared, _mm_mul_ps(reach, reach))));
}

#endif

}  // namespace fts::physics
