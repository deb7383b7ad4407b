// The floor under every solver: places and velocities read once and written once a tick, and
// nothing else. Who keeps a ball as these four numbers and changes them every tick cannot be
// faster.
#pragma once

#include <memory>

#include "server/lab/bench/engine.h"

namespace fts::lab {

template <typename Scalar>
std::unique_ptr<Engine> make_memory_pass(const physics::Scene& scene, double tick_s);

}  // namespace fts::lab
