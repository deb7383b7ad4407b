#include <algorithm>
#include <cmath>
#include <limits>

#include "common/physics/diagnostics.h"
#include "common/physics/hit_record.h"
#include "common/physics/impact.h"
#include "common/physics/solver_swept.h"
#include "common/physics/swept_engine.h"

namespace fts::physics {
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::process(const Happening& event) {
    switch (event.kind) {
        case EventKind::kBall:
            return collide_pair(event);
        case EventKind::kWall:
            return collide_wall(event);
        case EventKind::kFall:
            return fall(event.a);
    }
}

// A grazing pair may turn out, to the last bit, not to approach any more; then nothing happens.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::collide_pair(const Happening& event) {
    Bodies<Scalar>& all = *bodies_;
    const std::uint32_t a = event.a, b = event.b;
    const Vec approach = all.velocity_mps[a] - all.velocity_mps[b];
    if (!(separation_now(a, b, event.image).dot(approach) < Scalar(0))) return;
    move_to(a, now_s_);
    move_to(b, now_s_);
    touch(a, b, event.image);
    const Mover<Scalar> first{space_.moved(all.position_m[a], event.image), all.velocity_mps[a],
                              all.mass_kg[a]};
    const Mover<Scalar> second{all.position_m[b], all.velocity_mps[b], all.mass_kg[b]};
    const auto hit = impact(first, second, restitution_of(was_just_hit(a) || was_just_hit(b)));
    const bool looked_ahead = look_ahead(event, hit);
    if (!looked_ahead && is_touched_by_others(event)) return collide_set(event);
    if (hit) {
        const auto [at_a, at_b] = space_.shown(all.position_m[a], all.position_m[b], event.image);
        const Scalar distance = (first.position_m - second.position_m).norm();
        all.velocity_mps[a] = hit->velocity_1_mps;
        all.velocity_mps[b] = hit->velocity_2_mps;
        record_->contacts.push_back(
            {all.id_of(a), all.id_of(b), now_s_, at_a - all.radius_m[a] * hit->normal, hit->normal,
             hit->impulse_ns, at_a, at_b, first.velocity_mps, hit->velocity_1_mps,
             second.velocity_mps, hit->velocity_2_mps, first.mass_kg, second.mass_kg,
             penetration(distance, all.radius_m[a], all.radius_m[b])});
    }
    after_event(a, {b, event.image});
    after_event(b, {a, event.image});
    if (looked_ahead) {
        follow_and_predict(a, b);
    } else {
        place_and_predict(a);
        place_and_predict(b);
    }
    if (hit) account(record_->contacts.back(), record_->audit);  // by now it is in memory
    count(1, 1);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::collide_wall(const Happening& event) {
    Bodies<Scalar>& all = *bodies_;
    const std::uint32_t body = event.a, axis = event.b / 2;
    const bool at_max = event.b % 2 == 1;
    move_to(body, now_s_);
    const Scalar radius = all.radius_m[body];
    Vec& position = all.position_m[body];
    position[axis] =
        at_max ? model_->walls->max_m[axis] - radius : model_->walls->min_m[axis] + radius;
    if (is_touched_by_others(event)) return collide_set(event);
    Vec& velocity = all.velocity_mps[body];
    const Vec before = velocity;
    velocity[axis] *= -restitution_of(was_just_hit(body));
    Vec normal = Vec::Zero();
    normal[axis] = at_max ? Scalar(-1) : Scalar(1);
    const Scalar impulse = all.mass_kg[body] * std::abs(velocity[axis] - before[axis]);
    record_->contacts.push_back({all.id_of(body), std::nullopt, now_s_, position - radius * normal,
                                 normal, impulse, position, position - radius * normal, before,
                                 velocity, Vec::Zero(), Vec::Zero(), all.mass_kg[body],
                                 std::numeric_limits<Scalar>::infinity()});
    account(record_->contacts.back(), record_->audit);
    after_event(body, {});
    place_and_predict(body);
    count(1, 1);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::fall(std::uint32_t body) {
    move_to(body, now_s_);
    record_->falls.push_back(
        {bodies_->id_of(body), now_s_, bodies_->position_m[body], bodies_->velocity_mps[body]});
    bodies_->remove(body);
    paths_.remove(body);
    after_event(body, {});
    count(1, 1);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::touch(std::uint32_t a, std::uint32_t b, Image image) {
    Bodies<Scalar>& all = *bodies_;
    const Vec d = space_.moved(all.position_m[a], image) - all.position_m[b];
    const Scalar distance = d.norm();
    const Scalar closing = -d.dot(all.velocity_mps[a] - all.velocity_mps[b]) / distance;
    const Scalar slack =
        static_cast<Scalar>(kClockSlack) * std::numeric_limits<Scalar>::epsilon() * span_s_;
    const Scalar gap = distance - (all.radius_m[a] + all.radius_m[b]);
    if (!(std::abs(gap) <= closing * slack)) return;
    const Scalar wait = gap / closing;
    all.position_m[a] += all.velocity_mps[a] * wait;
    all.position_m[b] += all.velocity_mps[b] * wait;
}

template void SweptEngine<double, OpenSpace<double>>::process(const Happening&);
template void SweptEngine<float, OpenSpace<float>>::process(const Happening&);
template void SweptEngine<double, TorusSpace<double>>::process(const Happening&);
template void SweptEngine<float, TorusSpace<float>>::process(const Happening&);

}  // namespace fts::physics
