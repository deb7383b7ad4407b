#include "common/physics/world.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/physics/bodies.h"
#include "common/physics/diagnostics.h"
#include "common/physics/exponential.h"
#include "common/physics/kick.h"
#include "common/physics/periodic.h"
#include "common/physics/solver.h"

namespace fts::physics {
namespace {

// Below it velocities are written down as they are, before they are lost in tiny numbers.
constexpr double kLeastPace = 1e-6;

template <typename Scalar>
typename Model<Scalar>::Box box_of(const Vec2d& min_m, const Vec2d& max_m) {
    return {min_m.cast<Scalar>(), max_m.cast<Scalar>()};
}

template <typename Scalar>
Model<Scalar> model_of(const Scene& scene) {
    Model<Scalar> model;
    if (scene.walls) model.walls = box_of<Scalar>(scene.walls->min_m, scene.walls->max_m);
    if (scene.periodic) {
        model.periodic = box_of<Scalar>(scene.periodic->min_m, scene.periodic->max_m);
    }
    model.platform = scene.platform;
    model.restitution = static_cast<Scalar>(scene.restitution);
    return model;
}

template <typename Values>
bool all_equal(const std::vector<BodyId>& ids, const Values& values) {
    return std::all_of(ids.begin(), ids.end(),
                       [&](BodyId id) { return values[id.index] == values[ids.front().index]; });
}

}  // namespace

template <typename Scalar>
struct World<Scalar>::Impl {
    explicit Impl(const Scene& scene, const SolverChoice& choice)
        : rules(scene), model(model_of<Scalar>(scene)), solver(make_solver<Scalar>(choice)) {
        rules.bodies.clear();
        for (const BodyDef& body : scene.bodies) put(body);
    }

    Scene rules;  // the scene without its bodies
    Model<Scalar> model;
    Bodies<Scalar> bodies;
    Record<Scalar> record;
    std::unique_ptr<Solver<Scalar>> solver;
    bool anything_thrusts = false;
    bool changed = true;  // by others than the solver, since the last drift
    // What the scene's drag has left of the velocities that the solver has.
    double pace = 1.0;

    BodyId put(const BodyDef& body) {
        to_be_changed();
        Vec2<Scalar> position_m = body.position_m.cast<Scalar>();
        if (model.periodic) position_m = wrapped<Scalar>(position_m, *model.periodic);
        return bodies.add(position_m, body.velocity_mps.cast<Scalar>(),
                          static_cast<Scalar>(body.radius_m), static_cast<Scalar>(body.mass_kg));
    }

    Bodies<Scalar>& current() {
        solver->synchronise(bodies);
        return bodies;
    }
    const Bodies<Scalar>& with_current_positions() {
        solver->synchronise_positions(bodies);
        return bodies;
    }
    // With true velocities.
    Bodies<Scalar>& to_be_changed() {
        changed = true;
        current();
        if (pace != 1.0) slow_down(bodies);
        pace = 1.0;
        return bodies;
    }
    void slow_down(Bodies<Scalar>& all) const {
        for (const BodyId id : all.ids) all.velocity_mps[id.index] *= static_cast<Scalar>(pace);
    }

    DriftReport<Scalar> drift(Scalar span_s) {
        if (changed) look_again();
        return solver->drift(bodies, model, span_s, record);
    }
    void look_again() {
        solver->forget();
        model.equal_radii = all_equal(bodies.ids, bodies.radius_m);
        model.equal_masses =
            all_equal(bodies.ids, bodies.mass_kg) &&
            (bodies.ids.empty() || std::isfinite(bodies.mass_kg[bodies.ids.front().index]));
        changed = false;
    }

    void kick_for(Scalar span_s) {
        const auto drag_per_s = static_cast<Scalar>(rules.drag_per_s);
        anything_thrusts = kick(to_be_changed(), drag_per_s, span_s);
    }

