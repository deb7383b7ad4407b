// Compiled with -mavx2 -mpopcnt.
#include <immintrin.h>

#include "common/physics/path_loops.h"

namespace fts::physics {
namespace {

struct Avx2Paths {
    __m256 from, to, limit, close_limit;
    __m256 self, radius_of_self;

    explicit Avx2Paths(const PathTest& test)
        : from(_mm256_set1_ps(test.from)),
          to(_mm256_set1_ps(test.to)),
          limit(_mm256_set1_ps(test.limit)),
          close_limit(_mm256_set1_ps(test.close_limit)),
          self(four_of(test.self)),
          radius_of_self(_mm256_set1_ps(test.radius)) {}
    void ask_for(const FlightPath& path, float radius) {
        self = four_of(path);
        radius_of_self = _mm256_set1_ps(radius);
    }
    static __m256 four_of(const FlightPath& path) {
        return _mm256_broadcast_ps(reinterpret_cast<const __m128*>(&path));
    }

    template <bool kEqualRadii, bool kClose>
    std::uint32_t bits_of(const FlightPath* path, const float* radius) const {
        const Four low(*this, path), high(*this, path + 4);
        __m256 more = _mm256_setzero_ps();
        if constexpr (!kEqualRadii) {
            const __m256 reach = _mm256_add_ps(_mm256_loadu_ps(radius), radius_of_self);
            more = _mm256_mul_ps(reach, reach);
        }
        const auto bits_within = [&](__m256 products, __m256 others, __m256 most) {
            // Both halves of a sum are of paths that alternate.
            const __m256i order = _mm256_set_epi32(7, 3, 6, 2, 5, 1, 4, 0);
            const __m256 sum = _mm256_permutevar8x32_ps(_mm256_hadd_ps(products, others), order);
            if constexpr (!kEqualRadii) most = _mm256_add_ps(most, more);
            return static_cast<std::uint32_t>(
                _mm256_movemask_ps(_mm256_cmp_ps(sum, most, _CMP_LE_OQ)));
        };
        std::uint32_t bits = bits_within(_mm256_mul_ps(low.begin, low.end),
                                         _mm256_mul_ps(high.begin, high.end), limit);
        if constexpr (kClose) {
            bits |= bits_within(_mm256_mul_ps(low.begin, low.begin),
                                _mm256_mul_ps(high.begin, high.begin), close_limit)
                    << kPathsAtOnce;
        }
        return bits;
    }

  private:
    // Of four paths, x and y side by side, at the two fractions.
    struct Four {
        __m256 begin, end;

        Four(const Avx2Paths& test, const FlightPath* path) {
            const __m256d one = apart(test, path), other = apart(test, path + 2);
            const __m256 place = _mm256_castpd_ps(_mm256_unpacklo_pd(one, other));
            const __m256 way = _mm256_castpd_ps(_mm256_unpackhi_pd(one, other));
            begin = _mm256_add_ps(place, _mm256_mul_ps(way, test.from));
            end = _mm256_add_ps(place, _mm256_mul_ps(way, test.to));
        }
        static __m256d apart(const Avx2Paths& test, const FlightPath* two) {
            return _mm256_castps_pd(_mm256_sub_ps(_mm256_loadu_ps(&two->x), test.self));
        }
    };
};

}  // namespace

const PathKernels& path_kernels_avx2(bool equal_radii) {
    return equal_radii ? PathLoops<Avx2Paths, true>::kTable : PathLoops<Avx2Paths, false>::kTable;
}

}  // namespace fts::physics
