// The oracle of the solvers: looks at every pair before every event, moves everybody to every
// event, and takes roots from the textbook formula in long double. Shares no code with what it
// judges.
#pragma once

#include <cstddef>
#include <vector>

#include "common/physics/scene.h"

namespace fts::physics {

struct Outcome {
    std::vector<BodyDef> bodies;      // as in the scene; those that fell stay where they fell
    std::vector<std::size_t> fallen;  // in the order they fell
    std::size_t ball_collisions = 0;
    std::size_t wall_collisions = 0;
};

Outcome coast(const Scene& scene, double span_s);

}  // namespace fts::physics
