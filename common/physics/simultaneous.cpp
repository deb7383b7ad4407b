#include "common/physics/simultaneous.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/physics/impact.h"

namespace fts::physics {
namespace {

constexpr std::uint32_t kSides = 4;
// Of single precision, in which kTouchTolerance is less than round-off.
constexpr int kTouchRoundOff = 16;
// By how many units of round-off the places of two bodies are uncertain.
constexpr int kPlaceRoundOff = 8;

template <typename Scalar>
Vec2<Scalar> inward_normal(std::uint32_t side) {
    Vec2<Scalar> normal = Vec2<Scalar>::Zero();
    normal[side / 2] = side % 2 == 0 ? Scalar(1) : Scalar(-1);
    return normal;
}

}  // namespace

template <typename Scalar>
Scalar touch_tolerance_m(Scalar reach_m, Scalar extent_m) {
    constexpr Scalar kEpsilon = std::numeric_limits<Scalar>::epsilon();
    constexpr Scalar kRelative =
        std::max(static_cast<Scalar>(kTouchTolerance), kTouchRoundOff * kEpsilon);
    return kRelative * reach_m + kPlaceRoundOff * kEpsilon * extent_m;
}

template <typename Scalar>
void ContactSet<Scalar>::begin(std::uint32_t slots) {
    for (const Member& member : members_) member_of_[member.body] = kNone;
    if (member_of_.size() < slots) member_of_.resize(slots, kNone);
    members_.clear();
    contacts_.clear();
    due_.clear();
    to_look_.clear();
    looked_ = 0;
    hit_bodies_.clear();
}

template <typename Scalar>
void ContactSet<Scalar>::add(std::uint32_t body, const Vec& velocity_mps, Scalar mass_kg,
                             bool elastic) {
    assert(body < member_of_.size());
    if (member_of_[body] != kNone) return;
    member_of_[body] = static_cast<std::uint32_t>(members_.size());
    Member member;
    member.body = body;
    member.velocity_mps = velocity_mps;
    member.mass_kg = mass_kg;
    member.speed_scale_mps = velocity_mps.norm();
    member.elastic = elastic;
    member.is_immovable = std::isinf(mass_kg);
    members_.push_back(member);
}

template <typename Scalar>
void ContactSet<Scalar>::touch(std::uint32_t a, std::uint32_t b, const Vec& separation_m) {
    Touch touch;
    touch.a = index_of(a);
    touch.b = index_of(b);
    if (members_[touch.a].is_immovable && members_[touch.b].is_immovable) return;
    if (find(touch.a, touch.b, 0) != kNone) return;
    assert(separation_m.squaredNorm() > Scalar(0));
    touch.separation_m = separation_m;
    touch.normal = separation_m / separation_m.norm();
    link(touch);
}

template <typename Scalar>
void ContactSet<Scalar>::touch_wall(std::uint32_t body, std::uint32_t side) {
    assert(side < kSides);
    Touch touch;
    touch.a = index_of(body);
    touch.b = kNone;
    touch.side = side;
    if (members_[touch.a].is_immovable || find(touch.a, kNone, side) != kNone) return;
    touch.separation_m = Vec::Zero();
    touch.normal = inward_normal<Scalar>(side);
    link(touch);
}

template <typename Scalar>
void ContactSet<Scalar>::link(const Touch& touch) {
    const auto contact = static_cast<std::uint32_t>(contacts_.size());
    contacts_.push_back(touch);
    contacts_.back().next_a = std::exchange(members_[touch.a].first_contact, contact);
    contacts_.back().next_b =
        touch.b == kNone ? kNone : std::exchange(members_[touch.b].first_contact, contact);
    make_due(contact);
}

template <typename Scalar>
void ContactSet<Scalar>::make_due(std::uint32_t contact) {
    if (contacts_[contact].is_due) return;
    contacts_[contact].is_due = true;
    due_.push_back(contact);
}

template <typename Scalar>
std::uint32_t ContactSet<Scalar>::index_of(std::uint32_t body) const {
    assert(holds(body));
    return member_of_[body];
}

template <typename Scalar>
bool ContactSet<Scalar>::holds(std::uint32_t body) const {
    return body < member_of_.size() && member_of_[body] != kNone;
}

template <typename Scalar>
std::uint32_t ContactSet<Scalar>::next_of(std::uint32_t contact, std::uint32_t member) const {
    return contacts_[contact].a == member ? contacts_[contact].next_a : contacts_[contact].next_b;
}

template <typename Scalar>
std::uint32_t ContactSet<Scalar>::find(std::uint32_t a, std::uint32_t b, std::uint32_t side) const {
    // An immovable body may be touched by very many.
    const std::uint32_t from = members_[a].is_immovable ? b : a;
    for (std::uint32_t i = members_[from].first_contact; i != kNone; i = next_of(i, from)) {
        const Touch& touch = contacts_[i];
        const bool same_pair = (touch.a == a && touch.b == b) || (touch.a == b && touch.b == a);
        if (same_pair && touch.side == side) return i;
    }
    return kNone;
}

template <typename Scalar>
const Vec2<Scalar>& ContactSet<Scalar>::velocity_mps(std::uint32_t body) const {
    return members_[index_of(body)].velocity_mps;
}

template <typename Scalar>
bool ContactSet<Scalar>::was_hit(std::uint32_t body) const {
    return holds(body) && members_[member_of_[body]].was_hit;
}

template <typename Scalar>
bool ContactSet<Scalar>::keeps_apart(std::uint32_t a, std::uint32_t b,
                                     const Vec& separation_m) const {
    if (!holds(a) || !holds(b)) return false;
    const std::uint32_t contact = find(member_of_[a], member_of_[b], 0);
    if (contact == kNone) return false;
    const Touch& touch = contacts_[contact];
    // Another image of the pair is further off than that.
    const bool same_way_round = touch.a == member_of_[a];
    const Vec moved = separation_m - (same_way_round ? Scalar(1) : Scalar(-1)) * touch.separation_m;
    return moved.squaredNorm() < Scalar(0.25) * touch.separation_m.squaredNorm() &&
           !approaches(touch);
}

template <typename Scalar>
bool ContactSet<Scalar>::keeps_off_wall(std::uint32_t body, std::uint32_t side) const {
    if (!holds(body)) return false;
    const std::uint32_t contact = find(member_of_[body], kNone, side);
    return contact != kNone && !approaches(contacts_[contact]);
}

template <typename Scalar>
Scalar ContactSet<Scalar>::approach_mps(const Touch& touch) const {
    const Vec& velocity = members_[touch.a].velocity_mps;
    if (touch.b == kNone) return velocity.dot(touch.normal);
    return (velocity - members_[touch.b].velocity_mps).dot(touch.normal);
}

template <typename Scalar>
bool ContactSet<Scalar>::approaches(const Touch& touch) const {
    constexpr Scalar kNoise =
        static_cast<Scalar>(kApproachRoundOff) * std::numeric_limits<Scalar>::epsilon();
    const Scalar scale = members_[touch.a].speed_scale_mps +
                         (touch.b == kNone ? Scalar(0) : members_[touch.b].speed_scale_mps);
    return approach_mps(touch) < -kNoise * scale;
}

template <typename Scalar>
std::uint32_t ContactSet<Scalar>::root_of(std::uint32_t member) {
    while (members_[member].parent != member) {
        members_[member].parent = members_[members_[member].parent].parent;
        member = members_[member].parent;
    }
    return member;
}

// Its movable bodies are of one component from now on.
template <typename Scalar>
void ContactSet<Scalar>::join(std::uint32_t contact) {
    const Touch& touch = contacts_[contact];
    if (touch.b == kNone || members_[touch.a].is_immovable || members_[touch.b].is_immovable) {
        return;
    }
    const std::uint32_t a = root_of(touch.a), b = root_of(touch.b);
    members_[std::max(a, b)].parent = std::min(a, b);
}

// False when nothing approaches.
template <typename Scalar>
bool ContactSet<Scalar>::find_components() {
    approaching_.clear();
    for (const std::uint32_t contact : due_) {
        Touch& touch = contacts_[contact];
        touch.is_due = false;
        if (!approaches(touch)) continue;
        members_[touch.a].parent = touch.a;
        if (touch.b != kNone) members_[touch.b].parent = touch.b;
        approaching_.push_back({0, contact});
    }
    due_.clear();
    for (const Approaching& one : approaching_) join(one.contact);
    for (Approaching& one : approaching_) {
        const Touch& touch = contacts_[one.contact];
        one.component = root_of(members_[touch.a].is_immovable ? touch.b : touch.a);
    }
    std::sort(approaching_.begin(), approaching_.end());
    return !approaching_.empty();
}

template <typename Scalar>
Scalar ContactSet<Scalar>::restitution_of(std::size_t first, std::size_t last,
                                          Scalar restitution) const {
    for (std::size_t i = first; i < last; ++i) {
        const Touch& touch = contacts_[approaching_[i].contact];
        if (members_[touch.a].elastic) return Scalar(1);
        if (touch.b != kNone && members_[touch.b].elastic) return Scalar(1);
    }
    return restitution;
}

template <typename Scalar>
void ContactSet<Scalar>::reflect(std::size_t first, std::size_t last, Scalar restitution) {
    hits_.clear();
    const Scalar kept = restitution_of(first, last, restitution);
    if (last - first == 1) {
        reflect_one(contacts_[approaching_[first].contact], kept);
    } else {
        reflect_many(first, last, static_cast<double>(kept));
    }
    for (const Hit<Scalar>& hit : hits_) {
        mark_hit(member_of_[hit.a]);
        if (hit.b != kNoBody) mark_hit(member_of_[hit.b]);
    }
}

template <typename Scalar>
Hit<Scalar> ContactSet<Scalar>::hit_of(const Touch& touch, Scalar impulse_ns) const {
    const Member& a = members_[touch.a];
    Hit<Scalar> hit{a.body,         kNoBody,        touch.separation_m, touch.normal, impulse_ns,
                    a.velocity_mps, a.velocity_mps, Vec::Zero(),        Vec::Zero()};
    if (touch.b != kNone) {
        const Member& b = members_[touch.b];
        hit.b = b.body;
        hit.velocity_b_before_mps = b.velocity_mps;
        hit.velocity_b_after_mps = b.velocity_mps;
    }
    return hit;
}

// `pushed_mps`: the sum of how much its contacts changed its velocity, each for itself.
template <typename Scalar>
void ContactSet<Scalar>::give(std::uint32_t index, const Vec& velocity_mps, Scalar pushed_mps) {
    Member& member = members_[index];
    member.velocity_mps = velocity_mps;
    member.speed_scale_mps = std::max({member.speed_scale_mps, velocity_mps.norm(), pushed_mps});
    for (std::uint32_t i = member.first_contact; i != kNone; i = next_of(i, index)) make_due(i);
}

template <typename Scalar>
void ContactSet<Scalar>::mark_hit(std::uint32_t index) {
    Member& member = members_[index];
    member.elastic = true;
    if (member.was_hit) return;
    member.was_hit = true;
    hit_bodies_.push_back(member.body);
    to_look_.push_back(index);
}

template <typename Scalar>
void ContactSet<Scalar>::reflect_one(const Touch& touch, Scalar restitution) {
    const Member& a = members_[touch.a];
    Hit<Scalar> hit = hit_of(touch, Scalar(0));
    if (touch.b == kNone) {
        const std::uint32_t axis = touch.side / 2;
        hit.velocity_a_after_mps[axis] *= -restitution;
        const Vec change = hit.velocity_a_after_mps - hit.velocity_a_before_mps;
        hit.impulse_ns = a.mass_kg * std::abs(change[axis]);
    } else {
        const Member& b = members_[touch.b];
        const auto done = impact<Scalar>({touch.separation_m, a.velocity_mps, a.mass_kg},
                                         {Vec::Zero(), b.velocity_mps, b.mass_kg}, restitution);
        if (!done) return;
        hit.impulse_ns = done->impulse_ns;
        hit.velocity_a_after_mps = done->velocity_1_mps;
        hit.velocity_b_after_mps = done->velocity_2_mps;
        if (!b.is_immovable) give(touch.b, done->velocity_2_mps, Scalar(0));
    }
    if (!a.is_immovable) give(touch.a, hit.velocity_a_after_mps, Scalar(0));
    hits_.push_back(hit);
}

// The component [first, last) of approaching_, as `projection_` sees it.
template <typename Scalar>
void ContactSet<Scalar>::project(std::size_t first, std::size_t last) {
    projection_.begin();
    projected_.clear();
    const auto place = [&](std::uint32_t index) {
        if (index == kNone || members_[index].is_immovable) return ConeProjection::kFixed;
        Member& member = members_[index];
        if (member.in_projection == kNone) {
            member.in_projection = static_cast<std::uint32_t>(projected_.size());
            projected_.push_back({index, Vec2d::Zero(), 0.0});
            projection_.add_body(1.0 / static_cast<double>(member.mass_kg));
        }
        return member.in_projection;
    };
    for (std::size_t i = first; i < last; ++i) {
        const Touch& touch = contacts_[approaching_[i].contact];
        const std::uint32_t a = place(touch.a);
        projection_.add_contact(a, place(touch.b), touch.normal.template cast<double>(),
                                static_cast<double>(approach_mps(touch)));
    }
}

template <typename Scalar>
void ContactSet<Scalar>::push(std::uint32_t index, double impulse_ns, const Vec2d& normal) {
    if (index == kNone || members_[index].is_immovable) return;
    Projected& projected = projected_[members_[index].in_projection];
    projected.push_ns += impulse_ns * normal;
    projected.pushed_ns += impulse_ns;
}

template <typename Scalar>
void ContactSet<Scalar>::reflect_many(std::size_t first, std::size_t last, double restitution) {
    project(first, last);
    const std::span<const double> impulses_ns = projection_.solve();
    double gained = 0.0;  // lambda . N^T v
    for (std::size_t i = first; i < last; ++i) {
        const double impulse = impulses_ns[i - first];
        const Touch& touch = contacts_[approaching_[i].contact];
        const Vec2d normal = touch.normal.template cast<double>();
        gained += impulse * static_cast<double>(approach_mps(touch));
        push(touch.a, impulse, normal);
        push(touch.b, impulse, -normal);
    }
    double moved = 0.0;  // |v' - v|_M^2
    for (const Projected& one : projected_) {
        moved += one.push_ns.squaredNorm() / static_cast<double>(members_[one.member].mass_kg);
    }
    const double step = (1.0 + restitution) * (-gained / moved);
    if (step > 0.0 && std::isfinite(step)) {
        for (std::size_t i = first; i < last; ++i) {
            const auto impulse = static_cast<Scalar>(step * impulses_ns[i - first]);
            if (!(impulse > Scalar(0))) continue;
            hits_.push_back(hit_of(contacts_[approaching_[i].contact], impulse));
        }
    }
    for (const Projected& one : projected_) {
        members_[one.member].in_projection = kNone;
        if (!hits_.empty()) move_on(one, step);
    }
    for (Hit<Scalar>& hit : hits_) {
        hit.velocity_a_after_mps = velocity_mps(hit.a);
        if (hit.b != kNoBody) hit.velocity_b_after_mps = velocity_mps(hit.b);
    }
}

template <typename Scalar>
void ContactSet<Scalar>::move_on(const Projected& projected, double step) {
    if (!(projected.pushed_ns > 0.0)) return;
    const Member& member = members_[projected.member];
    const double per_kg = step / static_cast<double>(member.mass_kg);
    const Vec2d after = member.velocity_mps.template cast<double>() + per_kg * projected.push_ns;
    give(projected.member, after.template cast<Scalar>(),
         static_cast<Scalar>(per_kg * projected.pushed_ns));
}

template <typename Scalar>
void ContactSet<Scalar>::everybody_looks() {
    for (std::uint32_t i = 0; i < members_.size(); ++i) to_look_.push_back(i);
}

// The body of the next member that has not looked around; kNoBody when all have.
template <typename Scalar>
std::uint32_t ContactSet<Scalar>::who_looks_next() {
    while (looked_ < to_look_.size()) {
        Member& member = members_[to_look_[looked_++]];
        if (member.has_looked || member.is_immovable) continue;
        member.has_looked = true;
        return member.body;
    }
    return kNoBody;
}

template double touch_tolerance_m(double, double);
template float touch_tolerance_m(float, float);
template class ContactSet<double>;
template class ContactSet<float>;

}  // namespace fts::physics
