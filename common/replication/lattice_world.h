// The shared physics on quantised states: balls of a snapshot, run forward tick by tick. The same
// balls, calls and course give the same bits at both ends.
//
// `snap` puts the running state onto the lattice. A server that snaps at every snapshot has nothing
// that its clients do not have: who runs on from such a snapshot, and snaps as it does, stays with
// it to the last bit until somebody steers.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "common/physics/world.h"
#include "common/replication/snapshot.h"

namespace fts::replication {

struct Lattice {
    double position_step_m = kPositionStepM;
    double velocity_step_mps = kVelocityStepMps;
};

// What both ends know besides snapshots; ours, never made from bytes.
struct Course {
    // Walls or nothing: a ball that falls off a platform, or is elsewhere in a periodic box, has no
    // place among the balls of a snapshot. Its own bodies are not looked at.
    physics::Scene scene;
    Lattice lattice;
    double tick_s = 1.0 / 60.0;
    // What the control of a ball does to it.
    std::function<physics::Control<double>(const BallState&)> control_of;
};

// The course with these balls on it, whatever they hold: inside the walls, if there are any, and
// made valid bodies.
physics::Scene scene_of(const Course& course, std::span<const BallState> balls);

class LatticeWorld {
  public:
    // Whatever the balls hold, none is ever lost.
    LatticeWorld(const Course& course, std::span<const BallState> balls);

    // The control in `controls` acts on ball `index` from now on.
    void steer(std::size_t index, const BallState& controls);
    // Straight on, with collisions; `span_s` after `span_s`.
    void advance(double span_s);
    void snap();

    // As they are now, on the lattice.
    std::vector<BallState> balls() const;
    // Of the last `advance`; the index of a body is that of its ball.
    std::span<const physics::Contact<double>> contacts() const { return world_.contacts(); }
    double kinetic_energy_j() const { return world_.kinetic_energy_j(); }
    // Off the lattice, as it is between snaps; the index of a body is that of its ball.
    const physics::World<double>& world() const { return world_; }

  private:
    void steer_all();

    Course course_;
    std::vector<BallState> balls_;  // but for their motion
    physics::World<double> world_;
};

}  // namespace fts::replication
