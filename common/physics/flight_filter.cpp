#include "common/physics/flight_filter.h"

#include <bit>
#include <limits>
#include <type_traits>

#include "common/physics/simd_level.h"

#if defined(__x86_64__)
#define FTS_HAS_FOURS
#include <immintrin.h>
#endif

namespace fts::physics {
namespace {

#if defined(FTS_HAS_FOURS)
#define FTS_AVX2 __attribute__((target("avx2")))

// Filter<double> for four at a time, where the processor has AVX2. The arithmetic is that of
// Approach.
struct Fours {
    const Flight<double>* flights;
    __m256d since, x, y, x_speed, y_speed, shift_x, shift_y, radius, close_squared, slack;
    __m256d reach_squared, widened_squared;  // of equal radii

    FTS_AVX2 explicit Fours(const Filter<double>& filter)
        : flights(filter.flights),
          since(_mm256_set1_pd(filter.self.since_s)),
          x(_mm256_set1_pd(filter.self.position_m[0])),
          y(_mm256_set1_pd(filter.self.position_m[1])),
          x_speed(_mm256_set1_pd(filter.self.velocity_mps[0])),
          y_speed(_mm256_set1_pd(filter.self.velocity_mps[1])),
          shift_x(_mm256_set1_pd(filter.shift_m[0])),
          shift_y(_mm256_set1_pd(filter.shift_m[1])),
          radius(_mm256_set1_pd(filter.self.radius_m)),
          close_squared(_mm256_set1_pd(filter.close * filter.close)),
          slack(_mm256_set1_pd(kFilterSlack<double>)),
          reach_squared(
              _mm256_mul_pd(_mm256_add_pd(radius, radius), _mm256_add_pd(radius, radius))),
          widened_squared(_mm256_mul_pd(slack, reach_squared)) {}

