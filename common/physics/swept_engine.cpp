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

// So that round-off does not matter where many are left out together.
template <typename Scalar>
constexpr Scalar kWider = Scalar(1.01);

// What is left of a platform's square when its edge is to be out of reach beyond doubt.
template <typename Scalar>
constexpr Scalar kWellInside = Scalar(0.999);

// Whether a way of at most `way_m` on each axis surely does not lead off the platform.
template <typename Scalar>
bool stays_on(const Disc& disc, const Vec2<Scalar>& position_m, const Vec2<Scalar>& way_m) {
    const auto radius = static_cast<Scalar>(disc.radius_m);
    return (position_m.cwiseAbs() + way_m).squaredNorm() < kWellInside<Scalar> * radius * radius;
}

template <typename Scalar>
bool stays_on(const Ring& ring, const Vec2<Scalar>& position_m, const Vec2<Scalar>& way_m) {
    const Scalar near = static_cast<Scalar>(ring.inner_radius_m) + way_m.x() + way_m.y();
    return near * near < kWellInside<Scalar> * position_m.squaredNorm() &&
           stays_on(Disc{ring.outer_radius_m}, position_m, way_m);
}

template <typename Scalar>
bool stays_on(const Rectangle& rectangle, const Vec2<Scalar>& position_m,
              const Vec2<Scalar>& way_m) {
    const Vec2<Scalar> half = kWellInside<Scalar> * rectangle.half_extents_m.cast<Scalar>();
    return ((position_m.cwiseAbs() + way_m).array() < half.array()).all();
}

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
    if constexpr (Space::kHasImages) {
        space_.begin(*model.periodic);
        std::fill(time_s_.begin(), time_s_.end(), Scalar(0));
    }
}

// What is known by body is reset only where something happened, which is to few.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::begin_knowledge() {
    for (const std::uint32_t body : touched_) {
        time_s_[body] = Scalar(0);
        hit_s_[body] = kLongAgo;
        partner_[body] = {};
        is_touched_[body] = 0;
    }
    touched_.clear();
    const std::uint32_t slots = bodies_->slots();
    if (slots == is_touched_.size()) return;
    touched_.reserve(slots);
    strays_.reserve(slots);
    boxes_.reserve(slots);
    near_.reserve(slots);
    strays_near_.reserve(slots);
    queue_.reserve(slots);
    time_s_.resize(slots, Scalar(0));
    hit_s_.resize(slots, kLongAgo);
    count_.resize(slots, 0);
    partner_.resize(slots);
    is_touched_.resize(slots, 0);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::begin_stretch() {
    until_s_ = stretch_end();
    from_s_ = now_s_;
    queue_.begin(from_s_, until_s_);
    for (const std::uint32_t body : touched_) partner_[body] = {};
    predict_everybody();
}

