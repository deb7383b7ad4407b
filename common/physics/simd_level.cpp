#include "common/physics/simd_level.h"

#include <initializer_list>

namespace fts::physics {

bool is_supported(SimdLevel level) {
    if (level == SimdLevel::kPlain) return true;
#if defined(__x86_64__)
    if (level == SimdLevel::kSse2) return true;
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt");
    if (level == SimdLevel::kAvx2) return avx2;
    return avx2 && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw");
#else
    return false;
#endif
}

SimdLevel best_simd_level() {
    for (const SimdLevel level : {SimdLevel::kAvx512, SimdLevel::kAvx2, SimdLevel::kSse2}) {
        if (is_supported(level)) return level;
    }
    return SimdLevel::kPlain;
}

}  // namespace fts::physics