    struct Bits {
        unsigned may_meet, close;
    };
    template <bool kEqualRadii>
    FTS_AVX2 Bits test(const std::uint32_t* others) const;
};

FTS_AVX2 inline __m256d four_of(const double& a, const double& b, const double& c,
                                const double& d) {
    const __m128d low = _mm_loadh_pd(_mm_load_sd(&a), &b);
    const __m128d high = _mm_loadh_pd(_mm_load_sd(&c), &d);
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(low), high, 1);
}

FTS_AVX2 inline __m256d sum_of_products(__m256d a, __m256d b, __m256d c, __m256d d) {
    return _mm256_add_pd(_mm256_mul_pd(a, b), _mm256_mul_pd(c, d));
}

FTS_AVX2 inline __m256d flown(__m256d from, __m256d speed, __m256d time) {
    return _mm256_add_pd(from, _mm256_mul_pd(speed, time));
}

template <bool kEqualRadii>
FTS_AVX2 Fours::Bits Fours::test(const std::uint32_t* others) const {
    const Flight<double>&a = flights[others[0]], &b = flights[others[1]];
    const Flight<double>&c = flights[others[2]], &d = flights[others[3]];
    const __m256d its_since = four_of(a.since_s, b.since_s, c.since_s, d.since_s);
    const __m256d from = _mm256_max_pd(since, its_since);
    const __m256d time = _mm256_sub_pd(from, since), its_time = _mm256_sub_pd(from, its_since);
    const __m256d its_vx =
        four_of(a.velocity_mps[0], b.velocity_mps[0], c.velocity_mps[0], d.velocity_mps[0]);
    const __m256d its_vy =
        four_of(a.velocity_mps[1], b.velocity_mps[1], c.velocity_mps[1], d.velocity_mps[1]);
    const __m256d its_x =
        flown(four_of(a.position_m[0], b.position_m[0], c.position_m[0], d.position_m[0]), its_vx,
              its_time);
    const __m256d its_y =
        flown(four_of(a.position_m[1], b.position_m[1], c.position_m[1], d.position_m[1]), its_vy,
              its_time);
    const __m256d dx = _mm256_sub_pd(_mm256_sub_pd(flown(x, x_speed, time), its_x), shift_x);
    const __m256d dy = _mm256_sub_pd(_mm256_sub_pd(flown(y, y_speed, time), its_y), shift_y);
    const __m256d vx = _mm256_sub_pd(x_speed, its_vx), vy = _mm256_sub_pd(y_speed, its_vy);
    __m256d within = reach_squared, wide = widened_squared;
    if constexpr (!kEqualRadii) {
        const __m256d reach =
            _mm256_add_pd(radius, four_of(a.radius_m, b.radius_m, c.radius_m, d.radius_m));
        within = _mm256_mul_pd(reach, reach);
        wide = _mm256_mul_pd(slack, within);
    }
    const __m256d aside = _mm256_sub_pd(_mm256_mul_pd(dx, vy), _mm256_mul_pd(dy, vx));
    const __m256d limit = _mm256_add_pd(_mm256_mul_pd(wide, sum_of_products(vx, vx, vy, vy)),
                                        _mm256_set1_pd(std::numeric_limits<double>::min()));
    const __m256d misses = _mm256_cmp_pd(_mm256_mul_pd(aside, aside), limit, _CMP_GT_OQ);
    const __m256d approaches =
        _mm256_cmp_pd(sum_of_products(dx, vx, dy, vy), _mm256_setzero_pd(), _CMP_LT_OQ);
    const __m256d close = _mm256_cmp_pd(sum_of_products(dx, dx, dy, dy),
                                        _mm256_mul_pd(close_squared, within), _CMP_LE_OQ);
    return {static_cast<unsigned>(_mm256_movemask_pd(_mm256_andnot_pd(misses, approaches))),
            static_cast<unsigned>(_mm256_movemask_pd(close))};
}

template <bool kEqualRadii>
FTS_AVX2 Filter<double>::Passed four_by_four(const Filter<double>& filter, std::uint32_t* first,
                                             std::uint32_t* end) {
    for (std::uint32_t k = 0; k < kFilterSpare; ++k) end[k] = filter.body;
    const Fours fours(filter);
    const __m128i body = _mm_set1_epi32(static_cast<int>(filter.body));
    const __m128i partner = _mm_set1_epi32(static_cast<int>(filter.partner));
    std::uint32_t* kept = first;
    unsigned close = 0;
    for (const std::uint32_t* at = first; at < end; at += 4) {
        const auto [may_meet, are_close] = fours.test<kEqualRadii>(at);
        const __m128i all = _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
        const __m128i left_out =
            _mm_or_si128(_mm_cmpeq_epi32(all, body), _mm_cmpeq_epi32(all, partner));
        const auto skipped = static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(left_out)));
        close |= are_close & ~skipped;
        for (unsigned left = may_meet & ~skipped; left != 0; left &= left - 1) {
            *kept++ = at[std::countr_zero(left)];
        }
    }
    return {kept, close != 0};
}

bool has_fours() {
    static const bool has = is_supported(SimdLevel::kAvx2);
    return has;
}

#endif

}  // namespace

template <typename Scalar>
auto Filter<Scalar>::one_by_one(std::uint32_t* first, const std::uint32_t* end) const -> Passed {
    bool any_close = false;
    std::uint32_t* kept = first;
    for (const std::uint32_t* at = first; at != end; ++at) {
        const std::uint32_t other = *at;
        if (other == body || other == partner) continue;
        const Approach<Scalar> approach(self, flights[other], shift_m);
        const Scalar reach = self.radius_m + flights[other].radius_m;
        any_close |= approach.distance_squared() <= (close * close) * (reach * reach);
        if (approach.may_meet(reach * reach)) *kept++ = other;
    }
    return {kept, any_close};
}

template <typename Scalar>
auto Filter<Scalar>::operator()(std::uint32_t* first, std::uint32_t* end) const -> Passed {
#if defined(FTS_HAS_FOURS)
    if constexpr (std::is_same_v<Scalar, double>) {
        if (has_fours()) {
            return equal_radii ? four_by_four<true>(*this, first, end)
                               : four_by_four<false>(*this, first, end);
        }
    }
#endif
    return one_by_one(first, end);
}

template struct Filter<double>;
template struct Filter<float>;

}  // namespace fts::physics
