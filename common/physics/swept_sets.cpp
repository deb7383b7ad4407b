#include <algorithm>
#include <cmath>
#include <limits>

#include "common/physics/hit_record.h"
#include "common/physics/solver_swept.h"
#include "common/physics/swept_engine.h"

namespace fts::physics {
namespace {

// In units of the span's round-off: what is due within that is due at the same instant.
constexpr double kSameInstant = 8.0;

template <typename Scalar>
Box<Scalar> united(const Box<Scalar>& a, const Box<Scalar>& b) {
    return {std::min(a.min_x_m, b.min_x_m), std::min(a.min_y_m, b.min_y_m),
            std::max(a.max_x_m, b.max_x_m), std::max(a.max_y_m, b.max_y_m)};
}

}  // namespace

template <typename Scalar, typename Space>
auto SweptEngine<Scalar, Space>::disc_at(std::uint32_t body, const Vec& position_m) const -> Disc {
    return {body, position_m, bodies_->radius_m[body], extent_m(body)};
}

// Within this box is all that touches the disc.
template <typename Scalar, typename Space>
Box<Scalar> SweptEngine<Scalar, Space>::reach_of(const Disc& disc) const {
    const Scalar near = disc.radius_m + touch_tolerance_m(disc.radius_m, disc.extent_m);
    return {disc.position_m.x() - near, disc.position_m.y() - near, disc.position_m.x() + near,
            disc.position_m.y() + near};
}

// Or overlaps; `separation_m` is from `other` to the disc. Of two with one centre nothing can be
// said.
template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::touches(const Disc& disc, std::uint32_t other,
                                         const Vec& separation_m) const {
    const Scalar reach = disc.radius_m + bodies_->radius_m[other];
    const Scalar squared = separation_m.squaredNorm();
    const Scalar limit = reach + touch_tolerance_m(reach, std::max(disc.extent_m, extent_m(other)));
    return squared <= limit * limit && squared > Scalar(0);
}

template <typename Scalar, typename Space>
auto SweptEngine<Scalar, Space>::touching(const Disc& disc, Image image) const -> Touching {
    const Scalar reach = disc.radius_m + paths_.largest_radius_m();
    return {space_.moved(disc.position_m, image), disc.radius_m,
            touch_tolerance_m(reach, disc.extent_m)};
}

// visit(other, separation) for all that touches `body` now, lower ones first; separation from
// `other`, or an image of it, to `body`.
template <typename Scalar, typename Space>
template <typename Visit>
void SweptEngine<Scalar, Space>::for_each_touching(std::uint32_t body, Visit&& visit) {
    const Disc disc = disc_at(body, position_at(body, now_s_));
    near_.clear();
    space_.for_each_image(reach_of(disc), [&](const Box<Scalar>& moved, Image image) {
        const auto note = [&](std::uint32_t other) {
            if (other == body || !bodies_->alive[other]) return;
            if (touches(disc, other, separation_from(disc, other, image))) {
                near_.push_back({other, image});
            }
        };
        paths_.for_each_touching(touching(disc, image), {}, now_s_ - from_s_, note);
        if (!strays_.empty()) strays_near_.for_each_near(body, moved, note);
    });
    std::sort(near_.begin(), near_.end());
    for (const Partner& near : near_) {
        visit(near.body, separation_from(disc, near.body, near.image));
    }
}

template <typename Scalar, typename Space>
template <typename Visit>
void SweptEngine<Scalar, Space>::for_each_touched_wall(std::uint32_t body, Visit&& visit) const {
    if (!model_->walls) return;
    const Vec position = position_at(body, now_s_);
    const Scalar radius = bodies_->radius_m[body];
    const Scalar tolerance = touch_tolerance_m(radius, extent_m(body));
    if (keeps_off_walls(position, radius, {tolerance, tolerance})) [[likely]]
        return;
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        const Scalar below = position[axis] - (model_->walls->min_m[axis] + radius);
        const Scalar above = (model_->walls->max_m[axis] - radius) - position[axis];
        if (below <= tolerance) visit(2 * axis);
        if (above <= tolerance) visit(2 * axis + 1);
    }
}

