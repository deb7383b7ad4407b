#include "common/physics/swept_engine.h"

#include <algorithm>

#include "common/physics/solver_swept.h"
#include "common/physics/time_of_impact.h"

namespace fts::physics {
namespace {

// By how many units of round-off a swept box is larger than what it must hold.
constexpr double kBoxSlack = 8.0;

// Before there are so many, a stray more is reason enough to fit their grid anew.
constexpr std::size_t kFirstStrays = 8;

// By how many units of the span's round-off a look sees further than it is for.
constexpr double kSeenSlack = 16.0;
constexpr std::uint32_t kMostLooks = 32;
constexpr double kWayOfALook = 0.4;  // of a radius
// One look is enough for so few, and so many are asked how far they move.
constexpr std::size_t kFewBodies = 64;

// A part of the span: what is not due within that after the end of a look is not due in it.
template <typename Scalar>
constexpr Scalar kWallSlack = Scalar(16) * std::numeric_limits<Scalar>::epsilon();

// So that round-off does not matter where many are left out together.
template <typename Scalar>
constexpr Scalar kWider = Scalar(1.01);

}  // namespace

template <typename Scalar, typename Space>
DriftReport<Scalar> SweptEngine<Scalar, Space>::drift(Bodies<Scalar>& bodies,
                                                      const Model<Scalar>& model, Scalar span_s,
                                                      Record<Scalar>& record) {
    begin(bodies, model, span_s, record);
    for (std::uint32_t stretch = 0; stretch < kMaxStretches; ++stretch) {
        begin_stretch();
        if (!run_stretch()) break;
        end_stretch(until_s_);
        if (until_s_ >= span_s) return report_;
    }
    report_.overrun = true;
    report_.unspent_time_s = span_s - now_s_;
    end_stretch(now_s_);
    return report_;
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::begin(Bodies<Scalar>& bodies, const Model<Scalar>& model,
                                       Scalar span_s, Record<Scalar>& record) {
    bodies_ = &bodies;
    model_ = &model;
    record_ = &record;
    report_ = {};
    spent_ = 0;
    budget_ = event_budget(bodies.ids.size());
    span_s_ = span_s;
    now_s_ = Scalar(0);
    begin_knowledge();
    looks_ = looks_for(span_s);
    if constexpr (Space::kHasImages) {
        space_.begin(*model.periodic);
        for (Known& known : known_) known.time_s = Scalar(0);
    }
}

// What is known by body is reset only where something happened, which is to few.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::begin_knowledge() {
    for (const std::uint32_t body : touched()) known_[body] = {.count = known_[body].count};
    touched_count_ = 0;
    const std::uint32_t slots = bodies_->slots();
    if (slots == known_.size()) return;
    touched_.resize(slots + 1);
    strays_.reserve(slots);
    boxes_.reserve(slots);
    near_.reserve(slots);
    strays_near_.reserve(slots);
    queue_.reserve(slots);
    places_.reserve(slots);
    ends_.reserve(slots);
    known_.resize(slots);
    for (Turn& turn : turn_) turn.meetings.bodies.resize(slots);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::begin_stretch() {
    until_s_ = stretch_end();
    for (const std::uint32_t body : touched()) known_[body].partner = {};
    kept_.clear();
}

// False when the event budget ran out.
template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::run_stretch() {
    const Scalar begin_s = now_s_, look_s = (until_s_ - begin_s) / static_cast<Scalar>(looks_);
    for (std::uint32_t look = 1;; ++look) {
        begin_look(look, begin_s + static_cast<Scalar>(look) * look_s);
        if (!run_look()) return false;
        if (look_until_s_ >= until_s_) return true;
        now_s_ = look_until_s_;
    }
}

// A little more is seen than the look is for, so that what is due at the same instant is seen
// together.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::begin_look(std::uint32_t look, Scalar until_s) {
    const bool is_last = look >= looks_ || !(until_s < until_s_);
    is_first_look_ = look == 1;
    from_s_ = now_s_;
    look_until_s_ = is_last ? until_s_ : until_s;
    seen_until_s_ =
        std::min(until_s_, look_until_s_ + static_cast<Scalar>(kSeenSlack) *
                                               std::numeric_limits<Scalar>::epsilon() * span_s_);
    queue_.begin(from_s_, seen_until_s_);
    sort_out_kept();
    predict_everybody();
}

template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::run_look() {
    while (!queue_.empty()) {
        if (queue_.next().time_s > std::min(look_until_s_, until_s_)) break;
        const Happening event = queue_.pop();
        if (is_stale(event)) continue;
        if (spent_ >= budget_) return false;
        now_s_ = event.time_s;
        process(event);
    }
    return true;
}

// So many that most move by less than a part of their radius in each.
template <typename Scalar, typename Space>
std::uint32_t SweptEngine<Scalar, Space>::looks_for(Scalar span_s) const {
    const Bodies<Scalar>& all = *bodies_;
    if (all.ids.size() < kFewBodies) return 1;
    const std::size_t stride = all.ids.size() / kFewBodies;
    Scalar ways = Scalar(0), radii = Scalar(0);
    for (std::size_t i = 0; i < all.ids.size(); i += stride) {
        const std::uint32_t body = all.ids[i].index;
        ways += all.velocity_mps[body].cwiseAbs().maxCoeff() * span_s;
        radii += all.radius_m[body];
    }
    const Scalar wanted = std::ceil(ways / (static_cast<Scalar>(kWayOfALook) * radii));
    if (!(wanted > Scalar(1)) || wanted > static_cast<Scalar>(4 * kMostLooks)) return 1;
    const auto looks =
        static_cast<std::uint32_t>(std::min(wanted, static_cast<Scalar>(kMostLooks)));
    const bool is_alike = 3 * looks > 2 * looks_ && 2 * looks < 3 * looks_;
    return is_alike ? looks_ : looks;
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::end_stretch(Scalar time_s) {
    now_s_ = time_s;
    Vec* const position = bodies_->position_m.data();
    const Vec* const velocity = bodies_->velocity_mps.data();
    if constexpr (Space::kHasImages) {
        for (const BodyId id : bodies_->ids) {
            position[id.index] = space_.home(position_at(id.index, time_s));
            known_[id.index].time_s = time_s;
        }
        return;
    }
    ends_.clear();
    for (const std::uint32_t body : touched()) {
        ends_.push_back(bodies_->alive[body] ? position_at(body, time_s) : position[body]);
    }
    const std::uint32_t slots = bodies_->slots();
    if (bodies_->ids.size() == slots) {
        for (std::uint32_t body = 0; body < slots; ++body) {
            position[body] += velocity[body] * time_s;
        }
    } else {
        for (const BodyId id : bodies_->ids) position[id.index] += velocity[id.index] * time_s;
    }
    for (std::size_t i = 0; i < ends_.size(); ++i) position[touched_[i]] = ends_[i];
}

// An open space has one stretch, the span.
template <typename Scalar, typename Space>
Scalar SweptEngine<Scalar, Space>::stretch_end() const {
    if constexpr (Space::kHasImages) {
        Vec fastest_mps = Vec::Zero();
        for (const BodyId id : bodies_->ids) {
            fastest_mps = fastest_mps.cwiseMax(bodies_->velocity_mps[id.index].cwiseAbs());
        }
        const Scalar fastest = space_.boxes_per_s(fastest_mps);
        const Scalar left_s = span_s_ - now_s_;
        const Scalar stretches =
            std::ceil(fastest * left_s / static_cast<Scalar>(Space::kLongestWayInBoxes));
        if (stretches > Scalar(1)) return now_s_ + left_s / stretches;
    }
    return span_s_;
}

// A collision may have made a body much faster than it was when the stretch began.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::shorten_stretch(std::uint32_t body) {
    if constexpr (Space::kHasImages) {
        const Scalar boxes = space_.boxes_per_s(bodies_->velocity_mps[body]);
        const auto longest = static_cast<Scalar>(Space::kLongestWayInBoxes);
        if (!(boxes * (until_s_ - now_s_) > Scalar(2) * longest)) return;
        until_s_ = now_s_ + longest / boxes;
        seen_until_s_ = std::min(seen_until_s_, until_s_);
    }
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::place(std::uint32_t body, const Course& course) {
    const bool was_stray = paths_.is_stray(body);
    if (paths_.follow(body, course)) {
        if constexpr (Space::kHasImages) space_.cover(swept_box(body));
        return;
    }
    const Box<Scalar> box = swept_box(body);
    space_.cover(box);
    if (was_stray) return strays_near_.place(body, box);
    strays_.push_back(body);
    if (strays_.size() >= kFirstStrays && strays_.size() < 2 * fitted_strays_) {
        return strays_near_.place(body, box);
    }
    fit_strays();
    for (const std::uint32_t stray : strays_) strays_near_.place(stray, swept_box(stray));
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::fit_strays() {
    boxes_.clear();
    std::erase_if(strays_, [&](std::uint32_t body) { return bodies_->alive[body] == 0; });
    for (const std::uint32_t body : strays_) boxes_.push_back(swept_box(body));
    fitted_strays_ = strays_.size();
    if (!strays_.empty()) strays_near_.begin(boxes_, bodies_->slots());
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_everybody() {
    paths_.begin(*bodies_, places(), model_->equal_radii, seen_until_s_ - from_s_);
    strays_.assign(paths_.strays().begin(), paths_.strays().end());
    if (!is_first_look_) {
        paths_.for_each_pair([&](std::uint32_t a, std::uint32_t b) {
            predict_pair(std::min(a, b), std::max(a, b), Image{});
        });
    } else if (model_->equal_radii) {
        predict_pairs<true>();
    } else {
        predict_pairs<false>();
    }
    predict_images();
    predict_strays();
    if (model_->walls) predict_all_walls();
    if (model_->platform) {
        for (const BodyId id : bodies_->ids) predict_fall(id.index);
    }
}

// Where everybody is when the look begins.
template <typename Scalar, typename Space>
auto SweptEngine<Scalar, Space>::places() -> std::span<const Vec> {
    if (is_first_look_) return bodies_->position_m;
    places_.resize(bodies_->slots());
    for (const BodyId id : bodies_->ids) places_[id.index] = position_at(id.index, from_s_);
    return places_;
}

// Only who starts near a wall may reach it.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_all_walls() {
    const Scalar margin = kWider<Scalar> * (paths_.longest_way_m() + paths_.largest_radius_m());
    const auto predict_one = [&](std::uint32_t body) {
        if (!is_immovable(body)) predict_walls<false>(body);
    };
    const auto& walls = *model_->walls;
    paths_.for_each_outside({walls.min_m.x() + margin, walls.min_m.y() + margin,
                             walls.max_m.x() - margin, walls.max_m.y() - margin},
                            predict_one);
    for (const std::uint32_t body : strays_) predict_one(body);
}

// Nothing has happened to anybody yet: positions are those of now, and there are no partners.
template <typename Scalar, typename Space>
template <bool kEqualRadii>
void SweptEngine<Scalar, Space>::predict_pairs() {
    const Bodies<Scalar>& all = *bodies_;
    const Scalar twice_radius =
        kEqualRadii && !all.ids.empty() ? Scalar(2) * all.radius_m[all.ids[0].index] : Scalar(0);
    const bool any_immovable = !model_->equal_masses;
    paths_.for_each_pair([&](std::uint32_t first, std::uint32_t second) {
        const std::uint32_t a = std::min(first, second), b = std::max(first, second);
        if (any_immovable && is_immovable(a) && is_immovable(b)) return;
        const Scalar reach = kEqualRadii ? twice_radius : all.radius_m[a] + all.radius_m[b];
        const Vec &at_a = all.position_m[a], &at_b = all.position_m[b];
        const Vec &of_a = all.velocity_mps[a], &of_b = all.velocity_mps[b];
        const Scalar wait_s =
            time_until_contact<Scalar>({at_a.x() - at_b.x(), at_a.y() - at_b.y()},
                                       {of_a.x() - of_b.x(), of_a.y() - of_b.y()}, reach);
        expect({now_s_ + wait_s, EventKind::kBall, a, b, known_[a].count, known_[b].count, {}});
    });
}

// A pair by way of an image of the one is that by way of the opposite image of the other, and is
// looked for once.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_images() {
    if constexpr (Space::kHasImages) {
        const Scalar margin = kWider<Scalar> * (paths_.longest_way_m() + paths_.largest_radius_m());
        Box<Scalar> where = space_.box();
        if (!is_first_look_) {
            for (const BodyId id : bodies_->ids) {
                const Vec& place = places_[id.index];
                where = {std::min(where.min_x_m, place.x()), std::min(where.min_y_m, place.y()),
                         std::max(where.max_x_m, place.x()), std::max(where.max_y_m, place.y())};
            }
        }
        space_.cover_only({where.min_x_m - margin, where.min_y_m - margin, where.max_x_m + margin,
                           where.max_y_m + margin});
        const Box<Scalar> inside = space_.without_images(kWider<Scalar> * margin);
        paths_.for_each_outside(inside, [&](std::uint32_t body) {
            const Path path = path_of(body);
            space_.for_each_image(swept_box(body), [&](const Box<Scalar>&, Image image) {
                if (!image.is_upper()) return;
                Path moved = path;
                moved.position_m = space_.moved(path.position_m, image);
                paths_.for_each_meeting(paths_.course_of(moved), [&](std::uint32_t other) {
                    if (other == body) return;
                    predict_pair(std::min(body, other), std::max(body, other),
                                 body < other ? image : -image);
                });
            });
        });
    }
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_strays() {
    fit_strays();
    for (const std::uint32_t body : strays_) space_.cover(swept_box(body));
    for (const std::uint32_t body : strays_) {
        predict_meetings<false>(body, course_of(body));
        strays_near_.place(body, swept_box(body));
    }
}

template <typename Scalar, typename Space>
template <bool kAfterSet>
void SweptEngine<Scalar, Space>::predict(std::uint32_t body, const Course& course,
                                         const Meetings* seen) {
    predict_meetings<kAfterSet>(body, course, seen);
    if (model_->walls && !is_immovable(body)) predict_walls<kAfterSet>(body);
    if (model_->platform) predict_fall(body);
}

template <typename Scalar, typename Space>
template <bool kAfterSet>
void SweptEngine<Scalar, Space>::predict_meetings(std::uint32_t body, const Course& course,
                                                  const Meetings* seen) {
    const bool is_stray = paths_.is_stray(body), any_strays = !strays_.empty();
    const Box<Scalar> box = Space::kHasImages || any_strays ? swept_box(body) : Box<Scalar>{};
    space_.for_each_image(box, [&](const Box<Scalar>& moved_box, Image image) {
        const auto meet = [&](std::uint32_t other) {
            if (other == body || !bodies_->alive[other]) return;
            const std::uint32_t a = std::min(body, other), b = std::max(body, other);
            const Image of_a = a == body ? image : -image;
            if (kAfterSet && set_.keeps_apart(a, b, separation_now(a, b, of_a))) {
                return keep({a, b, of_a, known_[a].count, known_[b].count});
            }
            predict_pair(a, b, of_a);
        };
        if (any_strays) strays_near_.for_each_near(body, moved_box, meet);
        if (is_stray) return paths_.for_each_in(moved_box, now_s_ - from_s_, meet);
        if constexpr (Space::kHasImages) {
            Path moved = path_of(body);
            moved.position_m = space_.moved(moved.position_m, image);
            paths_.for_each_meeting(paths_.course_of(moved), meet);
        } else if (seen != nullptr) {
            for (std::size_t i = 0; i < seen->count; ++i) meet(seen->bodies[i]);
        } else {
            paths_.for_each_meeting(course, meet);
        }
    });
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_pair(std::uint32_t a, std::uint32_t b, Image image) {
    if (known_[a].partner == Partner{b, image} && known_[b].partner == Partner{a, image}) return;
    if (!model_->equal_masses && is_immovable(a) && is_immovable(b)) return;
    if (is_kept({a, b, image, known_[a].count, known_[b].count})) return;
    const Scalar known_s = std::max(known_[a].time_s, known_[b].time_s);
    const Vec at_a = space_.moved(position_at(a, known_s), image), at_b = position_at(b, known_s);
    const Vec separation(at_a.x() - at_b.x(), at_a.y() - at_b.y());
    const Vec &of_a = bodies_->velocity_mps[a], &of_b = bodies_->velocity_mps[b];
    const Vec velocity(of_a.x() - of_b.x(), of_a.y() - of_b.y());
    const Scalar reach = bodies_->radius_m[a] + bodies_->radius_m[b];
    expect({known_s + time_until_contact(separation, velocity, reach), EventKind::kBall, a, b,
            known_[a].count, known_[b].count, image});
}

template <typename Scalar, typename Space>
template <bool kAfterSet>
void SweptEngine<Scalar, Space>::predict_walls(std::uint32_t body) {
    const Scalar known_s = known_[body].time_s;
    const Scalar left_s = seen_until_s_ - known_s + kWallSlack<Scalar> * span_s_;
    const Vec& position = bodies_->position_m[body];
    const Vec& velocity = bodies_->velocity_mps[body];
    const Scalar radius = bodies_->radius_m[body];
    const Vec way(std::abs(velocity.x()) * left_s, std::abs(velocity.y()) * left_s);
    if (keeps_off_walls(position, radius, way)) [[likely]]
        return;
    const auto look_at = [&](std::uint32_t side, Scalar gap, Scalar closing_mps) {
        if (gap > closing_mps * left_s) return;
        const Hold hold = {body, kWallHold + side, Image{}, known_[body].count, 0};
        if (kAfterSet && set_.keeps_off_wall(body, side)) return keep(hold);
        if (is_kept(hold)) return;
        expect({known_s + time_until_wall(gap, closing_mps), EventKind::kWall, body, side,
                known_[body].count, 0});
    };
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        const Scalar below = position[axis] - (model_->walls->min_m[axis] + radius);
        const Scalar above = (model_->walls->max_m[axis] - radius) - position[axis];
        look_at(2 * axis, below, -velocity[axis]);
        look_at(2 * axis + 1, above, velocity[axis]);
    }
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_fall(std::uint32_t body) {
    const Scalar known_s = known_[body].time_s;
    const Vec& position = bodies_->position_m[body];
    const Vec& velocity = bodies_->velocity_mps[body];
    const Vec way = velocity.cwiseAbs() * (seen_until_s_ - known_s);
    if (surely_stays<Scalar>(*model_->platform, position, way)) return;
    const Scalar time = time_until_edge<Scalar>(*model_->platform, position, velocity);
    expect({known_s + time, EventKind::kFall, body, 0, known_[body].count, 0});
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::expect(const Happening& event) {
    if (event.time_s > seen_until_s_ || event.time_s > until_s_) return;
    // What was due in an earlier look has happened there, or turned out to be nothing.
    if (!is_first_look_ && event.time_s <= from_s_) return;
    queue_.push(event);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::place_and_predict(std::uint32_t body, const Turn* turn) {
    shorten_stretch(body);
    const Course course = turn != nullptr ? turn->course : course_of(body);
    place(body, course);
    predict<false>(body, course, turn != nullptr ? &turn->meetings : nullptr);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::place_and_predict_set() {
    for (const std::uint32_t body : set_.hit_bodies()) shorten_stretch(body);
    for (const std::uint32_t body : set_.hit_bodies()) place(body, course_of(body));
    for (const std::uint32_t body : set_.hit_bodies()) predict<true>(body, course_of(body));
}

template <typename Scalar, typename Space>
Box<Scalar> SweptEngine<Scalar, Space>::swept_box(std::uint32_t body) const {
    const Vec from = position_at(body, now_s_);
    const Vec to = position_at(body, seen_until_s_);
    const Scalar radius = bodies_->radius_m[body];
    const Scalar extent = std::max(std::abs(from.x()), std::abs(from.y())) +
                          std::max(std::abs(to.x()), std::abs(to.y())) + radius;
    const Scalar reach =
        radius + static_cast<Scalar>(kBoxSlack) * std::numeric_limits<Scalar>::epsilon() * extent;
    return {std::min(from.x(), to.x()) - reach, std::min(from.y(), to.y()) - reach,
            std::max(from.x(), to.x()) + reach, std::max(from.y(), to.y()) + reach};
}

template class SweptEngine<double, OpenSpace<double>>;
template class SweptEngine<float, OpenSpace<float>>;
template class SweptEngine<double, TorusSpace<double>>;
template class SweptEngine<float, TorusSpace<float>>;

}  // namespace fts::physics
