#include "common/physics/swept_engine.h"

#include <algorithm>

#include "common/physics/solver_swept.h"
#include "common/physics/time_of_impact.h"

namespace fts::physics {
namespace {

// By how many units of round-off a swept box is larger than what it must hold.
constexpr double kBoxSlack = 8.0;

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
    time_s_.assign(bodies.slots(), Scalar(0));
    hit_s_.assign(bodies.slots(), -span_s);
    if constexpr (Space::kHasImages) space_.begin(*model.periodic);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::begin_stretch() {
    until_s_ = stretch_end();
    queue_.clear();
    count_.assign(bodies_->slots(), 0);
    partner_.assign(bodies_->slots(), {});
    boxes_.clear();
    for (const BodyId id : bodies_->ids) boxes_.push_back(swept_box(id.index));
    broadphase_.begin(boxes_, bodies_->slots());
    if constexpr (Space::kHasImages) space_.uncover();
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
    for (const BodyId id : bodies_->ids) {
        move_to(id.index, time_s);
        if constexpr (Space::kHasImages) {
            bodies_->position_m[id.index] = space_.home(bodies_->position_m[id.index]);
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
void SweptEngine<Scalar, Space>::place(std::uint32_t body, const Box<Scalar>& box) {
    broadphase_.place(body, box);
    space_.cover(box);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_everybody() {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        const std::uint32_t body = bodies_->ids[i].index;
        predict<false>(body, boxes_[i]);
        place(body, boxes_[i]);
    }
}

template <typename Scalar, typename Space>
template <bool kAfterSet>
void SweptEngine<Scalar, Space>::predict(std::uint32_t body, const Box<Scalar>& box) {
    space_.for_each_image(box, [&](const Box<Scalar>& moved, Image image) {
        broadphase_.for_each_near(body, moved, [&](std::uint32_t other) {
            if (!bodies_->alive[other]) return;
            const std::uint32_t a = std::min(body, other), b = std::max(body, other);
            const Image of_a = a == body ? image : -image;
            if (kAfterSet && set_.keeps_apart(a, b, separation_now(a, b, of_a))) return;
            predict_pair(a, b, of_a);
        });
    });
    if (model_->walls && !is_immovable(body)) predict_walls<kAfterSet>(body);
    if (model_->platform) predict_fall(body);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_pair(std::uint32_t a, std::uint32_t b, Image image) {
    if (partner_[a] == Partner{b, image} && partner_[b] == Partner{a, image}) return;
    if (is_immovable(a) && is_immovable(b)) return;
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
    const Scalar time = time_until_edge<Scalar>(*model_->platform, position_at(body, now_s_),
                                                bodies_->velocity_mps[body]);
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
    const Box<Scalar> box = swept_box(body);
    place(body, box);
    predict<false>(body, box);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::place_and_predict_set() {
    for (const std::uint32_t body : set_.hit_bodies()) shorten_stretch(body);
    for (const std::uint32_t body : set_.hit_bodies()) place(body, swept_box(body));
    for (const std::uint32_t body : set_.hit_bodies()) predict<true>(body, swept_box(body));
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
