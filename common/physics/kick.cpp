#include "common/physics/kick.h"

#include "common/physics/exponential.h"

namespace fts::physics {

template <typename Scalar>
void kick(Bodies<Scalar>& bodies, Scalar span_s) {
    for (const BodyId id : bodies.ids) {
        const Control<Scalar>& control = bodies.control[id.index];
        Vec2<Scalar>& velocity = bodies.velocity_mps[id.index];
        if (control.drag_per_s == Scalar(0)) {
            velocity += control.acceleration_mps2 * span_s;
            continue;
        }
        const Decay d =
            decay(static_cast<double>(control.drag_per_s) * static_cast<double>(span_s));
        velocity = velocity * static_cast<Scalar>(d.factor) +
                   control.acceleration_mps2 * (span_s * static_cast<Scalar>(d.mean));
    }
}

template void kick<double>(Bodies<double>&, double);
template void kick<float>(Bodies<float>&, float);

}  // namespace fts::physics
