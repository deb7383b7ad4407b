// Sums up single ticks of a solver against exact ones (accuracy.h, LocalAccuracy).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/physics/record.h"
#include "server/lab/accuracy.h"
#include "server/lab/exact_tick.h"

namespace fts::lab {

// A collision as the comparison sees it, in double.
struct SeenContact {
    Hit hit;
    physics::Vec2d relative_velocity_after_mps;  // of a to b, or to the wall
};

template <typename Scalar>
SeenContact seen(const physics::Contact<Scalar>& contact) {
    const physics::Vec2d normal = contact.normal.template cast<double>();
    const std::uint32_t b = contact.b ? contact.b->index : wall_with_normal(normal);
    physics::Vec2d relative = contact.velocity_a_after_mps.template cast<double>();
    if (contact.b) relative -= contact.velocity_b_after_mps.template cast<double>();
    const double sign = contact.b && b < contact.a.index ? -1.0 : 1.0;
    return {{contact.b && b < contact.a.index ? b : contact.a.index,
             contact.b && b < contact.a.index ? contact.a.index : b,
             static_cast<double>(contact.time_s)},
            sign * relative};
}
SeenContact seen(const OracleContact& contact);

class TickComparison {
  public:
    // `before` is the solver's state at the start of the tick, and what has no collision keeps its
    // velocity times `kept`.
    void add(const std::vector<physics::BodyDef>& before, double kept, const ExactTick& exact,
             const std::vector<physics::Vec2d>& solver_velocity_after_mps,
             const std::vector<SeenContact>& solver_contacts, double tick_s);
    void add_too_busy() { ++sums_.ticks_too_busy; }
    void add_undecided() { ++sums_.ticks_undecided; }

    LocalAccuracy result() const;

  private:
    void compare_contacts(std::vector<SeenContact> exact, std::vector<SeenContact> solver,
                          double tick_s);

    LocalAccuracy sums_;
    double wrong_ = 0.0, ignored_ = 0.0, speed_ = 0.0;  // sums of squares
    double time_ = 0.0, angle_ = 0.0;
    std::size_t angles_ = 0;
};

}  // namespace fts::lab
