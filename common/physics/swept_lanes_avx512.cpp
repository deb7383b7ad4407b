// Compiled for AVX-512F, and called only where there is such.
#if defined(__x86_64__)

#include <immintrin.h>

#include "common/physics/swept_kernels.h"

namespace fts::physics {
namespace {

struct Avx512Pack {
    static constexpr std::uint32_t kWidth = 16;
    using Vector = __m512;
    static Vector load(const float* from) { return _mm512_loadu_ps(from); }
    static Vector all(float value) { return _mm512_set1_ps(value); }
    static Vector add(Vector a, Vector b) { return _mm512_add_ps(a, b); }
    static Vector sub(Vector a, Vector b) { return _mm512_sub_ps(a, b); }
    static Vector mul(Vector a, Vector b) { return _mm512_mul_ps(a, b); }
    static std::uint32_t at_most(Vector a, Vector b) {
        return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
    }
};

}  // namespace

const LaneKernels& lane_kernels_avx512(bool equal_radii) {
    return equal_radii ? SweptKernels<Avx512Pack, true>::kTable
                       : SweptKernels<Avx512Pack, false>::kTable;
}

}  // namespace fts::physics

#endif