    DriftReport<Scalar> step_with_thrust(Scalar span_s);
    DriftReport<Scalar> step_with_drag(Scalar span_s);
};

template <typename Scalar>
DriftReport<Scalar> World<Scalar>::Impl::step_with_thrust(Scalar span_s) {
    const Scalar half_s = Scalar(0.5) * span_s;
    kick_for(half_s);
    const DriftReport<Scalar> report = drift(span_s);
    kick_for(std::max(Scalar(0), half_s - report.unspent_time_s));
    return report;
}

// In the slower time s, in which drag is not felt, and with velocities as they were when the drag
// began to act: so that nothing changes for the solver, and what it predicted holds.
template <typename Scalar>
DriftReport<Scalar> World<Scalar>::Impl::step_with_drag(Scalar span_s) {
    const double drag_per_s = rules.drag_per_s, pace_before = pace;
    const auto slow_time_of = [&](Scalar passed_s) {
        const auto seconds = static_cast<double>(passed_s);
        return static_cast<Scalar>(seconds * decay(drag_per_s * seconds).mean * pace_before);
    };
    const auto time_of = [&](Scalar slow_s) {
        const double felt_s = static_cast<double>(slow_s) / pace_before;
        const double lost = std::clamp(drag_per_s * felt_s, 0.0, 1.0);
        return std::min(static_cast<Scalar>(span_of_decay(lost) / drag_per_s), span_s);
    };
    const auto pace_at = [&](Scalar passed_s) {
        return pace_before * decay(drag_per_s * static_cast<double>(passed_s)).factor;
    };
    const CollisionAudit audit_before = record.audit;
    const Scalar slow_span_s = slow_time_of(span_s);
    DriftReport<Scalar> report = drift(slow_span_s);
    if (report.overrun) {
        report.unspent_time_s = span_s - time_of(slow_span_s - report.unspent_time_s);
    }
    pace = pace_at(span_s - report.unspent_time_s);
    for (Contact<Scalar>& contact : record.contacts) {
        contact.time_s = time_of(contact.time_s);
        const auto pace_then = static_cast<Scalar>(pace_at(contact.time_s));
        contact.impulse_ns *= pace_then;
        contact.velocity_a_before_mps *= pace_then;
        contact.velocity_a_after_mps *= pace_then;
        contact.velocity_b_before_mps *= pace_then;
        contact.velocity_b_after_mps *= pace_then;
    }
    for (Fall<Scalar>& fall : record.falls) {
        fall.time_s = time_of(fall.time_s);
        fall.velocity_mps *= static_cast<Scalar>(pace_at(fall.time_s));
    }
    const auto tell_true_energy = [&](double& sum_j, double before_j) {
        sum_j = before_j + (sum_j - before_j) * pace_before * pace_before;
    };
    tell_true_energy(record.audit.energy_change_j, audit_before.energy_change_j);
    tell_true_energy(record.audit.energy_seen_j, audit_before.energy_seen_j);
    if (pace < kLeastPace) to_be_changed();
    return report;
}

template <typename Scalar>
World<Scalar>::World(const Scene& scene, const SolverChoice& solver)
    : impl_(std::make_unique<Impl>(scene, solver)) {
    assert(!validate(scene, Overlaps::kAccepted));
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
    impl_->record.begin_step();
    const DriftReport<Scalar> report =
        impl_->anything_thrusts         ? impl_->step_with_thrust(tick_duration_s)
        : impl_->rules.drag_per_s > 0.0 ? impl_->step_with_drag(tick_duration_s)
                                        : impl_->drift(tick_duration_s);
    return {report.events, report.overrun, static_cast<double>(report.unspent_time_s)};
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
    impl_->to_be_changed().remove(id.index);
    return true;
}

template <typename Scalar>
bool World<Scalar>::contains(BodyId id) const {
    return impl_->bodies.contains(id);
}

template <typename Scalar>
BodyView<Scalar> World<Scalar>::body(BodyId id) const {
    assert(contains(id));
    const Bodies<Scalar>& all = impl_->current();
    return {id, all.position_m[id.index],
            all.velocity_mps[id.index] * static_cast<Scalar>(impl_->pace), all.radius_m[id.index],
            all.mass_kg[id.index]};
}

template <typename Scalar>
Vec2<Scalar> World<Scalar>::position_m(BodyId id) const {
    assert(contains(id));
    return impl_->with_current_positions().position_m[id.index];
}

template <typename Scalar>
void World<Scalar>::set_control(BodyId id, const Control<Scalar>& control) {
    assert(contains(id));
    assert(control.acceleration_mps2.allFinite());
    assert(std::isfinite(control.drag_per_s) && control.drag_per_s >= Scalar(0));
    impl_->bodies.control[id.index] = control;
    impl_->anything_thrusts = impl_->anything_thrusts || control.acts();
}

template <typename Scalar>
void World<Scalar>::set_mass(BodyId id, Scalar mass_kg) {
    assert(contains(id));
    assert(mass_kg > Scalar(0));
    impl_->to_be_changed().mass_kg[id.index] = mass_kg;
}

template <typename Scalar>
void World<Scalar>::set_velocity(BodyId id, const Vec2<Scalar>& velocity_mps) {
    assert(contains(id));
    assert(velocity_mps.allFinite());
    impl_->to_be_changed().velocity_mps[id.index] = velocity_mps;
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
    const Bodies<Scalar>& all = impl_->with_current_positions();
    return std::all_of(all.ids.begin(), all.ids.end(), [&](BodyId id) {
        const Scalar reach = radius_m + all.radius_m[id.index];
        const Vec2<Scalar> separation =
            nearest_image<Scalar>(position_m - all.position_m[id.index], impl_->model.periodic);
        return separation.norm() >= reach * (Scalar(1) - kTolerance);
    });
}

template <typename Scalar>
const CollisionAudit& World<Scalar>::audit() const {
    return impl_->record.audit;
}

template <typename Scalar>
std::uint64_t World<Scalar>::state_hash() const {
    if (impl_->pace == 1.0) return physics::state_hash(impl_->current());
    Bodies<Scalar> slowed = impl_->current();
    impl_->slow_down(slowed);
    return physics::state_hash(slowed);
}

template <typename Scalar>
double World<Scalar>::kinetic_energy_j() const {
    return physics::kinetic_energy_j(impl_->current()) * impl_->pace * impl_->pace;
}

template <typename Scalar>
Vec2d World<Scalar>::momentum_ns() const {
    return physics::momentum_ns(impl_->current()) * impl_->pace;
}

template <typename Scalar>
double World<Scalar>::deepest_overlap() const {
    return physics::deepest_overlap(impl_->with_current_positions(), impl_->model);
}

template class World<double>;
template class World<float>;

}  // namespace fts::physics
