// Compiled with -mavx512f -mavx512vl -mavx512dq -mavx512bw -mpopcnt -mbmi2.
#include <immintrin.h>

#include "common/physics/path_loops.h"

namespace fts::physics {
namespace {

struct Avx512Paths {
    __m512 from, to, limit, close_limit;
    __m512 self, radius_of_self;

    explicit Avx512Paths(const PathTest& test)
        : from(_mm512_set1_ps(test.from)),
          to(_mm512_set1_ps(test.to)),
          limit(_mm512_set1_ps(test.limit)),
          close_limit(_mm512_set1_ps(test.close_limit)),
          self(four_of(test.self)),
          radius_of_self(_mm512_set1_ps(test.radius)) {}
    void ask_for(const FlightPath& path, float radius) {
        self = four_of(path);
        radius_of_self = _mm512_set1_ps(radius);
    }
    static __m512 four_of(const FlightPath& path) {
        return _mm512_broadcast_f32x4(_mm_load_ps(&path.x));
    }

    template <bool kEqualRadii, bool kClose>
    std::uint32_t bits_of(const FlightPath* path, const float* radius) const {
        const __m512i places = _mm512_set_epi64(14, 12, 10, 8, 6, 4, 2, 0);
        const __m512i ways = _mm512_set_epi64(15, 13, 11, 9, 7, 5, 3, 1);
        const __m512d low = apart(path), high = apart(path + 4);
        const __m512 place = _mm512_castpd_ps(_mm512_permutex2var_pd(low, places, high));
        const __m512 way = _mm512_castpd_ps(_mm512_permutex2var_pd(low, ways, high));
        const __m512 begin = _mm512_add_ps(place, _mm512_mul_ps(way, from));
        const __m512 end = _mm512_add_ps(place, _mm512_mul_ps(way, to));
        __m512 more = _mm512_setzero_ps();
        if constexpr (!kEqualRadii) {
            const __m512i twice = _mm512_set_epi32(7, 7, 6, 6, 5, 5, 4, 4, 3, 3, 2, 2, 1, 1, 0, 0);
            const __m512 eight = _mm512_castps256_ps512(_mm256_loadu_ps(radius));
            const __m512 reach = _mm512_add_ps(_mm512_permutexvar_ps(twice, eight), radius_of_self);
            more = _mm512_mul_ps(reach, reach);
        }
        const auto bits_within = [&](__m512 product, __m512 most) {
            const __m512 sum = _mm512_add_ps(product, _mm512_permute_ps(product, 0xb1));
            if constexpr (!kEqualRadii) most = _mm512_add_ps(most, more);
            return _pext_u32(_mm512_cmp_ps_mask(sum, most, _CMP_LE_OQ), 0x5555);
        };
        std::uint32_t bits = bits_within(_mm512_mul_ps(begin, end), limit);
        if constexpr (kClose) {
            bits |= bits_within(_mm512_mul_ps(begin, begin), close_limit) << kPathsAtOnce;
        }
        return bits;
    }

  private:
    __m512d apart(const FlightPath* four) const {
        return _mm512_castps_pd(_mm512_sub_ps(_mm512_loadu_ps(&four->x), self));
    }
};

}  // namespace

const PathKernels& path_kernels_avx512(bool equal_radii) {
    return equal_radii ? PathLoops<Avx512Paths, true>::kTable
                       : PathLoops<Avx512Paths, false>::kTable;
}

}  // namespace fts::physics
