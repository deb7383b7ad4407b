#include "common/physics/crowd_copy.h"

#include <algorithm>
#include <utility>

namespace fts::physics {

template <typename Scalar>
auto CrowdCopy<Scalar>::gather(const Bodies<Scalar>& bodies, const Model<Scalar>& model) -> Same {
    Same same = {holds_just(bodies), false, false};
    if (!same.bodies) take_in_order_of_ids(bodies);
    same.positions = gather_motion(bodies) && same.bodies;
    same.radii = gather_radii(bodies, model.equal_radii);
    inverse_mass_per_kg.clear();
    if (!model.equal_masses) {
        for (const BodyId body : id) {
            inverse_mass_per_kg.push_back(Scalar(1) / bodies.mass_kg[body.index]);
        }
    }
    positions_ahead_ = velocities_ahead_ = false;
    return same;
}

// What was changed is most often velocities alone; then the order in memory is still good.
template <typename Scalar>
bool CrowdCopy<Scalar>::holds_just(const Bodies<Scalar>& bodies) const {
    if (id.empty() || bodies.ids.size() != id.size() || bodies.slots() != slots()) return false;
    return std::all_of(id.begin(), id.end(), [&](BodyId body) { return bodies.contains(body); });
}

template <typename Scalar>
void CrowdCopy<Scalar>::take_in_order_of_ids(const Bodies<Scalar>& bodies) {
    id.clear();
    to_slots_.forget();
    place_.resize(bodies.slots());
    for (const BodyId body : bodies.ids) {
        place_[body.index] = count();
        id.push_back(body);
    }
}

template <typename Scalar>
bool CrowdCopy<Scalar>::gather_motion(const Bodies<Scalar>& bodies) {
    for (auto* values : {&x_m, &y_m, &vx_mps, &vy_mps}) values->resize(id.size());
    bool same_positions = true;
    for (std::uint32_t i = 0; i < count(); ++i) {
        const Vec2<Scalar>&position = bodies.position_m[id[i].index],
              &velocity = bodies.velocity_mps[id[i].index];
        same_positions &= x_m[i] == position.x() && y_m[i] == position.y();
        x_m[i] = position.x();
        y_m[i] = position.y();
        vx_mps[i] = velocity.x();
        vy_mps[i] = velocity.y();
    }
    return same_positions;
}

template <typename Scalar>
bool CrowdCopy<Scalar>::gather_radii(const Bodies<Scalar>& bodies, bool are_equal) {
    const bool were_equal = radius_m.empty();
    const Scalar largest_before = largest_radius_m;
    largest_radius_m = id.empty() ? Scalar(0) : bodies.radius_m[id.front().index];
    if (are_equal) {
        radius_m.clear();
        return were_equal && largest_radius_m == largest_before;
    }
    bool same = radius_m.size() == id.size();
    radius_m.resize(id.size());
    for (std::uint32_t i = 0; i < count(); ++i) {
        const Scalar radius = bodies.radius_m[id[i].index];
        same &= radius_m[i] == radius;
        radius_m[i] = radius;
        largest_radius_m = std::max(largest_radius_m, radius);
    }
    return same;
}

template <typename Scalar>
void CrowdCopy<Scalar>::write_positions(Bodies<Scalar>& bodies) {
    if (std::exchange(positions_ahead_, false)) to_slots_.write(id, x_m, y_m, bodies.position_m);
}

template <typename Scalar>
void CrowdCopy<Scalar>::write_velocities(Bodies<Scalar>& bodies) {
    if (std::exchange(velocities_ahead_, false)) {
        to_slots_.write(id, vx_mps, vy_mps, bodies.velocity_mps);
    }
}

template <typename Scalar>
void CrowdCopy<Scalar>::reorder(const RoomyVector<std::uint32_t>& order) {
    for (auto* values : {&x_m, &y_m, &vx_mps, &vy_mps, &radius_m, &inverse_mass_per_kg}) {
        if (values->empty()) continue;
        old_.swap(*values);
        values->clear();
        for (const std::uint32_t from : order) values->push_back(old_[from]);
    }
    old_id_.swap(id);
    id.clear();
    to_slots_.forget();
    for (const std::uint32_t from : order) {
        place_[old_id_[from].index] = count();
        id.push_back(old_id_[from]);
    }
}

template <typename Scalar>
void CrowdCopy<Scalar>::remove(std::uint32_t place) {
    to_slots_.forget();
    place_[id.back().index] = place;
    const auto take_from_end = [place](auto& values) {
        if (values.empty()) return;
        values[place] = values.back();
        values.pop_back();
    };
    take_from_end(id);
    for (auto* values : {&x_m, &y_m, &vx_mps, &vy_mps, &radius_m, &inverse_mass_per_kg}) {
        take_from_end(*values);
    }
}

template class CrowdCopy<double>;
template class CrowdCopy<float>;

}  // namespace fts::physics
