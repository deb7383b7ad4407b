// The loops of crowd_kernels.h over a type `Lanes` that has the vector instructions of one level.
// For the sources that are compiled for such a level: nothing here may be shared with others, so
// `Lanes` must be local to its source, every template has it, and nothing else is called.
//
//     Lanes::Scalar, Lanes::kLanes, Lanes::kHasSse2
//     Lanes::near(x, y, at_x, at_y, reach_squared)   bit k: (x[k], y[k]) is nearer to (at_x, at_y)
//     Lanes::within(x, y, radius, at_x, at_y, at_radius)   the same, reach: radius[k] + at_radius
//     Lanes::take(bits, from, to)   copies from[k] for every bit k; gives how many
//     Lanes::fill(value, to)        kLanes of them
//     Lanes::outside(x, y, range)   bit k: (x[k], y[k]) is not inside
//     Lanes::move(motion, i, greatest)   kLanes discs from i; keeps the greatest squares of speeds;
//                                   bit k: that of disc i + k is above the usual
//
// PackLanes is that of a `Pack`, local to its source likewise, which has
//
//     Scalar, Vector of kWidth of them, load, store, all, add, sub, mul, max; take and fill as
//     above below(a, b)           bit k: a[k] < b[k] inside(x, y, range)   bit k: (x[k], y[k]) is
//     inside greatest_of(a)        of its numbers
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/physics/crowd_kernels.h"

#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace fts::physics {

template <typename Pack>
struct PackLanes {
    using Scalar = typename Pack::Scalar;
    using Vector = typename Pack::Vector;
    using Greatest = Vector;
    static constexpr std::uint32_t kLanes = Pack::kWidth;
    static constexpr bool kHasSse2 = true;

    static Vector squared(const Scalar* x, const Scalar* y, Scalar at_x, Scalar at_y) {
        const Vector dx = Pack::sub(Pack::load(x), Pack::all(at_x));
        const Vector dy = Pack::sub(Pack::load(y), Pack::all(at_y));
        return Pack::add(Pack::mul(dx, dx), Pack::mul(dy, dy));
    }
    static std::uint32_t near(const Scalar* x, const Scalar* y, Scalar at_x, Scalar at_y,
                              Scalar reach_squared) {
        return Pack::below(squared(x, y, at_x, at_y), Pack::all(reach_squared));
    }
    static std::uint32_t within(const Scalar* x, const Scalar* y, const Scalar* radius, Scalar at_x,
                                Scalar at_y, Scalar at_radius) {
        const Vector reach = Pack::add(Pack::load(radius), Pack::all(at_radius));
        return Pack::below(squared(x, y, at_x, at_y), Pack::mul(reach, reach));
    }
    static std::uint32_t take(std::uint32_t bits, const std::uint32_t* from, std::uint32_t* to) {
        return Pack::take(bits, from, to);
    }
    static void fill(std::uint32_t value, std::uint32_t* to) { Pack::fill(value, to); }
    static std::uint32_t outside(const Scalar* x, const Scalar* y, const Range2<Scalar>& range) {
        return Pack::inside(Pack::load(x), Pack::load(y), range) ^ ((1U << kLanes) - 1U);
    }
    static std::uint32_t move(const Motion<Scalar>& in, std::size_t i, Greatest& greatest) {
        const Vector u = Pack::load(in.vx_mps + i), v = Pack::load(in.vy_mps + i);
        const Vector span = Pack::all(in.span_s);
        Pack::store(in.x_m + i, Pack::add(Pack::load(in.x_m + i), Pack::mul(u, span)));
        Pack::store(in.y_m + i, Pack::add(Pack::load(in.y_m + i), Pack::mul(v, span)));
        const Vector squared = Pack::add(Pack::mul(u, u), Pack::mul(v, v));
        greatest = Pack::max(greatest, squared);
        return Pack::below(Pack::all(in.usual_squared), squared);
    }
    static Scalar greatest_of(const Greatest& greatest) { return Pack::greatest_of(greatest); }
};