template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::touches_wall(std::uint32_t body) const {
    bool found = false;
    for_each_touched_wall(body, [&](std::uint32_t) { found = true; });
    return found;
}

// Whether anything but the two of this event touches either of them. What does not move does not
// pass anything on.
template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::is_touched_by_others(const Happening& event) {
    bool found = false;
    if (event.kind == EventKind::kWall) {
        for_each_touched_wall(event.a, [&](std::uint32_t side) { found |= side != event.b; });
        for_each_touching(event.a, [&](std::uint32_t, const Vec&) { found = true; });
        return found;
    }
    return (!is_immovable(event.a) && touches_wall(event.a)) ||
           (!is_immovable(event.b) && touches_wall(event.b)) || is_pair_touched(event, Among::kAll);
}

// One look at the grid for both, since they lie side by side.
template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::is_pair_touched(const Happening& event, Among others) {
    const Vec at_a = position_at(event.a, now_s_);
    const Disc a = disc_at(event.a, at_a);
    const Disc b = disc_at(event.b, at_a - separation_now(event.a, event.b, event.image));
    const bool a_moves = !is_immovable(event.a), b_moves = !is_immovable(event.b);
    const Box<Scalar> box = !a_moves   ? reach_of(b)
                            : !b_moves ? reach_of(a)
                                       : united(reach_of(a), reach_of(b));
    bool found = false;
    space_.for_each_image(box, [&](const Box<Scalar>& moved, Image image) {
        const auto look = [&](std::uint32_t other) {
            if (found || other == event.a || other == event.b || !bodies_->alive[other]) return;
            found = (a_moves && touches(a, other, separation_from(a, other, image))) ||
                    (b_moves && touches(b, other, separation_from(b, other, image)));
        };
        if (others == Among::kAll) {
            const Touching near_a = a_moves ? touching(a, image) : Touching{};
            const Touching near_b = b_moves ? touching(b, image) : Touching{};
            paths_.for_each_touching(near_a, near_b, now_s_ - from_s_, look);
        }
        if (!strays_.empty()) strays_near_.for_each_near(event.a, moved, look);
    });
    return found;
}

// Looks, with one search, whom the two will meet after this hit and whether anybody else touches
// them now, which is hardly ever so. False where somebody may, or a wall, or where others are not
// all among the paths; then all is to be looked for one by one.
template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::look_ahead(const Happening& event,
                                            const std::optional<Impact<Scalar>>& hit) {
    if constexpr (Space::kHasImages) return false;
    if (is_immovable(event.a) || is_immovable(event.b)) return false;
    if (!strays_.empty() && is_pair_touched(event, Among::kStrays)) return false;
    const Bodies<Scalar>& all = *bodies_;
    const std::uint32_t a = event.a, b = event.b;
    const Scalar since_s = now_s_ - from_s_;
    const Path motions[2] = {{all.position_m[a], hit ? hit->velocity_1_mps : all.velocity_mps[a],
                              all.radius_m[a], since_s},
                             {all.position_m[b], hit ? hit->velocity_2_mps : all.velocity_mps[b],
                              all.radius_m[b], since_s}};
    return paths_.see({a, b}, motions, sight_) && sight_.are_alone &&
           (sight_.keep_inside || !(touches_wall(a) || touches_wall(b)));
}

