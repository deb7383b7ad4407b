// The shared physics on quantised states: balls of a snapshot, run forward tick by tick. The same
// balls, calls and course give the same bits at both ends.
//
// `snap` puts the running state onto the lattice. A server that snaps at every snapshot has nothing
// that its clients do not have: who runs on from such a snapshot, snaps as it does, and steers,
// puts and removes what it does in the same order, stays with it to the last bit.
//
// A ball has a slot, which it keeps until the next `snap`: from then on, as at first, slots ascend
// by id.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/game/movement.h"
#include "common/physics/world.h"
#include "common/replication/snapshot.h"

namespace fts::replication {

struct Lattice {
    double position_step_m = kPositionStepM;
    double velocity_step_mps = kVelocityStepMps;
};

// What both ends know besides snapshots; ours, never made from bytes.
struct Course {
    // Walls, a platform or nothing; what is periodic has no place on a lattice. Its own bodies are
    // not looked at.
    physics::Scene scene;
    physics::SolverChoice solver;
    Lattice lattice;
    double tick_s = 1.0 / 60.0;
    // What the control of a ball does to it, and what a dash of it does; without them nothing.
    std::function<physics::Control<double>(const BallState&)> control_of;
    std::function<physics::Vec2d(const BallState&)> dash_of;
};

// Of a level of the game: balls on a platform that answer as their handling says.
Course course_of(const physics::Platform& platform, const physics::SolverChoice& solver);
HandlingState quantised(const game::Handling& handling);
game::Handling handling_of(const BallState& ball);

// The course with these balls, whatever they hold: inside the walls, if there are any, and made
// valid bodies; they may be off the platform.
physics::Scene scene_of(const Course& course, std::span<const BallState> balls);

class LatticeWorld {
  public:
    // `balls` ascends by id; whatever they hold, each has a place inside the walls and on the
    // platform.
    LatticeWorld(const Course& course, std::span<const BallState> balls);

    std::optional<std::size_t> slot_of(std::uint16_t id) const;
    std::uint16_t id_at(std::size_t slot) const { return balls_[slot].id; }
    // Off the lattice, as it is between snaps; the index of a body is the slot of its ball.
    const physics::World<double>& world() const { return world_; }
    // Of a ball that is there.
    physics::BodyView<double> body(std::uint16_t id) const;

    // The control in `controls` acts on the ball from now on.
    void steer(std::size_t slot, const BallState& controls);
    void dash(std::size_t slot);
    // A new ball, or, in place of the one of its id, another mass and handling. False when there is
    // no room for it.
    bool put(const BallState& ball);
    void remove(std::uint16_t id);
    // Everything stands still, and nobody steers.
    void halt();
    // Straight on, with collisions and falls; `span_s` after `span_s`. Who falls is gone.
    physics::StepReport advance(double span_s);
    void snap();

    // As they are now, on the lattice, ascending by id.
    std::vector<BallState> balls() const;
    // Of the last `advance`; the index of a body is the slot of its ball.
    std::span<const physics::Contact<double>> contacts() const { return world_.contacts(); }
    std::span<const physics::Fall<double>> falls() const { return world_.falls(); }
    double kinetic_energy_j() const { return world_.kinetic_energy_j(); }

  private:
    struct Entry {
        std::uint16_t id = 0;
        physics::BodyId body;
    };
    std::vector<Entry>::const_iterator find(std::uint16_t id) const;
    void list_all();

    Course course_;
    std::vector<BallState> balls_;  // by slot; but for their motion
    std::vector<Entry> entries_;    // of those that are there, ascending by id
    physics::World<double> world_;
};

}  // namespace fts::replication
