// How wide the vector instructions are that the inner loops use. Every level gives the same bits;
// only the speed differs.
#pragma once

#include <cstdint>

namespace fts::physics {

enum class SimdLevel : std::uint8_t {
    kPlain,  // none
    kSse2,
    kAvx2,
    kAvx512,  // F, VL, DQ and BW
};

// Whether this processor has it. The order is that of width: who has one has those below it.
bool is_supported(SimdLevel level);

// The widest that this processor has.
SimdLevel best_simd_level();

}  // namespace fts::physics
