// A kick: for `span_s`, every body's velocity follows dv/dt = acceleration - drag * v while it
// stays where it is, its drag being its Control's and the scene's. Exact, so that two kicks of half
// the span are one of the whole, and top speed does not depend on the tick rate.
#pragma once

#include "common/physics/bodies.h"

namespace fts::physics {

// Returns whether any body has a control that acts; when not, and the scene has no drag, nothing
// changed.
template <typename Scalar>
bool kick(Bodies<Scalar>& bodies, Scalar scene_drag_per_s, Scalar span_s);

extern template bool kick<double>(Bodies<double>&, double, double);
extern template bool kick<float>(Bodies<float>&, float, float);

}  // namespace fts::physics
