// The kernels that are compiled for processors that not everybody has. Only lane_kernels.cpp knows
// who may call them.
#pragma once

#include "common/physics/lane_kernels.h"

namespace fts::physics {

extern const LaneKernels<double> kAvx2OfDoubles;
extern const LaneKernels<float> kAvx2OfFloats;
extern const LaneKernels<double> kAvx512OfDoubles;
extern const LaneKernels<float> kAvx512OfFloats;

}  // namespace fts::physics
