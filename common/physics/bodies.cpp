#include "common/physics/bodies.h"

#include <algorithm>
#include <functional>

namespace fts::physics {

template <typename Scalar>
BodyId Bodies<Scalar>::add(const Vec2<Scalar>& position, const Vec2<Scalar>& velocity,
                           Scalar radius, Scalar mass) {
    std::uint32_t index = slots();
    if (free_slots.empty()) {
        position_m.emplace_back();
        velocity_mps.emplace_back();
        radius_m.emplace_back();
        mass_kg.emplace_back();
        control.emplace_back();
        generation.push_back(0);
        alive.push_back(0);
    } else {
        std::pop_heap(free_slots.begin(), free_slots.end(), std::greater<>());
        index = free_slots.back();
        free_slots.pop_back();
    }
    position_m[index] = position;
    velocity_mps[index] = velocity;
    radius_m[index] = radius;
    mass_kg[index] = mass;
    control[index] = Control<Scalar>();
    alive[index] = 1;
    const BodyId id = id_of(index);
    ids.insert(std::lower_bound(ids.begin(), ids.end(), id), id);
    return id;
}

template <typename Scalar>
void Bodies<Scalar>::remove(std::uint32_t index) {
    ids.erase(std::lower_bound(ids.begin(), ids.end(), id_of(index)));
    alive[index] = 0;
    ++generation[index];
    free_slots.push_back(index);
    std::push_heap(free_slots.begin(), free_slots.end(), std::greater<>());
}

template <typename Scalar>
bool Bodies<Scalar>::contains(BodyId id) const {
    return id.index < slots() && alive[id.index] != 0 && generation[id.index] == id.generation;
}

template struct Bodies<double>;
template struct Bodies<float>;

}  // namespace fts::physics
