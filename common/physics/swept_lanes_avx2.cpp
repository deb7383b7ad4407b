// Compiled with -mavx2 -mpopcnt.
#include <immintrin.h>

#include "common/physics/swept_kernels.h"

namespace fts::physics {
namespace {

struct Avx2Pack {
    static constexpr std::uint32_t kWidth = 8;
    using Vector = __m256;
    static Vector load(const float* from) { return _mm256_loadu_ps(from); }
    static Vector all(float value) { return _mm256_set1_ps(value); }
    static Vector add(Vector a, Vector b) { return _mm256_add_ps(a, b); }
    static Vector sub(Vector a, Vector b) { return _mm256_sub_ps(a, b); }
    static Vector mul(Vector a, Vector b) { return _mm256_mul_ps(a, b); }
    static std::uint32_t at_most(Vector a, Vector b) {
        return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
    }
};

}  // namespace

const LaneKernels& lane_kernels_avx2(bool equal_radii) {
    return equal_radii ? SweptKernels<Avx2Pack, true>::kTable
                       : SweptKernels<Avx2Pack, false>::kTable;
}

}  // namespace fts::physics
