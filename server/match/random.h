// The only randomness of a match. Not for anything secret.
#pragma once

#include "common/physics/splitmix.h"

namespace fts::server {

using Random = physics::SplitMix;

}  // namespace fts::server
