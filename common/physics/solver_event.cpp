#include "common/physics/solver_event.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/physics/coasting.h"
#include "common/physics/crowd_coasting.h"
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
constexpr Scalar kLookFactor = static_cast<Scalar>(1.0 + 2.0 * kTouchWithin);

template <typename Scalar, typename Future>
class EventSolver final : public Solver<Scalar> {
  public:
    // False when it is not for such bodies.
    bool take_over(const Bodies<Scalar>& bodies, const Model<Scalar>& model) {
        return coasting_.begin(bodies, model);
    }
    DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                              Record<Scalar>& record) override;
    void synchronise_positions(Bodies<Scalar>& bodies) override;
    void synchronise_velocities(Bodies<Scalar>& bodies) override;

  private:
    using Vec = Vec2<Scalar>;
    using Flight = physics::Flight<Scalar>;
    struct Pair {
        std::uint32_t a, b;
    };

    // Bodies are numbered as in coasting_, but in together_ as in Bodies. These return how many
    // events they were.
    std::uint32_t process(const Due& due);
    std::uint32_t meet(const Due& due);
    std::uint32_t hit_wall(std::uint32_t body, std::uint32_t side);
    std::uint32_t fall(std::uint32_t body);
    std::uint32_t collide_together(const Due& due);

    static void touch(Turning<Scalar>& first, Turning<Scalar>& second, const Vec& separation_m,
                      Scalar reach_m, Scalar slack_s);
    Scalar clock_slack_s(std::uint32_t a, std::uint32_t b) const;
    auto touching() const {
        return [this](std::uint32_t one, std::uint32_t other, const Vec& separation_m) {
            return are_touching(one, other, separation_m);
        };
    }
    bool touches_others(std::uint32_t body);
    bool touch_others(const Turning<Scalar>& a, const Turning<Scalar>& b);
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
    bool positions_shown_ = true, velocities_shown_ = true;  // Bodies hold the present ones

    Future coasting_;
    ContactSet<Scalar> together_;
    std::vector<Pair> touching_;  // of together_
};

