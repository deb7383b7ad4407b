#include "common/physics/kick.h"

#include "common/physics/exponential.h"

namespace fts::physics {
namespace {

// What drag leaves of a velocity after the span, and the span as thrust feels it. Neighbours often
// share a drag, so the last answer is kept.
template <typename Scalar>
class Damping {
  public:
    explicit Damping(Scalar span_s) : span_s_(span_s), felt_span_s_(span_s) {}

    void set_drag(Scalar drag_per_s) {
        if (drag_per_s == drag_per_s_) return;
        drag_per_s_ = drag_per_s;
        const Decay d = decay(static_cast<double>(drag_per_s) * static_cast<double>(span_s_));
        kept_ = static_cast<Scalar>(d.factor);
        felt_span_s_ = span_s_ * static_cast<Scalar>(d.mean);
    }
    Scalar kept() const { return kept_; }
    Scalar felt_span_s() const { return felt_span_s_; }

  private:
    Scalar span_s_;
    Scalar drag_per_s_ = Scalar(0);
    Scalar kept_ = Scalar(1);
    Scalar felt_span_s_;
};

}  // namespace

template <typename Scalar>
bool kick(Bodies<Scalar>& bodies, Scalar scene_drag_per_s, Scalar span_s) {
    Damping<Scalar> damping(span_s);
    bool acted = false;
    for (const BodyId id : bodies.ids) {
        const Control<Scalar>& control = bodies.control[id.index];
        acted = acted || control.acts();
        if (!control.acts() && scene_drag_per_s == Scalar(0)) continue;
        damping.set_drag(control.drag_per_s + scene_drag_per_s);
        Vec2<Scalar>& velocity = bodies.velocity_mps[id.index];
        velocity = velocity * damping.kept() + control.acceleration_mps2 * damping.felt_span_s();
    }
    return acted;
}

template bool kick<double>(Bodies<double>&, double, double);
template bool kick<float>(Bodies<float>&, float, float);

}  // namespace fts::physics
