// A solver's own copy of the living bodies, as a structure of arrays in an order of its own:
// places, in which neighbours are near each other in memory. The bodies themselves stay where their
// slots are and are behind until they are written to.
#pragma once

#include <cstdint>

#include "common/physics/bodies.h"
#include "common/physics/cell_grid.h"
#include "common/physics/roomy_vector.h"
#include "common/physics/slot_scatter.h"
#include "common/physics/solver.h"

namespace fts::physics {

template <typename Scalar>
class CrowdCopy {
  public:
    // By place.
    RoomyVector<Scalar> x_m, y_m, vx_mps, vy_mps;
    RoomyVector<Scalar> radius_m;             // empty when all are the largest
    RoomyVector<Scalar> inverse_mass_per_kg;  // empty when all are alike
    RoomyVector<BodyId> id;
    Scalar largest_radius_m = Scalar(0);

    // What is now as it was. While the bodies are the same, they stay in their places.
    struct Same {
        bool bodies, positions, radii;
    };
    Same gather(const Bodies<Scalar>& bodies, const Model<Scalar>& model);
    // What was gathered has changed.
    void is_ahead() { positions_ahead_ = velocities_ahead_ = true; }
    // These write nothing where nothing is ahead.
    void write_positions(Bodies<Scalar>& bodies);
    void write_velocities(Bodies<Scalar>& bodies);

    // From now on place i has what was in place order[i].
    void reorder(const RoomyVector<std::uint32_t>& order);
    // The last one takes its place.
    void remove(std::uint32_t place);

    std::uint32_t count() const { return static_cast<std::uint32_t>(id.size()); }
    std::uint32_t slots() const { return static_cast<std::uint32_t>(place_.size()); }
    std::uint32_t place_of(std::uint32_t slot) const { return place_[slot]; }
    Scalar radius_of(std::uint32_t place) const { return discs().radius_of(place); }
    Discs<Scalar> discs() const { return {x_m, y_m, radius_m, largest_radius_m}; }

  private:
    bool holds_just(const Bodies<Scalar>& bodies) const;
    void take_in_order_of_ids(const Bodies<Scalar>& bodies);
    bool gather_motion(const Bodies<Scalar>& bodies);
    bool gather_radii(const Bodies<Scalar>& bodies, bool are_equal);

    bool positions_ahead_ = false, velocities_ahead_ = false;  // of the bodies
    RoomyVector<std::uint32_t> place_;                         // by slot
    SlotScatter<Scalar> to_slots_;
    RoomyVector<Scalar> old_;
    RoomyVector<BodyId> old_id_;
};

extern template class CrowdCopy<double>;
extern template class CrowdCopy<float>;

}  // namespace fts::physics
