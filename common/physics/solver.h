// How a span of time is advanced: straight-line motion with collisions and falls, and no
// acceleration. The one stage of a tick in which solvers differ.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/physics/bodies.h"
#include "common/physics/record.h"
#include "common/physics/solver_choice.h"

namespace fts::physics {

// What a scene has besides its bodies, so that a solver need not look for what is not there.
template <typename Scalar>
struct Model {
    struct Box {
        Vec2<Scalar> min_m, max_m;
        Vec2<Scalar> extent_m() const { return max_m - min_m; }
    };
    std::optional<Box> walls;
    std::optional<Box> periodic;
    std::optional<Platform> platform;
    Scalar restitution = Scalar(1);
    // Of the living bodies. World keeps them true.
    bool equal_radii = false;
    bool equal_masses = false;  // and finite
};

template <typename Scalar>
struct DriftReport {
    std::uint32_t events = 0;
    bool overrun = false;
    Scalar unspent_time_s = Scalar(0);  // the state is that of the span's end less this
};

template <typename Scalar>
class Solver {
  public:
    virtual ~Solver() = default;

    // Advances by `span_s` >= 0, removes bodies that fall, and appends to the record. In a periodic
    // scene positions end inside the box.
    virtual DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model,
                                      Scalar span_s, Record<Scalar>& record) = 0;

    // Somebody else changed, added or removed bodies since the last drift, after `synchronise`:
    // nothing that was predicted holds.
    virtual void forget() {}

    // Bring what is in `bodies` to the end of the last drift. A solver that works on its own copy
    // does it only when asked, so that a tick in which nothing happens costs nothing, and who draws
    // a crowd pays for no velocities. They never change what is simulated.
    virtual void synchronise_positions(Bodies<Scalar>&) {}
    virtual void synchronise_velocities(Bodies<Scalar>&) {}
    void synchronise(Bodies<Scalar>& bodies) {
        synchronise_positions(bodies);
        synchronise_velocities(bodies);
    }
};

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_solver(const SolverChoice& choice);

}  // namespace fts::physics