template <typename Lanes>
Speeds<typename Lanes::Scalar> advance_lanes(const Motion<typename Lanes::Scalar>& motion) {
    using Scalar = typename Lanes::Scalar;
    const Motion<Scalar> in = motion;
    typename Lanes::Greatest greatest{};
    std::size_t faster = 0, i = 0;
    for (; i + Lanes::kLanes <= in.count; i += Lanes::kLanes) {
        std::uint32_t bits = Lanes::move(in, i, greatest);
        for (; bits != 0; bits &= bits - 1) [[unlikely]] {
                in.faster[faster++] =
                    static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(__builtin_ctz(bits));
            }
    }
    Scalar most = Lanes::greatest_of(greatest);
    for (; i < in.count; ++i) {
        in.x_m[i] += in.vx_mps[i] * in.span_s;
        in.y_m[i] += in.vy_mps[i] * in.span_s;
        const Scalar squared = in.vx_mps[i] * in.vx_mps[i] + in.vy_mps[i] * in.vy_mps[i];
        most = most < squared ? squared : most;
        if (in.usual_squared < squared) in.faster[faster++] = static_cast<std::uint32_t>(i);
    }
    return {most, faster};
}

template <typename Lanes>
std::size_t outside_lanes(const typename Lanes::Scalar* x_m, const typename Lanes::Scalar* y_m,
                          std::size_t count, const Range2<typename Lanes::Scalar>& range,
                          std::uint32_t* numbers) {
    const Range2<typename Lanes::Scalar> in = range;
    std::size_t found = 0, i = 0;
    for (; i + Lanes::kLanes <= count; i += Lanes::kLanes) {
        std::uint32_t bits = Lanes::outside(x_m + i, y_m + i, in);
        for (; bits != 0; bits &= bits - 1) [[unlikely]] {
                numbers[found++] =
                    static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(__builtin_ctz(bits));
            }
    }
    for (; i < count; ++i) {
        const bool is_inside = x_m[i] >= in.low_x_m && x_m[i] <= in.high_x_m &&
                               y_m[i] >= in.low_y_m && y_m[i] <= in.high_y_m;
        if (!is_inside) numbers[found++] = static_cast<std::uint32_t>(i);
    }
    return found;
}

// The discs of one run of memory that are near one disc. With `kFew` it is foreseen that there are
// none.
template <typename Lanes, bool kEqualRadii, bool kFew>
struct RunSearch {
    using Scalar = typename Lanes::Scalar;
    static constexpr std::uint32_t kLanes = Lanes::kLanes;

    const CellSearch<Scalar>& in;
    std::uint32_t disc;
    Scalar x, y, radius;
    Scalar reach_squared;

    [[gnu::always_inline]] std::size_t take(std::uint32_t j, std::uint32_t among,
                                            std::size_t found) const {
        std::uint32_t bits = 0;
        if constexpr (kEqualRadii) {
            bits = Lanes::near(in.x_m + j, in.y_m + j, x, y, reach_squared) & among;
        } else {
            bits = Lanes::within(in.x_m + j, in.y_m + j, in.radius_m + j, x, y, radius) & among;
        }
        if constexpr (kFew) {
            if (bits == 0) [[likely]]
                return found;
        }
        Lanes::fill(disc, in.a + found);
        return found + Lanes::take(bits, in.disc + j, in.b + found);
    }
    [[gnu::always_inline]] std::size_t take_run(std::uint32_t begin, std::uint32_t end,
                                                std::size_t found) const {
        for (; end - begin > kLanes; begin += kLanes) [[unlikely]] {
                found = take(begin, ~0U >> (32U - kLanes), found);
            }
        return take(begin, (1U << (end - begin)) - 1U, found);
    }
};

template <typename Lanes, bool kEqualRadii, bool kFew>
void search_rows(const CellSearch<typename Lanes::Scalar>& cells, SearchProgress& progress) {
    using Scalar = typename Lanes::Scalar;
    const CellSearch<Scalar> in = cells;
    const Scalar reach_squared = in.reach_m * in.reach_m;
    const std::size_t enough = in.capacity - in.most_near_one - 2 * Lanes::kLanes;
    std::size_t found = progress.found;
    for (std::uint32_t row = progress.row; row < in.rows; ++row) {
        const std::uint32_t left = row * in.stride + 1, end = in.first[left + in.columns];
        const bool resumed = row == progress.row && progress.place != 0;
        for (std::uint32_t i = resumed ? progress.place : in.first[left]; i < end; ++i) {
            if (found > enough) [[unlikely]] {
                progress = {row, i, found};
                return;
            }
            const std::uint32_t disc = in.disc[i];
            const std::uint32_t* const here = in.first + in.cell[disc];
            const std::uint32_t* const above = here + (in.stride - 1);
            const Scalar radius = kEqualRadii ? Scalar(0) : in.radius_m[i] + in.reach_m;
            const RunSearch<Lanes, kEqualRadii, kFew> around = {in,        disc,   in.x_m[i],
                                                                in.y_m[i], radius, reach_squared};
            found = around.take_run(i + 1, here[2], found);
            found = around.take_run(above[0], above[3], found);
        }
    }
    progress = {in.rows, 0, found};
}