template <typename Scalar, typename Future>
DriftReport<Scalar> EventSolver<Scalar, Future>::drift(Bodies<Scalar>& bodies,
                                                       const Model<Scalar>& model, Scalar span_s,
                                                       Record<Scalar>& record) {
    bodies_ = &bodies;
    model_ = &model;
    record_ = &record;
    span_s_ = span_s;
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

template <typename Scalar, typename Future>
void EventSolver<Scalar, Future>::synchronise_positions(Bodies<Scalar>& bodies) {
    if (std::exchange(positions_shown_, true)) return;
    for (std::uint32_t body = 0; body < coasting_.places(); ++body) {
        const std::uint32_t index = coasting_.living_at(body);
        if (index == kNobody) continue;
        const Vec position = coasting_.position_m(body);
        bodies.position_m[index] =
            model_->periodic ? wrapped<Scalar>(position, *model_->periodic) : position;
    }
}

template <typename Scalar, typename Future>
void EventSolver<Scalar, Future>::synchronise_velocities(Bodies<Scalar>& bodies) {
    if (std::exchange(velocities_shown_, true)) return;
    for (std::uint32_t body = 0; body < coasting_.places(); ++body) {
        const std::uint32_t index = coasting_.living_at(body);
        if (index == kNobody) continue;
        bodies.velocity_mps[index] = coasting_.flight(body).velocity_mps;
    }
}

template <typename Scalar, typename Future>
std::uint32_t EventSolver<Scalar, Future>::process(const Due& due) {
    switch (due.what) {
        case Happening::kMeeting:
            return meet(due);
        case Happening::kWall:
            return touches_others(due.body) ? collide_together(due) : hit_wall(due.body, due.other);
        case Happening::kFall:
            return fall(due.body);
        case Happening::kNothing:
        case Happening::kUnfinished:
            break;
    }
    return 0;
}

// What a collision would do is found first, and nothing is changed before it is known that they
// touch nobody else. A grazing pair may turn out, to the last bit, not to approach any more; then
// nothing happens.
template <typename Scalar, typename Future>
std::uint32_t EventSolver<Scalar, Future>::meet(const Due& due) {
    // Of the one that is first in the order of indices, and of the other.
    const bool in_order = coasting_.index_of(due.body) < coasting_.index_of(due.other);
    const std::uint32_t pair[] = {due.body, due.other};
    const std::uint32_t a = pair[in_order ? 0 : 1], b = pair[in_order ? 1 : 0];
    const Flight &flight_a = coasting_.flight(a), &flight_b = coasting_.flight(b);
    const Vec velocity_a = flight_a.velocity_mps, velocity_b = flight_b.velocity_mps;
    const Scalar radius_a = flight_a.radius_m, reach = radius_a + flight_b.radius_m;
    Turning<Scalar> turns[] = {{a, coasting_.position_m(a), velocity_a},
                               {b, coasting_.position_m(b), velocity_b}};
    const Vec met_at = coasting_.separation_m(turns[0].position_m, turns[1].position_m);
    const Scalar depth = penetration(met_at.norm(), radius_a, flight_b.radius_m);
    Vec separation = met_at;
    if (met_at.dot(velocity_a - velocity_b) < Scalar(0)) {
        touch(turns[0], turns[1], met_at, reach, clock_slack_s(a, b));
        separation = coasting_.separation_m(turns[0].position_m, turns[1].position_m);
    }
    const Mover<Scalar> first{separation, velocity_a, coasting_.mass_kg(a)};
    const Mover<Scalar> second{Vec::Zero(), velocity_b, coasting_.mass_kg(b)};
    const auto hit = impact(first, second, restitution_of(was_just_hit(a) || was_just_hit(b)));
    if (hit) {
        turns[0].velocity_mps = hit->velocity_1_mps;
        turns[1].velocity_mps = hit->velocity_2_mps;
    }
    if (touch_others(turns[in_order ? 0 : 1], turns[in_order ? 1 : 0])) {
        return collide_together(due);
    }
    coasting_.set_position(a, turns[0].position_m);
    coasting_.set_position(b, turns[1].position_m);
    if (!hit) {
        coasting_.predict(due.body);
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
    if (coasting_.is_immovable(due.other)) {
        coasting_.predict_as_seen(due.body);
    } else {
        coasting_.predict_as_seen(due.body, due.other);
    }
    return 1;
}

template <typename Scalar, typename Future>
std::uint32_t EventSolver<Scalar, Future>::hit_wall(std::uint32_t body, std::uint32_t side) {
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

template <typename Scalar, typename Future>
std::uint32_t EventSolver<Scalar, Future>::fall(std::uint32_t body) {
    record_->falls.push_back({id_of(body), time_in_step(), coasting_.position_m(body),
                              coasting_.flight(body).velocity_mps});
    coasting_.remove(body);
    bodies_->remove(coasting_.index_of(body));
    return 1;
}

template <typename Scalar, typename Future>
std::uint32_t EventSolver<Scalar, Future>::collide_together(const Due& due) {
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

template <typename Scalar, typename Future>
void EventSolver<Scalar, Future>::gather_about(std::uint32_t body) {
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

template <typename Scalar, typename Future>
void EventSolver<Scalar, Future>::join(std::uint32_t body) {
    together_.add(coasting_.index_of(body), coasting_.flight(body).velocity_mps,
                  coasting_.mass_kg(body), was_just_hit(body));
    show(body);
}

template <typename Scalar, typename Future>
void EventSolver<Scalar, Future>::touch_together(std::uint32_t a, std::uint32_t b) {
    touching_.push_back({a, b});
    together_.touch(coasting_.index_of(a), coasting_.index_of(b), coasting_.separation_m(a, b));
}

// For the record: where the body is now.
template <typename Scalar, typename Future>
void EventSolver<Scalar, Future>::show(std::uint32_t body) {
    bodies_->position_m[coasting_.index_of(body)] = present_position_m(body);
}

template <typename Scalar, typename Future>
Vec2<Scalar> EventSolver<Scalar, Future>::present_position_m(std::uint32_t body) const {
    const Vec position = coasting_.position_m(body);
    return model_->periodic ? wrapped<Scalar>(position, *model_->periodic) : position;
}

// After moving to the time of impact, which is only as fine as the clock, the pair is moved on
// along its own velocities until it just touches.
template <typename Scalar, typename Future>
inline void EventSolver<Scalar, Future>::touch(Turning<Scalar>& first, Turning<Scalar>& second,
                                               const Vec& separation_m, Scalar reach_m,
                                               Scalar slack_s) {
    const Vec& d = separation_m;
    const Scalar distance = d.norm();
    const Scalar closing = -d.dot(first.velocity_mps - second.velocity_mps) / distance;
    const Scalar gap = distance - reach_m;
    if (!(std::abs(gap) <= closing * slack_s)) return;
    const Scalar wait_s = gap / closing;
    first.position_m += first.velocity_mps * wait_s;
    second.position_m += second.velocity_mps * wait_s;
}

// Before the two are moved: the time of impact was counted from the later of their last events, and
// their ways from each one's own.
template <typename Scalar, typename Future>
Scalar EventSolver<Scalar, Future>::clock_slack_s(std::uint32_t a, std::uint32_t b) const {
    const double flown_s = coasting_.flown_s(a) + coasting_.flown_s(b);
    const double slack_s = flown_s * static_cast<double>(std::numeric_limits<Scalar>::epsilon()) +
                           coasting_.clock_s() * std::numeric_limits<double>::epsilon();
    return static_cast<Scalar>(kClockSlack * slack_s);
}

// Whether one that hits a wall touches anybody.
template <typename Scalar, typename Future>
bool EventSolver<Scalar, Future>::touches_others(std::uint32_t body) {
    return coasting_.look_around(body, kLookFactor<Scalar>, touching());
}

// Whether two that meet, and would fly on like this, touch anything else.
template <typename Scalar, typename Future>
bool EventSolver<Scalar, Future>::touch_others(const Turning<Scalar>& a, const Turning<Scalar>& b) {
    return touches_any_wall(a.body) || touches_any_wall(b.body) ||
           coasting_.look_around_both(a, b, kLookFactor<Scalar>, touching());
}

template <typename Scalar, typename Future>
bool EventSolver<Scalar, Future>::touches_any_wall(std::uint32_t body) const {
    if (!model_->walls || !coasting_.is_at_border(body)) return false;
    for (std::uint32_t side = 0; side < 4; ++side) {
        if (touches_wall(body, side)) return true;
    }
    return false;
}

template <typename Scalar, typename Future>
bool EventSolver<Scalar, Future>::are_touching(std::uint32_t a, std::uint32_t b,
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

template <typename Scalar, typename Future>
bool EventSolver<Scalar, Future>::touches_wall(std::uint32_t body, std::uint32_t side) const {
    if (!model_->walls) return false;
    const std::uint32_t axis = side / 2;
    const Scalar radius = coasting_.flight(body).radius_m;
    const Scalar position = coasting_.position_m(body)[axis];
    const Scalar gap = side % 2 == 0 ? position - (model_->walls->min_m[axis] + radius)
                                     : (model_->walls->max_m[axis] - radius) - position;
    return std::abs(gap) <= touch_tolerance_m(radius, extent_m(body));
}

// The largest length that went into the body's place.
template <typename Scalar, typename Future>
Scalar EventSolver<Scalar, Future>::extent_m(std::uint32_t body) const {
    return std::max(coasting_.flight(body).position_m.cwiseAbs().maxCoeff(),
                    coasting_.position_m(body).cwiseAbs().maxCoeff());
}

template <typename Scalar, typename Future>
Scalar EventSolver<Scalar, Future>::time_in_step() const {
    return std::clamp(static_cast<Scalar>(coasting_.since_begin_s()), Scalar(0), span_s_);
}

template <typename Scalar, typename Future>
bool EventSolver<Scalar, Future>::was_just_hit(std::uint32_t body) const {
    return model_->restitution < Scalar(1) &&
           coasting_.last_hit_ago_s(body) < kElasticWithin * static_cast<double>(span_s_);
}

// For what there is now: a crowd in windows of time, others with a calendar.
template <typename Scalar>
class EventSolverOfAll final : public Solver<Scalar> {
  public:
    explicit EventSolverOfAll(Foresight foresight) : foresight_(foresight) {}

    DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                              Record<Scalar>& record) override {
        if (present_ == nullptr) present_ = &suitable(bodies, model);
        return present_->drift(bodies, model, span_s, record);
    }
    void forget() override { present_ = nullptr; }
    void synchronise_positions(Bodies<Scalar>& bodies) override {
        if (present_ != nullptr) present_->synchronise_positions(bodies);
    }
    void synchronise_velocities(Bodies<Scalar>& bodies) override {
        if (present_ != nullptr) present_->synchronise_velocities(bodies);
    }

  private:
    Solver<Scalar>& suitable(const Bodies<Scalar>& bodies, const Model<Scalar>& model) {
        if (foresight_ == Foresight::kSuitable && of_crowds_.take_over(bodies, model)) {
            return of_crowds_;
        }
        of_any_.take_over(bodies, model);
        return of_any_;
    }

    Foresight foresight_;
    EventSolver<Scalar, CrowdCoasting<Scalar>> of_crowds_;
    EventSolver<Scalar, Coasting<Scalar>> of_any_;
    Solver<Scalar>* present_ = nullptr;
};

}  // namespace

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_event_solver(Foresight foresight) {
    return std::make_unique<EventSolverOfAll<Scalar>>(foresight);
}

template std::unique_ptr<Solver<double>> make_event_solver(Foresight);
template std::unique_ptr<Solver<float>> make_event_solver(Foresight);

}  // namespace fts::physics
