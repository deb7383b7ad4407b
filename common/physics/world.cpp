#include "common/physics/world.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/physics/bodies.h"
#include "common/physics/diagnostics.h"
#include "common/physics/kick.h"
#include "common/physics/solver_swept.h"

namespace fts::physics {
namespace {

template <typename Scalar>
Boundary<Scalar> boundary_of(const Scene& scene) {
    Boundary<Scalar> boundary;
    if (scene.walls) {
        boundary.walls = {scene.walls->min_m.cast<Scalar>(), scene.walls->max_m.cast<Scalar>()};
    }
    boundary.platform = scene.platform;
    boundary.restitution = static_cast<Scalar>(scene.restitution);
    return boundary;
}

}  // namespace

template <typename Scalar>
struct World<Scalar>::Impl {
    Scene rules;  // the scene without its bodies
    Boundary<Scalar> boundary;
    Bodies<Scalar> bodies;
    Record<Scalar> record;
    std::unique_ptr<Solver<Scalar>> solver = make_swept_solver<Scalar>();
    bool anything_accelerates = false;

    BodyId put(const BodyDef& body) {
        return bodies.add(body.position_m.cast<Scalar>(), body.velocity_mps.cast<Scalar>(),
                          static_cast<Scalar>(body.radius_m), static_cast<Scalar>(body.mass_kg));
    }

    void kick_if_anything_accelerates(Scalar span_s) {
        if (anything_accelerates) anything_accelerates = kick(bodies, span_s);
    }
};

template <typename Scalar>
World<Scalar>::World(const Scene& scene) : impl_(std::make_unique<Impl>()) {
    assert(!validate(scene));
    impl_->rules = scene;
    impl_->rules.bodies.clear();
    impl_->boundary = boundary_of<Scalar>(scene);
    for (const BodyDef& body : scene.bodies) impl_->put(body);
}

template <typename Scalar>
World<Scalar>::~World() = default;
template <typename Scalar>
World<Scalar>::World(World&&) noexcept = default;
template <typename Scalar>
World<Scalar>& World<Scalar>::operator=(World&&) noexcept = default;

template <typename Scalar>
StepReport World<Scalar>::step(Scalar tick_duration_s) {
    assert(std::isfinite(tick_duration_s) && tick_duration_s >= Scalar(0));
    const Scalar half_s = Scalar(0.5) * tick_duration_s;
    impl_->record.begin_step();
    impl_->kick_if_anything_accelerates(half_s);
    const DriftReport<Scalar> drift =
        impl_->solver->drift(impl_->bodies, impl_->boundary, tick_duration_s, impl_->record);
    impl_->kick_if_anything_accelerates(std::max(Scalar(0), half_s - drift.unspent_time_s));
    return {drift.events, drift.overrun, static_cast<double>(drift.unspent_time_s)};
}

template <typename Scalar>
std::optional<BodyId> World<Scalar>::add(const BodyDef& body) {
    if (impl_->bodies.ids.size() >= kMaxBodies) return std::nullopt;
    if (validate(body, impl_->rules, "body")) return std::nullopt;
    if (!is_free(body.position_m.cast<Scalar>(), static_cast<Scalar>(body.radius_m))) {
        return std::nullopt;
    }
    return impl_->put(body);
}

template <typename Scalar>
bool World<Scalar>::remove(BodyId id) {
    if (!contains(id)) return false;
    impl_->bodies.remove(id.index);
    return true;
}

template <typename Scalar>
bool World<Scalar>::contains(BodyId id) const {
    return impl_->bodies.contains(id);
}

template <typename Scalar>
BodyView<Scalar> World<Scalar>::body(BodyId id) const {
    assert(contains(id));
    const Bodies<Scalar>& all = impl_->bodies;
    return {id, all.position_m[id.index], all.velocity_mps[id.index], all.radius_m[id.index],
            all.mass_kg[id.index]};
}

template <typename Scalar>
void World<Scalar>::set_control(BodyId id, const Control<Scalar>& control) {
    assert(contains(id));
    assert(control.acceleration_mps2.allFinite());
    assert(std::isfinite(control.drag_per_s) && control.drag_per_s >= Scalar(0));
    impl_->bodies.control[id.index] = control;
    impl_->anything_accelerates = impl_->anything_accelerates || control.acts();
}

template <typename Scalar>
void World<Scalar>::set_mass(BodyId id, Scalar mass_kg) {
    assert(contains(id));
    assert(mass_kg > Scalar(0));
    impl_->bodies.mass_kg[id.index] = mass_kg;
}

template <typename Scalar>
void World<Scalar>::set_velocity(BodyId id, const Vec2<Scalar>& velocity_mps) {
    assert(contains(id));
    assert(velocity_mps.allFinite());
    impl_->bodies.velocity_mps[id.index] = velocity_mps;
}

template <typename Scalar>
std::size_t World<Scalar>::size() const {
    return impl_->bodies.ids.size();
}

template <typename Scalar>
std::span<const BodyId> World<Scalar>::ids() const {
    return impl_->bodies.ids;
}

template <typename Scalar>
std::span<const Contact<Scalar>> World<Scalar>::contacts() const {
    return impl_->record.contacts;
}

template <typename Scalar>
std::span<const Fall<Scalar>> World<Scalar>::falls() const {
    return impl_->record.falls;
}

template <typename Scalar>
bool World<Scalar>::is_free(const Vec2<Scalar>& position_m, Scalar radius_m) const {
    constexpr Scalar kTolerance =
        std::max(static_cast<Scalar>(kTouchTolerance), 16 * std::numeric_limits<Scalar>::epsilon());
    const Bodies<Scalar>& all = impl_->bodies;
    return std::all_of(all.ids.begin(), all.ids.end(), [&](BodyId id) {
        const Scalar reach = radius_m + all.radius_m[id.index];
        const Scalar distance = (position_m - all.position_m[id.index]).norm();
        return distance >= reach * (Scalar(1) - kTolerance);
    });
}

template <typename Scalar>
const CollisionAudit& World<Scalar>::audit() const {
    return impl_->record.audit;
}

template <typename Scalar>
std::uint64_t World<Scalar>::state_hash() const {
    return physics::state_hash(impl_->bodies);
}

template <typename Scalar>
double World<Scalar>::kinetic_energy_j() const {
    return physics::kinetic_energy_j(impl_->bodies);
}

template <typename Scalar>
Vec2d World<Scalar>::momentum_ns() const {
    return physics::momentum_ns(impl_->bodies);
}

template class World<double>;
template class World<float>;

}  // namespace fts::physics