template <typename Lanes>
void search_cells(const CellSearch<typename Lanes::Scalar>& cells, SearchProgress& progress) {
    if (cells.radius_m == nullptr) {
        cells.few ? search_rows<Lanes, true, true>(cells, progress)
                  : search_rows<Lanes, true, false>(cells, progress);
    } else {
        cells.few ? search_rows<Lanes, false, true>(cells, progress)
                  : search_rows<Lanes, false, false>(cells, progress);
    }
}

// Four pairs at a time, which is what can be fetched from so many places.
inline constexpr std::size_t kPairsAtOnce = 4;

// The square of the distance to the nearest image.
template <typename Lanes, bool kPeriodic>
typename Lanes::Scalar separation_squared(const PairTest<typename Lanes::Scalar>& in,
                                          std::uint32_t a, std::uint32_t b) {
    using Scalar = typename Lanes::Scalar;
    Scalar x = in.x_m[a] - in.x_m[b], y = in.y_m[a] - in.y_m[b];
    if constexpr (kPeriodic) {
        const auto to_image = [](Scalar separation, Scalar extent) {
            const Scalar near = separation < Scalar(0) ? -separation : separation;
            const Scalar far = extent - near;
            return far < near ? far : near;
        };
        x = to_image(x, in.extent_x_m);
        y = to_image(y, in.extent_y_m);
    }
    return x * x + y * y;
}

template <typename Lanes, bool kEqualRadii, bool kPeriodic>
std::uint32_t near_pairs(const PairTest<typename Lanes::Scalar>& in, std::size_t k,
                         std::size_t count) {
    using Scalar = typename Lanes::Scalar;
    std::uint32_t bits = 0;
    for (std::size_t lane = 0; lane < count; ++lane) {
        const std::uint32_t a = in.a[k + lane], b = in.b[k + lane];
        const Scalar reach =
            kEqualRadii ? in.reach_m : in.radius_m[a] + in.radius_m[b] + in.reach_m;
        const bool is_near = separation_squared<Lanes, kPeriodic>(in, a, b) < reach * reach;
        bits |= static_cast<std::uint32_t>(is_near) << lane;
    }
    return bits;
}

#if defined(__SSE2__)

template <typename Lanes, bool kEqualRadii, bool kPeriodic>
[[gnu::always_inline]] inline std::uint32_t two_near_pairs(const PairTest<double>& in,
                                                           std::size_t k) {
    const std::uint32_t a[2] = {in.a[k], in.a[k + 1]}, b[2] = {in.b[k], in.b[k + 1]};
    const auto two = [](const double* values, const std::uint32_t(&at)[2]) {
        return _mm_loadh_pd(_mm_load_sd(values + at[0]), values + at[1]);
    };
    __m128d x = _mm_sub_pd(two(in.x_m, a), two(in.x_m, b));
    __m128d y = _mm_sub_pd(two(in.y_m, a), two(in.y_m, b));
    if constexpr (kPeriodic) {
        const auto to_image = [](__m128d separation, double extent) {
            const __m128d near = _mm_andnot_pd(_mm_set1_pd(-0.0), separation);
            return _mm_min_pd(near, _mm_sub_pd(_mm_set1_pd(extent), near));
        };
        x = to_image(x, in.extent_x_m);
        y = to_image(y, in.extent_y_m);
    }
    __m128d reach = _mm_set1_pd(in.reach_m);
    if constexpr (!kEqualRadii) {
        reach = _mm_add_pd(_mm_add_pd(two(in.radius_m, a), two(in.radius_m, b)), reach);
    }
    const __m128d squared = _mm_add_pd(_mm_mul_pd(x, x), _mm_mul_pd(y, y));
    return static_cast<std::uint32_t>(
        _mm_movemask_pd(_mm_cmplt_pd(squared, _mm_mul_pd(reach, reach))));
}

#endif

#if defined(__AVX2__)