// False when the event budget ran out.
template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::run_stretch() {
    while (!queue_.empty()) {
        const Happening event = queue_.pop();
        if (is_stale(event)) continue;
        if (Space::kHasImages && event.time_s > until_s_) break;
        if (spent_ >= budget_) return false;
        now_s_ = event.time_s;
        process(event);
    }
    return true;
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::end_stretch(Scalar time_s) {
    now_s_ = time_s;
    Bodies<Scalar>& all = *bodies_;
    for (const BodyId id : all.ids) {
        const Vec position = position_at(id.index, time_s);
        if constexpr (Space::kHasImages) {
            all.position_m[id.index] = space_.home(position);
            time_s_[id.index] = time_s;
        } else {
            all.position_m[id.index] = position;
        }
    }
}

// An open space has one stretch, the span.
template <typename Scalar, typename Space>
Scalar SweptEngine<Scalar, Space>::stretch_end() const {
    if constexpr (Space::kHasImages) {
        Scalar fastest = Scalar(0);
        for (const BodyId id : bodies_->ids) {
            fastest = std::max(fastest, space_.boxes_per_s(bodies_->velocity_mps[id.index]));
        }
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
        if (boxes * (until_s_ - now_s_) > Scalar(2) * longest) until_s_ = now_s_ + longest / boxes;
    }
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::place(std::uint32_t body) {
    const bool was_stray = paths_.is_stray(body);
    if (paths_.follow(body, path_of(body))) {
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
    paths_.begin(*bodies_, model_->equal_radii, until_s_ - now_s_);
    strays_.assign(paths_.strays().begin(), paths_.strays().end());
    if (model_->equal_radii) {
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
        expect(
            {now_s_ + time_until_contact<Scalar>(all.position_m[a] - all.position_m[b],
                                                 all.velocity_mps[a] - all.velocity_mps[b], reach),
             EventKind::kBall, a, b, count_[a], count_[b], Image{}});
    });
}

// A pair by way of an image of the one is that by way of the opposite image of the other, and is
// looked for once.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_images() {
    if constexpr (Space::kHasImages) {
        const Scalar margin = kWider<Scalar> * (paths_.longest_way_m() + paths_.largest_radius_m());
        space_.uncover(margin);
        for (const BodyId id : bodies_->ids) {
            const std::uint32_t body = id.index;
            if (paths_.is_stray(body)) continue;
            const Path path = path_of(body);
            space_.for_each_image(swept_box(body), [&](const Box<Scalar>&, Image image) {
                if (!image.is_upper()) return;
                Path moved = path;
                moved.position_m = space_.moved(path.position_m, image);
                paths_.for_each_meeting(moved, [&](std::uint32_t other) {
                    if (other == body) return;
                    predict_pair(std::min(body, other), std::max(body, other),
                                 body < other ? image : -image);
                });
            });
        }
    }
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_strays() {
    fit_strays();
    for (const std::uint32_t body : strays_) space_.cover(swept_box(body));
    for (const std::uint32_t body : strays_) {
        predict_meetings<false>(body);
        strays_near_.place(body, swept_box(body));
    }
}

template <typename Scalar, typename Space>
template <bool kAfterSet>
void SweptEngine<Scalar, Space>::predict(std::uint32_t body) {
    predict_meetings<kAfterSet>(body);
    if (model_->walls && !is_immovable(body)) predict_walls<kAfterSet>(body);
    if (model_->platform) predict_fall(body);
}

template <typename Scalar, typename Space>
template <bool kAfterSet>
void SweptEngine<Scalar, Space>::predict_meetings(std::uint32_t body) {
    const Path path = path_of(body);
    const bool is_stray = paths_.is_stray(body), any_strays = !strays_.empty();
    const Box<Scalar> box = Space::kHasImages || any_strays ? swept_box(body) : Box<Scalar>{};
    space_.for_each_image(box, [&](const Box<Scalar>& moved_box, Image image) {
        const auto meet = [&](std::uint32_t other) {
            if (other == body || !bodies_->alive[other]) return;
            const std::uint32_t a = std::min(body, other), b = std::max(body, other);
            const Image of_a = a == body ? image : -image;
            if (kAfterSet && set_.keeps_apart(a, b, separation_now(a, b, of_a))) return;
            predict_pair(a, b, of_a);
        };
        if (any_strays) strays_near_.for_each_near(body, moved_box, meet);
        if (is_stray) return paths_.for_each_in(moved_box, path.since_s, meet);
        Path moved = path;
        moved.position_m = space_.moved(path.position_m, image);
        paths_.for_each_meeting(moved, meet);
    });
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_pair(std::uint32_t a, std::uint32_t b, Image image) {
    if (partner_[a] == Partner{b, image} && partner_[b] == Partner{a, image}) return;
    if (!model_->equal_masses && is_immovable(a) && is_immovable(b)) return;
    const Vec separation = separation_now(a, b, image);
    const Vec velocity = bodies_->velocity_mps[a] - bodies_->velocity_mps[b];
    const Scalar reach = bodies_->radius_m[a] + bodies_->radius_m[b];
    expect({now_s_ + time_until_contact(separation, velocity, reach), EventKind::kBall, a, b,
            count_[a], count_[b], image});
}

template <typename Scalar, typename Space>
template <bool kAfterSet>
void SweptEngine<Scalar, Space>::predict_walls(std::uint32_t body) {
    const Vec position = position_at(body, now_s_);
    const Vec& velocity = bodies_->velocity_mps[body];
    const Scalar radius = bodies_->radius_m[body];
    const auto expect_wall = [&](std::uint32_t side, Scalar time_s) {
        if (kAfterSet && set_.keeps_off_wall(body, side)) return;
        expect({now_s_ + time_s, EventKind::kWall, body, side, count_[body], 0});
    };
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        const Scalar below = position[axis] - (model_->walls->min_m[axis] + radius);
        const Scalar above = (model_->walls->max_m[axis] - radius) - position[axis];
        expect_wall(2 * axis, time_until_wall(below, -velocity[axis]));
        expect_wall(2 * axis + 1, time_until_wall(above, velocity[axis]));
    }
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_fall(std::uint32_t body) {
    const Vec position = position_at(body, now_s_);
    const Vec& velocity = bodies_->velocity_mps[body];
    const Vec way = velocity.cwiseAbs() * (until_s_ - now_s_);
    const bool stays =
        std::visit([&](const auto& shape) { return stays_on<Scalar>(shape, position, way); },
                   *model_->platform);
    if (stays) return;
    const Scalar time = time_until_edge<Scalar>(*model_->platform, position, velocity);
    expect({now_s_ + time, EventKind::kFall, body, 0, count_[body], 0});
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::expect(const Happening& event) {
    if (event.time_s <= until_s_) queue_.push(event);
}

template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::is_stale(const Happening& event) const {
    return event.count_a != count_[event.a] ||
           (event.kind == EventKind::kBall && event.count_b != count_[event.b]);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::count(std::uint32_t events, std::uint32_t cost) {
    report_.events += events;
    spent_ += cost;
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::after_event(std::uint32_t body, const Partner& partner) {
    ++count_[body];
    partner_[body] = partner;
    hit_s_[body] = now_s_;
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::place_and_predict(std::uint32_t body) {
    shorten_stretch(body);
    place(body);
    predict<false>(body);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::place_and_predict_set() {
    for (const std::uint32_t body : set_.hit_bodies()) shorten_stretch(body);
    for (const std::uint32_t body : set_.hit_bodies()) place(body);
    for (const std::uint32_t body : set_.hit_bodies()) predict<true>(body);
}

template <typename Scalar, typename Space>
Box<Scalar> SweptEngine<Scalar, Space>::swept_box(std::uint32_t body) const {
    const Vec from = position_at(body, now_s_);
    const Vec to = position_at(body, until_s_);
    const Scalar radius = bodies_->radius_m[body];
    const Scalar extent = std::max(std::abs(from.x()), std::abs(from.y())) +
                          std::max(std::abs(to.x()), std::abs(to.y())) + radius;
    const Scalar reach =
        radius + static_cast<Scalar>(kBoxSlack) * std::numeric_limits<Scalar>::epsilon() * extent;
    return {std::min(from.x(), to.x()) - reach, std::min(from.y(), to.y()) - reach,
            std::max(from.x(), to.x()) + reach, std::max(from.y(), to.y()) + reach};
}

template <typename Scalar, typename Space>
bool SweptEngine<Scalar, Space>::was_just_hit(std::uint32_t body) const {
    return now_s_ - hit_s_[body] < static_cast<Scalar>(kElasticWithin) * span_s_;
}

template class SweptEngine<double, OpenSpace<double>>;
template class SweptEngine<float, OpenSpace<float>>;
template class SweptEngine<double, TorusSpace<double>>;
template class SweptEngine<float, TorusSpace<float>>;

}  // namespace fts::physics
