#include "common/physics/swept_engine.h"

#include <algorithm>

#include "common/physics/solver_swept.h"

namespace fts::physics {
namespace {

// By how many units of the span's round-off a look sees further than it is for.
constexpr double kSeenSlack = 16.0;
constexpr std::uint32_t kMostLooks = 32;
constexpr double kWayOfALook = 0.4;  // of a radius
// One look is enough for so few, and so many are asked how far they move.
constexpr std::size_t kFewBodies = 64;

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
    if constexpr (!Space::kHasImages) sight_.meetings.resize(2 * std::size_t{slots});
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

template class SweptEngine<double, OpenSpace<double>>;
template class SweptEngine<float, OpenSpace<float>>;
template class SweptEngine<double, TorusSpace<double>>;
template class SweptEngine<float, TorusSpace<float>>;

}  // namespace fts::physics