// Those of which something happened to one, or that were kept twice, are of no use any more.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::sort_out_kept() {
    std::erase_if(kept_, [&](const Hold& hold) {
        return hold.count_a != known_[hold.a].count ||
               (hold.b < kWallHold && hold.count_b != known_[hold.b].count);
    });
    std::sort(kept_.begin(), kept_.end());
    kept_.erase(std::unique(kept_.begin(), kept_.end()), kept_.end());
    kept_before_ = std::ssize(kept_);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::collide_set(const Happening& event) {
    set_.begin(bodies_->slots());
    join_set(event);
    gather_simultaneous();
    const auto report = [&](std::span<const Hit<Scalar>> together) {
        for (const Hit<Scalar>& hit : together) {
            move_to(hit.a, now_s_);
            if (hit.b != kNoBody) move_to(hit.b, now_s_);
        }
        record_hits(*bodies_, now_s_, together, *record_);
    };
    const Resolution done = set_.resolve(
        model_->restitution, [&](std::uint32_t body) { look_around(body); }, report);
    for (const std::uint32_t body : set_.hit_bodies()) {
        bodies_->velocity_mps[body] = set_.velocity_mps(body);
        after_event(body, {});
    }
    if (done.unfinished) ++record_->audit.unfinished_sets;
    place_and_predict_set();
    count(done.hits, 1 + done.hits / kSetHitsPerEvent);
}

// False when it is a fall, or its two do not touch yet.
template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::join_set(const Happening& event) {
    if (event.kind == EventKind::kFall) return false;
    if (event.kind == EventKind::kWall) {
        add_to_set(event.a);
        set_.touch_wall(event.a, event.b);
        return true;
    }
    const Vec separation = separation_now(event.a, event.b, event.image);
    const Scalar reach = bodies_->radius_m[event.a] + bodies_->radius_m[event.b];
    const Scalar extent = std::max(extent_m(event.a), extent_m(event.b));
    if (separation.norm() > reach + touch_tolerance_m(reach, extent)) return false;
    add_to_set(event.a);
    add_to_set(event.b);
    set_.touch(event.a, event.b, separation);
    return true;
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::gather_simultaneous() {
    const Scalar instant_s = now_s_ + static_cast<Scalar>(kSameInstant) *
                                          std::numeric_limits<Scalar>::epsilon() * span_s_;
    not_in_set_.clear();
    while (!queue_.empty() && queue_.next().time_s <= instant_s) {
        const Happening event = queue_.pop();
        if (!is_stale(event) && !join_set(event)) not_in_set_.push_back(event);
    }
    for (const Happening& event : not_in_set_) queue_.push(event);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::look_around(std::uint32_t body) {
    for_each_touching(body, [&](std::uint32_t other, const Vec& separation) {
        add_to_set(other);
        set_.touch(body, other, separation);
    });
    for_each_touched_wall(body, [&](std::uint32_t side) { set_.touch_wall(body, side); });
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::add_to_set(std::uint32_t body) {
    set_.add(body, bodies_->velocity_mps[body], bodies_->mass_kg[body], was_just_hit(body));
}

template bool SweptEngine<double, OpenSpace<double>>::look_ahead(
    const Happening&, const std::optional<Impact<double>>&);
template bool SweptEngine<float, OpenSpace<float>>::look_ahead(const Happening&,
                                                               const std::optional<Impact<float>>&);
template bool SweptEngine<double, TorusSpace<double>>::look_ahead(
    const Happening&, const std::optional<Impact<double>>&);
template bool SweptEngine<float, TorusSpace<float>>::look_ahead(
    const Happening&, const std::optional<Impact<float>>&);
template bool SweptEngine<double, OpenSpace<double>>::is_touched_by_others(const Happening&);
template bool SweptEngine<float, OpenSpace<float>>::is_touched_by_others(const Happening&);
template bool SweptEngine<double, TorusSpace<double>>::is_touched_by_others(const Happening&);
template bool SweptEngine<float, TorusSpace<float>>::is_touched_by_others(const Happening&);
template void SweptEngine<double, OpenSpace<double>>::collide_set(const Happening&);
template void SweptEngine<float, OpenSpace<float>>::collide_set(const Happening&);
template void SweptEngine<double, TorusSpace<double>>::collide_set(const Happening&);
template void SweptEngine<float, TorusSpace<float>>::collide_set(const Happening&);
template void SweptEngine<double, OpenSpace<double>>::sort_out_kept();
template void SweptEngine<float, OpenSpace<float>>::sort_out_kept();
template void SweptEngine<double, TorusSpace<double>>::sort_out_kept();
template void SweptEngine<float, TorusSpace<float>>::sort_out_kept();

}  // namespace fts::physics