template <typename Lanes, bool kEqualRadii, bool kPeriodic>
[[gnu::always_inline]] inline std::uint32_t near_pairs_at_once(const PairTest<double>& in,
                                                               std::size_t k) {
    const std::uint32_t *const a = in.a + k, *const b = in.b + k;
    const auto two = [](const double* values, const std::uint32_t* at) {
        return _mm_loadh_pd(_mm_load_sd(values + at[0]), values + at[1]);
    };
    const auto four = [](__m128d low, __m128d high) {
        return _mm256_insertf128_pd(_mm256_castpd128_pd256(low), high, 1);
    };
    const auto apart = [&](const double* values) {
        return four(_mm_sub_pd(two(values, a), two(values, b)),
                    _mm_sub_pd(two(values, a + 2), two(values, b + 2)));
    };
    __m256d x = apart(in.x_m), y = apart(in.y_m);
    if constexpr (kPeriodic) {
        const auto to_image = [](__m256d separation, double extent) {
            const __m256d near = _mm256_andnot_pd(_mm256_set1_pd(-0.0), separation);
            return _mm256_min_pd(near, _mm256_sub_pd(_mm256_set1_pd(extent), near));
        };
        x = to_image(x, in.extent_x_m);
        y = to_image(y, in.extent_y_m);
    }
    __m256d reach = _mm256_set1_pd(in.reach_m);
    if constexpr (!kEqualRadii) {
        const __m256d radii = four(_mm_add_pd(two(in.radius_m, a), two(in.radius_m, b)),
                                   _mm_add_pd(two(in.radius_m, a + 2), two(in.radius_m, b + 2)));
        reach = _mm256_add_pd(radii, reach);
    }
    const __m256d squared = _mm256_add_pd(_mm256_mul_pd(x, x), _mm256_mul_pd(y, y));
    const __m256d is_near = _mm256_cmp_pd(squared, _mm256_mul_pd(reach, reach), _CMP_LT_OQ);
    return static_cast<std::uint32_t>(_mm256_movemask_pd(is_near));
}

#elif defined(__SSE2__)

template <typename Lanes, bool kEqualRadii, bool kPeriodic>
[[gnu::always_inline]] inline std::uint32_t near_pairs_at_once(const PairTest<double>& in,
                                                               std::size_t k) {
    return two_near_pairs<Lanes, kEqualRadii, kPeriodic>(in, k) |
           two_near_pairs<Lanes, kEqualRadii, kPeriodic>(in, k + 2) << 2U;
}

#endif

template <typename Lanes, bool kEqualRadii, bool kPeriodic>
[[gnu::always_inline]] inline std::uint32_t four_near_pairs(
    const PairTest<typename Lanes::Scalar>& in, std::size_t k) {
#if defined(__SSE2__)
    if constexpr (Lanes::kHasSse2 && sizeof(typename Lanes::Scalar) == sizeof(double)) {
        return near_pairs_at_once<Lanes, kEqualRadii, kPeriodic>(in, k);
    }
#endif
    return near_pairs<Lanes, kEqualRadii, kPeriodic>(in, k, kPairsAtOnce);
}

template <typename Lanes, bool kEqualRadii, bool kPeriodic>
std::size_t pick_pairs(const PairTest<typename Lanes::Scalar>& pairs, std::uint32_t* numbers) {
    using Scalar = typename Lanes::Scalar;
    const PairTest<Scalar> in = pairs;
    std::size_t found = 0, k = 0;
    const auto write = [&](std::uint32_t bits) {
        for (; bits != 0; bits &= bits - 1) {
            numbers[found++] =
                static_cast<std::uint32_t>(k) + static_cast<std::uint32_t>(__builtin_ctz(bits));
        }
    };
    for (; k + kPairsAtOnce <= in.count; k += kPairsAtOnce) {
        const std::uint32_t bits = four_near_pairs<Lanes, kEqualRadii, kPeriodic>(in, k);
        if (bits != 0) [[unlikely]]
            write(bits);
    }
    write(near_pairs<Lanes, kEqualRadii, kPeriodic>(in, k, in.count - k));
    return found;
}

template <typename Lanes>
std::size_t pick(const PairTest<typename Lanes::Scalar>& pairs, std::uint32_t* numbers) {
    using Scalar = typename Lanes::Scalar;
    const bool periodic = pairs.extent_x_m > Scalar(0);
    if (pairs.radius_m == nullptr) {
        return periodic ? pick_pairs<Lanes, true, true>(pairs, numbers)
                        : pick_pairs<Lanes, true, false>(pairs, numbers);
    }
    return periodic ? pick_pairs<Lanes, false, true>(pairs, numbers)
                    : pick_pairs<Lanes, false, false>(pairs, numbers);
}

template <typename Lanes>
inline constexpr CrowdKernels<typename Lanes::Scalar> kKernelsOf = {
    advance_lanes<Lanes>, outside_lanes<Lanes>, search_cells<Lanes>, pick<Lanes>};

}  // namespace fts::physics
