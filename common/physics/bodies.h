// The state of all bodies as a structure of arrays, indexed by slot. A freed slot is given out
// again lowest first, with a new generation, so that a stale BodyId is never mistaken for a living
// one.
#pragma once

#include <cstdint>
#include <vector>

#include "common/physics/body.h"
#include "common/physics/roomy_vector.h"

namespace fts::physics {

template <typename Scalar>
struct Bodies {
    RoomyVector<Vec2<Scalar>> position_m;
    RoomyVector<Vec2<Scalar>> velocity_mps;
    RoomyVector<Scalar> radius_m;
    RoomyVector<Scalar> mass_kg;
    std::vector<Control<Scalar>> control;
    RoomyVector<std::uint32_t> generation;
    std::vector<std::uint8_t> alive;
    std::vector<BodyId> ids;                // of the living, ascending by index
    std::vector<std::uint32_t> free_slots;  // min-heap

    BodyId add(const Vec2<Scalar>& position, const Vec2<Scalar>& velocity, Scalar radius,
               Scalar mass);
    void remove(std::uint32_t index);
    bool contains(BodyId id) const;

    std::uint32_t slots() const { return static_cast<std::uint32_t>(alive.size()); }
    BodyId id_of(std::uint32_t index) const { return {index, generation[index]}; }
};

extern template struct Bodies<double>;
extern template struct Bodies<float>;

}  // namespace fts::physics
