#include "common/physics/path_kernels.h"

#include "common/physics/path_loops.h"

namespace fts::physics {
namespace {

struct OneByOnePaths {
    PathTest test;

    explicit OneByOnePaths(const PathTest& asked) : test(asked) {}
    void ask_for(const FlightPath& path, float radius) {
        test.self = path;
        test.radius = radius;
    }
    template <bool kEqualRadii, bool kClose>
    std::uint32_t bits_of(const FlightPath* path, const float* radius) const {
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < kPathsAtOnce; ++k) {
            const float way_x = path[k].way_x - test.self.way_x;
            const float way_y = path[k].way_y - test.self.way_y;
            const float x = path[k].x - test.self.x, y = path[k].y - test.self.y;
            const float from_x = x + way_x * test.from, from_y = y + way_y * test.from;
            const float sum = from_x * (x + way_x * test.to) + from_y * (y + way_y * test.to);
            const float reach = kEqualRadii ? 0.0F : radius[k] + test.radius;
            bits |= (sum <= test.limit + reach * reach ? 1U : 0U) << k;
            if constexpr (kClose) {
                const bool is_close =
                    from_x * from_x + from_y * from_y <= test.close_limit + reach * reach;
                bits |= (is_close ? 1U : 0U) << (kPathsAtOnce + k);
            }
        }
        return bits;
    }
};

}  // namespace

const PathKernels& path_kernels(SimdLevel level, bool equal_radii) {
#if defined(__x86_64__)
    if (level >= SimdLevel::kAvx512) return path_kernels_avx512(equal_radii);
    if (level >= SimdLevel::kAvx2) return path_kernels_avx2(equal_radii);
#endif
    return equal_radii ? PathLoops<OneByOnePaths, true>::kTable
                       : PathLoops<OneByOnePaths, false>::kTable;
}

}  // namespace fts::physics
