// The kernels that are compiled for processors that not everybody has. Only crowd_kernels.cpp knows
// who may call them.
#pragma once

#include "common/physics/crowd_kernels.h"

namespace fts::physics {

extern const CrowdKernels<double> kAvx2OfDoubles;
extern const CrowdKernels<float> kAvx2OfFloats;
extern const CrowdKernels<double> kAvx512OfDoubles;
extern const CrowdKernels<float> kAvx512OfFloats;

}  // namespace fts::physics
