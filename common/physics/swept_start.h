// Where a path starts and where it leads, in cells. The same bits with and without vector
// instructions.
#pragma once

#include <cstdint>

#include "common/physics/scene.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace fts::physics {

struct PathStart {
    float x, y;
    float way_x, way_y;  // twice the motion of the span
    std::uint32_t body, cell;
};

// How metres become cells, and within what each of x, y, way_x and way_y must be, limits included.
template <typename Scalar>
struct StartRules {
    Vec2<Scalar> origin_m;
    Scalar per_m, per_mps;
    float low[4], high[4];
    std::uint32_t width;  // cells in a row
};

// All but `body`. False when it is beyond the limits; then there is no cell.
template <typename Scalar>
bool find_start_plainly(const StartRules<Scalar>& rules, const Vec2<Scalar>& position_m,
                        const Vec2<Scalar>& velocity_mps, PathStart& start) {
    start.x = static_cast<float>((position_m.x() - rules.origin_m.x()) * rules.per_m);
    start.y = static_cast<float>((position_m.y() - rules.origin_m.y()) * rules.per_m);
    start.way_x = static_cast<float>(velocity_mps.x() * rules.per_mps);
    start.way_y = static_cast<float>(velocity_mps.y() * rules.per_mps);
    const float all[4] = {start.x, start.y, start.way_x, start.way_y};
    for (int i = 0; i < 4; ++i) {
        if (!(rules.low[i] <= all[i] && all[i] <= rules.high[i])) return false;
    }
    start.cell = static_cast<std::uint32_t>(static_cast<std::int32_t>(start.y)) * rules.width +
                 static_cast<std::uint32_t>(static_cast<std::int32_t>(start.x));
    return true;
}

#if defined(__SSE2__)

// x, y, way_x and way_y.
inline __m128 in_cells(const StartRules<double>& rules, const Vec2<double>& position_m,
                       const Vec2<double>& velocity_mps) {
    const __m128d origin = _mm_loadu_pd(rules.origin_m.data());
    const __m128d place =
        _mm_mul_pd(_mm_sub_pd(_mm_loadu_pd(position_m.data()), origin), _mm_set1_pd(rules.per_m));
    const __m128d way = _mm_mul_pd(_mm_loadu_pd(velocity_mps.data()), _mm_set1_pd(rules.per_mps));
    return _mm_movelh_ps(_mm_cvtpd_ps(place), _mm_cvtpd_ps(way));
}

inline __m128 in_cells(const StartRules<float>& rules, const Vec2<float>& position_m,
                       const Vec2<float>& velocity_mps) {
    const auto two = [](const Vec2<float>& both) {
        return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(both.data())));
    };
    const __m128 place =
        _mm_mul_ps(_mm_sub_ps(two(position_m), two(rules.origin_m)), _mm_set1_ps(rules.per_m));
    const __m128 way = _mm_mul_ps(two(velocity_mps), _mm_set1_ps(rules.per_mps));
    return _mm_movelh_ps(place, way);
}

// The same.
template <typename Scalar>
bool find_start(const StartRules<Scalar>& rules, const Vec2<Scalar>& position_m,
                const Vec2<Scalar>& velocity_mps, PathStart& start) {
    const __m128 all = in_cells(rules, position_m, velocity_mps);
    _mm_storeu_ps(&start.x, all);
    const __m128 within = _mm_and_ps(_mm_cmpge_ps(all, _mm_loadu_ps(rules.low)),
                                     _mm_cmple_ps(all, _mm_loadu_ps(rules.high)));
    if (_mm_movemask_ps(within) != 0xf) return false;
    const __m128i cell = _mm_cvttps_epi32(all);
    start.cell =
        static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_shuffle_epi32(cell, 1))) * rules.width +
        static_cast<std::uint32_t>(_mm_cvtsi128_si32(cell));
    return true;
}

#else

template <typename Scalar>
bool find_start(const StartRules<Scalar>& rules, const Vec2<Scalar>& position_m,
                const Vec2<Scalar>& velocity_mps, PathStart& start) {
    return find_start_plainly(rules, position_m, velocity_mps, start);
}

#endif

}  // namespace fts::physics
