#include "common/physics/solver_event.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/physics/coasting.h"
#include "common/physics/diagnostics.h"
#include "common/physics/hit_record.h"
#include "common/physics/impact.h"
#include "common/physics/periodic.h"
#include "common/physics/simultaneous.h"
#include "common/physics/solver_swept.h"

namespace fts::physics {
namespace {

// Touching is never more than this part of the reach, however coarse the coordinates.
constexpr double kTouchWithin = 0.01;

template <typename Scalar>
class EventSolver final : public Solver<Scalar> {
  public:
    DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                              Record<Scalar>& record) override;
    void forget() override { knows_bodies_ = false; }
    void synchronise_positions(Bodies<Scalar>& bodies) override;
    void synchronise_velocities(Bodies<Scalar>& bodies) override;

  private:
    using Vec = Vec2<Scalar>;
    struct Pair {
        std::uint32_t a, b;
    };

    // Bodies are numbered as in coasting_, but in together_ as in Bodies. These return how many
    // events they were.
    std::uint32_t process(const Due& due);
    std::uint32_t meet(std::uint32_t a, std::uint32_t b);
    std::uint32_t hit_wall(std::uint32_t body, std::uint32_t side);
    std::uint32_t fall(std::uint32_t body);
    std::uint32_t collide_together(const Due& due);

    void touch(std::uint32_t a, std::uint32_t b, const Vec& separation_m, Scalar slack_s);
    Scalar clock_slack_s(std::uint32_t a, std::uint32_t b) const;
    bool touch_others(std::uint32_t a, std::uint32_t b);
    bool touches_any_wall(std::uint32_t body) const;
    bool are_touching(std::uint32_t a, std::uint32_t b, const Vec& separation_m) const;
    bool touches_wall(std::uint32_t body, std::uint32_t side) const;
    Scalar extent_m(std::uint32_t body) const;
    void gather_about(std::uint32_t body);
    void join(std::uint32_t body);
    void touch_together(std::uint32_t a, std::uint32_t b);
    void show(std::uint32_t body);
    Vec present_position_m(std::uint32_t body) const;

    BodyId id_of(std::uint32_t body) const { return coasting_.id_of(body); }
    Scalar time_in_step() const;
    bool was_just_hit(std::uint32_t body) const;
    Scalar restitution_of(bool just_hit) const {
        return just_hit ? Scalar(1) : model_->restitution;
    }

    Bodies<Scalar>* bodies_ = nullptr;
    const Model<Scalar>* model_ = nullptr;
    Record<Scalar>* record_ = nullptr;
    Scalar span_s_ = Scalar(0);
    bool knows_bodies_ = false;
    bool positions_shown_ = true, velocities_shown_ = true;  // Bodies hold the present ones

