// World: the state of one scene and `step`, which advances it by one tick.
//
// A tick of length h is kick(h/2), drift(h), kick(h/2) (Strang splitting). Kick applies each body's
// Control: thrust and linear drag, integrated exactly, so that top speed does not depend on the
// tick rate. Drift is straight-line motion with elastic collisions and falls, as the solver has it
// (solver_choice.h); the default finds exact times of impact and processes them in time order.
//
// A scene whose only acceleration is its own drag needs no kick: with one drag k for all, bodies
// move on the same lines as without it, in the slower time s = (1 - exp(-k t)) / k. Such a tick is
// drift(s), and every velocity times exp(-k h): exact, collisions included. The solver does not
// hear of it, so that a calendar of collisions outlives it.
//
// Deterministic: the same scene, calls and spans give the same bits on every compiler and
// optimisation level. Not thread-safe: one thread at a time. No allocation after warm-up.
//
// Bodies keep their BodyId for life; a removed id is never valid again (generation). Iteration
// order is ascending slot index, which does not depend on addresses. In a periodic scene positions
// are inside the box after every step.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/physics/body.h"
#include "common/physics/record.h"
#include "common/physics/scene.h"
#include "common/physics/solver_choice.h"

namespace fts::physics {

struct StepReport {
    std::uint32_t events = 0;  // collisions and falls processed
    // The event budget ran out before the end of the tick, and this much of the tick was not
    // simulated; the state is valid.
    bool overrun = false;
    double unspent_time_s = 0.0;
};

template <typename Scalar>
class World {
  public:
    // The scene must be valid (scene.h, validate), but for overlaps.
    explicit World(const Scene& scene, const SolverChoice& solver = {});
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    StepReport step(Scalar tick_duration_s);

    // Empty when the body would overlap another one, or hold a value that `validate` refuses.
    std::optional<BodyId> add(const BodyDef& body);
    bool remove(BodyId id);
    bool contains(BodyId id) const;

    // These five expect a living id.
    BodyView<Scalar> body(BodyId id) const;
    // The body's, alone: a solver with its own copy of a crowd brings no velocities up to date.
    Vec2<Scalar> position_m(BodyId id) const;
    void set_control(BodyId id, const Control<Scalar>& control);
    void set_mass(BodyId id, Scalar mass_kg);
    void set_velocity(BodyId id, const Vec2<Scalar>& velocity_mps);

    std::size_t size() const;
    // Ids of all living bodies, ascending by index. Valid until the next add, remove or step.
    std::span<const BodyId> ids() const;

    // Of the last step, in the order they happened. Valid until the next step.
    std::span<const Contact<Scalar>> contacts() const;
    std::span<const Fall<Scalar>> falls() const;

    // True when a disc at `position_m` with `radius_m` overlaps no body.
    bool is_free(const Vec2<Scalar>& position_m, Scalar radius_m) const;

    const CollisionAudit& audit() const;
    // FNV-1a over the bits of every living body's index, position, velocity, radius and mass.
    std::uint64_t state_hash() const;
    double kinetic_energy_j() const;  // finite masses only
    Vec2d momentum_ns() const;        // finite masses only
    // How deep the worst pair, or ball and wall, overlap now, in units of the smaller radius; 0
    // when none does.
    double deepest_overlap() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

extern template class World<double>;
extern template class World<float>;

}  // namespace fts::physics