    Coasting<Scalar> coasting_;
    ContactSet<Scalar> together_;
    std::vector<Pair> touching_;  // of together_
};

template <typename Scalar>
DriftReport<Scalar> EventSolver<Scalar>::drift(Bodies<Scalar>& bodies, const Model<Scalar>& model,
                                               Scalar span_s, Record<Scalar>& record) {
    bodies_ = &bodies;
    model_ = &model;
    record_ = &record;
    span_s_ = span_s;
    if (!knows_bodies_) coasting_.begin(bodies, model);
    knows_bodies_ = true;
    positions_shown_ = velocities_shown_ = false;
    DriftReport<Scalar> report;
    const std::uint32_t budget = event_budget(bodies.ids.size());
    coasting_.begin_span(static_cast<double>(span_s), budget * kTurnsPerBudgetedEvent);
    for (Due due = coasting_.next(); due.what != Happening::kNothing; due = coasting_.next()) {
        if (due.what == Happening::kUnfinished || report.events >= budget) {
            report.overrun = true;
            report.unspent_time_s = static_cast<Scalar>(coasting_.until_end_s());
            coasting_.break_span();
            return report;
        }
        coasting_.advance_to(due.time_s);
        report.events += process(due);
        coasting_.settle();
    }
    coasting_.end_span();
    return report;
}

template <typename Scalar>
void EventSolver<Scalar>::synchronise_positions(Bodies<Scalar>& bodies) {
    if (std::exchange(positions_shown_, true)) return;
    for (std::uint32_t body = 0; body < coasting_.places(); ++body) {
        const std::uint32_t index = coasting_.living_at(body);
        if (index == Coasting<Scalar>::kNobody) continue;
        const Vec position = coasting_.position_m(body);
        bodies.position_m[index] =
            model_->periodic ? wrapped<Scalar>(position, *model_->periodic) : position;
    }
}

template <typename Scalar>
void EventSolver<Scalar>::synchronise_velocities(Bodies<Scalar>& bodies) {
    if (std::exchange(velocities_shown_, true)) return;
    for (std::uint32_t body = 0; body < coasting_.places(); ++body) {
        const std::uint32_t index = coasting_.living_at(body);
        if (index == Coasting<Scalar>::kNobody) continue;
        bodies.velocity_mps[index] = coasting_.flight(body).velocity_mps;
    }
}

template <typename Scalar>
std::uint32_t EventSolver<Scalar>::process(const Due& due) {
    switch (due.what) {
        case Happening::kMeeting:
            return touch_others(due.body, due.other) ? collide_together(due)
                                                     : meet(due.body, due.other);
        case Happening::kWall:
            return touch_others(due.body, due.body) ? collide_together(due)
                                                    : hit_wall(due.body, due.other);
        case Happening::kFall:
            return fall(due.body);
        case Happening::kNothing:
        case Happening::kUnfinished:
            break;
    }
    return 0;
}

// A grazing pair may turn out, to the last bit, not to approach any more; then nothing happens.
template <typename Scalar>
std::uint32_t EventSolver<Scalar>::meet(std::uint32_t due, std::uint32_t other) {
    const bool in_order = coasting_.index_of(due) < coasting_.index_of(other);
    const std::uint32_t a = in_order ? due : other, b = in_order ? other : due;
    const Scalar slack_s = clock_slack_s(a, b);
    coasting_.move_to_now(a);
    coasting_.move_to_now(b);
    const Vec velocity_a = coasting_.flight(a).velocity_mps;
    const Vec velocity_b = coasting_.flight(b).velocity_mps;
    const Vec met_at = coasting_.separation_m(a, b);
    if (!(met_at.dot(velocity_a - velocity_b) < Scalar(0))) {
        coasting_.predict(due);
        return 0;
    }
    const Scalar radius_a = coasting_.flight(a).radius_m, radius_b = coasting_.flight(b).radius_m;
    const Scalar depth = penetration(met_at.norm(), radius_a, radius_b);
    touch(a, b, met_at, slack_s);
    const Vec separation = coasting_.separation_m(a, b);
    const Mover<Scalar> first{separation, velocity_a, coasting_.mass_kg(a)};
    const Mover<Scalar> second{Vec::Zero(), velocity_b, coasting_.mass_kg(b)};
    const auto hit = impact(first, second, restitution_of(was_just_hit(a) || was_just_hit(b)));
    if (!hit) {
        coasting_.predict(due);
        return 0;
    }
    const Vec position = present_position_m(a);
    record_->contacts.push_back(
        {id_of(a), id_of(b), time_in_step(), position - radius_a * hit->normal, hit->normal,
         hit->impulse_ns, position, position - separation, velocity_a, hit->velocity_1_mps,
         velocity_b, hit->velocity_2_mps, first.mass_kg, second.mass_kg, depth});
    account(record_->contacts.back(), record_->audit);
    coasting_.turn(a, hit->velocity_1_mps);
    coasting_.turn(b, hit->velocity_2_mps);
    coasting_.keep_apart(a, b);
    if (coasting_.is_immovable(other)) {
        coasting_.predict_as_seen(due);
    } else {
        coasting_.predict_as_seen(due, other);
    }
    return 1;
}

template <typename Scalar>
std::uint32_t EventSolver<Scalar>::hit_wall(std::uint32_t body, std::uint32_t side) {
    const std::uint32_t axis = side / 2;
    const bool at_max = side % 2 == 1;
    const Scalar radius = coasting_.flight(body).radius_m;
    Vec position = coasting_.position_m(body);
    position[axis] =
        at_max ? model_->walls->max_m[axis] - radius : model_->walls->min_m[axis] + radius;
    const Vec before = coasting_.flight(body).velocity_mps;
    Vec after = before;
    after[axis] *= -restitution_of(was_just_hit(body));
    Vec normal = Vec::Zero();
    normal[axis] = at_max ? Scalar(-1) : Scalar(1);
    const Scalar mass = coasting_.mass_kg(body);
    record_->contacts.push_back(
        {id_of(body), std::nullopt, time_in_step(), position - radius * normal, normal,
         mass * std::abs(after[axis] - before[axis]), position, position - radius * normal, before,
         after, Vec::Zero(), Vec::Zero(), mass, std::numeric_limits<Scalar>::infinity()});
    account(record_->contacts.back(), record_->audit);
    coasting_.set_position(body, position);
    coasting_.turn(body, after);
    coasting_.predict_as_seen(body);
    return 1;
}

template <typename Scalar>
std::uint32_t EventSolver<Scalar>::fall(std::uint32_t body) {
    record_->falls.push_back({id_of(body), time_in_step(), coasting_.position_m(body),
                              coasting_.flight(body).velocity_mps});
    coasting_.remove(body);
    bodies_->remove(coasting_.index_of(body));
    return 1;
}

template <typename Scalar>
std::uint32_t EventSolver<Scalar>::collide_together(const Due& due) {
    const auto body_at = [&](std::uint32_t index) { return coasting_.body_at(index); };
    together_.begin(bodies_->slots());
    touching_.clear();
    join(due.body);
    if (due.what == Happening::kMeeting) {
        join(due.other);
        touch_together(due.body, due.other);
    } else {
        together_.touch_wall(coasting_.index_of(due.body), due.other);
    }
    const Resolution done = together_.resolve(
        model_->restitution, [&](std::uint32_t index) { gather_about(body_at(index)); },
        [&](std::span<const Hit<Scalar>> hits) {
            record_hits(*bodies_, time_in_step(), hits, *record_);
        });
    const auto hit_bodies = together_.hit_bodies();
    for (const std::uint32_t index : hit_bodies) {
        const std::uint32_t body = body_at(index);
        if (!coasting_.is_immovable(body)) coasting_.move_to_now(body);
        coasting_.turn(body, together_.velocity_mps(index));
        for (std::uint32_t side = 0; side < 4; ++side) {
            if (together_.keeps_off_wall(index, side)) coasting_.keep_off_wall(body, side);
        }
    }
    for (const auto [a, b] : touching_) {
        if (together_.keeps_apart(coasting_.index_of(a), coasting_.index_of(b),
                                  coasting_.separation_m(a, b))) {
            coasting_.keep_apart(a, b);
        }
    }
    if (due.what == Happening::kWall &&
        together_.keeps_off_wall(coasting_.index_of(due.body), due.other)) {
        coasting_.keep_off_wall(due.body, due.other);
    }
    for (const std::uint32_t index : hit_bodies) {
        const std::uint32_t body = body_at(index);
        if (body != due.body && !coasting_.is_immovable(body)) coasting_.predict(body);
    }
    coasting_.predict(due.body);
    return done.hits;
}

template <typename Scalar>
void EventSolver<Scalar>::gather_about(std::uint32_t body) {
    coasting_.for_each_near(body, [&](std::uint32_t other, const Vec& separation) {
        if (other == body || !are_touching(body, other, separation)) return;
        if (coasting_.is_immovable(body) && coasting_.is_immovable(other)) return;
        join(other);
        touch_together(body, other);
    });
    for (std::uint32_t side = 0; side < 4; ++side) {
        if (touches_wall(body, side)) together_.touch_wall(coasting_.index_of(body), side);
    }
}

template <typename Scalar>
void EventSolver<Scalar>::join(std::uint32_t body) {
    together_.add(coasting_.index_of(body), coasting_.flight(body).velocity_mps,
                  coasting_.mass_kg(body), was_just_hit(body));
    show(body);
}

template <typename Scalar>
void EventSolver<Scalar>::touch_together(std::uint32_t a, std::uint32_t b) {
    touching_.push_back({a, b});
    together_.touch(coasting_.index_of(a), coasting_.index_of(b), coasting_.separation_m(a, b));
}

// For the record: where the body is now.
template <typename Scalar>
void EventSolver<Scalar>::show(std::uint32_t body) {
    bodies_->position_m[coasting_.index_of(body)] = present_position_m(body);
}

template <typename Scalar>
Vec2<Scalar> EventSolver<Scalar>::present_position_m(std::uint32_t body) const {
    const Vec position = coasting_.position_m(body);
    return model_->periodic ? wrapped<Scalar>(position, *model_->periodic) : position;
}

// After moving to the time of impact, which is only as fine as the clock, the pair is moved on
// along its own velocities until it just touches.
template <typename Scalar>
void EventSolver<Scalar>::touch(std::uint32_t a, std::uint32_t b, const Vec& separation_m,
                                Scalar slack_s) {
    const Vec& d = separation_m;
    const auto &first = coasting_.flight(a), &second = coasting_.flight(b);
    const Scalar distance = d.norm();
    const Scalar closing = -d.dot(first.velocity_mps - second.velocity_mps) / distance;
    const Scalar gap = distance - (first.radius_m + second.radius_m);
    if (!(std::abs(gap) <= closing * slack_s)) return;
    const Scalar wait_s = gap / closing;
    coasting_.set_position(a, first.position_m + first.velocity_mps * wait_s);
    coasting_.set_position(b, second.position_m + second.velocity_mps * wait_s);
}

// Before the two are moved: the time of impact was counted from the later of their last events, and
// their ways from each one's own.
template <typename Scalar>
Scalar EventSolver<Scalar>::clock_slack_s(std::uint32_t a, std::uint32_t b) const {
    const double flown_s = coasting_.flown_s(a) + coasting_.flown_s(b);
    const double slack_s = flown_s * static_cast<double>(std::numeric_limits<Scalar>::epsilon()) +
                           coasting_.clock_s() * std::numeric_limits<double>::epsilon();
    return static_cast<Scalar>(kClockSlack * slack_s);
}

// Whether two that meet, or one that hits a wall, touch anything else.
template <typename Scalar>
bool EventSolver<Scalar>::touch_others(std::uint32_t a, std::uint32_t b) {
    constexpr Scalar kFactor = static_cast<Scalar>(1.0 + 2.0 * kTouchWithin);
    const auto touches = [&](std::uint32_t body, std::uint32_t other, const Vec& separation) {
        return are_touching(body, other, separation);
    };
    if (a == b) return coasting_.look_around(a, kFactor, touches);
    return touches_any_wall(a) || touches_any_wall(b) ||
           coasting_.look_around_both(a, b, kFactor, touches);
}

template <typename Scalar>
bool EventSolver<Scalar>::touches_any_wall(std::uint32_t body) const {
    if (!model_->walls || !coasting_.is_at_border(body)) return false;
    for (std::uint32_t side = 0; side < 4; ++side) {
        if (touches_wall(body, side)) return true;
    }
    return false;
}

template <typename Scalar>
bool EventSolver<Scalar>::are_touching(std::uint32_t a, std::uint32_t b,
                                       const Vec& separation_m) const {
    constexpr Scalar kFar = static_cast<Scalar>((1.0 + kTouchWithin) * (1.0 + kTouchWithin));
    const Scalar reach = coasting_.flight(a).radius_m + coasting_.flight(b).radius_m;
    const Scalar squared = separation_m.squaredNorm();
    if (squared > kFar * reach * reach) return false;
    const Scalar extent = std::max(extent_m(a), extent_m(b));
    const Scalar tolerance =
        std::min(touch_tolerance_m(reach, extent), static_cast<Scalar>(kTouchWithin) * reach);
    return std::abs(std::sqrt(squared) - reach) <= tolerance;
}

template <typename Scalar>
bool EventSolver<Scalar>::touches_wall(std::uint32_t body, std::uint32_t side) const {
    if (!model_->walls) return false;
    const std::uint32_t axis = side / 2;
    const Scalar radius = coasting_.flight(body).radius_m;
    const Scalar position = coasting_.position_m(body)[axis];
    const Scalar gap = side % 2 == 0 ? position - (model_->walls->min_m[axis] + radius)
                                     : (model_->walls->max_m[axis] - radius) - position;
    return std::abs(gap) <= touch_tolerance_m(radius, extent_m(body));
}

// The largest length that went into the body's place.
template <typename Scalar>
Scalar EventSolver<Scalar>::extent_m(std::uint32_t body) const {
    return std::max(coasting_.flight(body).position_m.cwiseAbs().maxCoeff(),
                    coasting_.position_m(body).cwiseAbs().maxCoeff());
}

template <typename Scalar>
Scalar EventSolver<Scalar>::time_in_step() const {
    return std::clamp(static_cast<Scalar>(coasting_.since_begin_s()), Scalar(0), span_s_);
}

template <typename Scalar>
bool EventSolver<Scalar>::was_just_hit(std::uint32_t body) const {
    return model_->restitution < Scalar(1) &&
           coasting_.last_hit_ago_s(body) < kElasticWithin * static_cast<double>(span_s_);
}

}  // namespace

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_event_solver() {
    return std::make_unique<EventSolver<Scalar>>();
}

template std::unique_ptr<Solver<double>> make_event_solver();
template std::unique_ptr<Solver<float>> make_event_solver();

}  // namespace fts::physics
