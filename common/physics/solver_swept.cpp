#include "common/physics/solver_swept.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/physics/broadphase.h"
#include "common/physics/diagnostics.h"
#include "common/physics/event_queue.h"
#include "common/physics/impact.h"
#include "common/physics/time_of_impact.h"

namespace fts::physics {
namespace {

// In units of the span's round-off.
constexpr double kClockSlack = 8.0;
// By how many units of round-off a swept box is larger than what it must hold.
constexpr double kBoxSlack = 8.0;
// A part of the span: what was hit less long ago is hit elastically.
constexpr double kElasticWithin = 1e-3;
constexpr std::uint32_t kNobody = 0xffffffff;

template <typename Scalar>
class SweptSolver final : public Solver<Scalar> {
  public:
    DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                              Record<Scalar>& record) override;

  private:
    using Vec = Vec2<Scalar>;

    void begin(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
               Record<Scalar>& record);
    void predict_everybody();
    void predict(std::uint32_t body, const Box<Scalar>& box);
    void predict_pair(std::uint32_t a, std::uint32_t b);
    void predict_walls(std::uint32_t body);
    void predict_fall(std::uint32_t body);
    void expect(const Event<Scalar>& event);
    bool is_stale(const Event<Scalar>& event) const;
    bool process(const Event<Scalar>& event);
    bool collide_pair(std::uint32_t a, std::uint32_t b);
    void collide_wall(std::uint32_t body, std::uint32_t side);
    void fall(std::uint32_t body);
    void after_event(std::uint32_t body, std::uint32_t partner);
    void place_and_predict(std::uint32_t body);
    void touch(std::uint32_t a, std::uint32_t b);
    void advance_everybody(Scalar time_s);

    Vec position_at(std::uint32_t body, Scalar time_s) const;
    void move_to(std::uint32_t body, Scalar time_s);
    Box<Scalar> swept_box(std::uint32_t body) const;
    bool is_immovable(std::uint32_t body) const;
    bool was_just_hit(std::uint32_t body) const;
    Scalar restitution_of(bool just_hit) const;

    Bodies<Scalar>* bodies_ = nullptr;
    const Model<Scalar>* model_ = nullptr;
    Record<Scalar>* record_ = nullptr;
    Scalar span_s_ = Scalar(0);
    Scalar now_s_ = Scalar(0);

    std::vector<Scalar> time_s_;          // by body: when its position holds
    std::vector<std::uint32_t> count_;    // by body: events so far
    std::vector<std::uint32_t> partner_;  // by body: whom it hit last, if nothing happened since
    std::vector<Scalar> hit_s_;           // by body: the last collision
    std::vector<Box<Scalar>> boxes_;
    EventQueue<Scalar> queue_;
    Broadphase<Scalar> broadphase_;
};

template <typename Scalar>
DriftReport<Scalar> SweptSolver<Scalar>::drift(Bodies<Scalar>& bodies, const Model<Scalar>& model,
                                               Scalar span_s, Record<Scalar>& record) {
    begin(bodies, model, span_s, record);
    predict_everybody();
    DriftReport<Scalar> report;
    const std::uint32_t budget = event_budget(bodies.ids.size());
    while (!queue_.empty()) {
        const Event<Scalar> event = queue_.pop();
        if (is_stale(event)) continue;
        if (report.events == budget) {
            report.overrun = true;
            report.unspent_time_s = span_s - now_s_;
            advance_everybody(now_s_);
            return report;
        }
        now_s_ = event.time_s;
        if (process(event)) ++report.events;
    }
    advance_everybody(span_s);
    return report;
}

template <typename Scalar>
void SweptSolver<Scalar>::begin(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                                Record<Scalar>& record) {
    bodies_ = &bodies;
    model_ = &model;
    record_ = &record;
    span_s_ = span_s;
    now_s_ = Scalar(0);
    queue_.clear();
    time_s_.assign(bodies.slots(), Scalar(0));
    count_.assign(bodies.slots(), 0);
    partner_.assign(bodies.slots(), kNobody);
    hit_s_.assign(bodies.slots(), -span_s);
    boxes_.clear();
    for (const BodyId id : bodies.ids) boxes_.push_back(swept_box(id.index));
    broadphase_.begin(boxes_, bodies.slots());
}

template <typename Scalar>
void SweptSolver<Scalar>::predict_everybody() {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        const std::uint32_t body = bodies_->ids[i].index;
        predict(body, boxes_[i]);
        broadphase_.place(body, boxes_[i]);
    }
}

template <typename Scalar>
void SweptSolver<Scalar>::predict(std::uint32_t body, const Box<Scalar>& box) {
    broadphase_.for_each_near(body, box, [&](std::uint32_t other) {
        if (bodies_->alive[other]) predict_pair(std::min(body, other), std::max(body, other));
    });
    if (model_->walls && !is_immovable(body)) predict_walls(body);
    if (model_->platform) predict_fall(body);
}

template <typename Scalar>
void SweptSolver<Scalar>::predict_pair(std::uint32_t a, std::uint32_t b) {
    if (partner_[a] == b && partner_[b] == a) return;
    if (is_immovable(a) && is_immovable(b)) return;
    const Vec separation = position_at(a, now_s_) - position_at(b, now_s_);
    const Vec velocity = bodies_->velocity_mps[a] - bodies_->velocity_mps[b];
    const Scalar reach = bodies_->radius_m[a] + bodies_->radius_m[b];
    expect({now_s_ + time_until_contact(separation, velocity, reach), EventKind::kBall, a, b,
            count_[a], count_[b]});
}

template <typename Scalar>
void SweptSolver<Scalar>::predict_walls(std::uint32_t body) {
    const Vec position = position_at(body, now_s_);
    const Vec& velocity = bodies_->velocity_mps[body];
    const Scalar radius = bodies_->radius_m[body];
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        const Scalar below = position[axis] - (model_->walls->min_m[axis] + radius);
        const Scalar above = (model_->walls->max_m[axis] - radius) - position[axis];
        expect({now_s_ + time_until_wall(below, -velocity[axis]), EventKind::kWall, body, 2 * axis,
                count_[body], 0});
        expect({now_s_ + time_until_wall(above, velocity[axis]), EventKind::kWall, body,
                2 * axis + 1, count_[body], 0});
    }
}

template <typename Scalar>
void SweptSolver<Scalar>::predict_fall(std::uint32_t body) {
    const Scalar time = time_until_edge<Scalar>(*model_->platform, position_at(body, now_s_),
                                                bodies_->velocity_mps[body]);
    expect({now_s_ + time, EventKind::kFall, body, 0, count_[body], 0});
}

template <typename Scalar>
void SweptSolver<Scalar>::expect(const Event<Scalar>& event) {
    if (event.time_s <= span_s_) queue_.push(event);
}

template <typename Scalar>
bool SweptSolver<Scalar>::is_stale(const Event<Scalar>& event) const {
    return event.count_a != count_[event.a] ||
           (event.kind == EventKind::kBall && event.count_b != count_[event.b]);
}

template <typename Scalar>
bool SweptSolver<Scalar>::process(const Event<Scalar>& event) {
    switch (event.kind) {
        case EventKind::kBall:
            return collide_pair(event.a, event.b);
        case EventKind::kWall:
            collide_wall(event.a, event.b);
            return true;
        case EventKind::kFall:
            fall(event.a);
            return true;
    }
    return false;
}

// A grazing pair may turn out, to the last bit, not to approach any more; then nothing happens.
template <typename Scalar>
bool SweptSolver<Scalar>::collide_pair(std::uint32_t a, std::uint32_t b) {
    Bodies<Scalar>& all = *bodies_;
    const Vec position_a = position_at(a, now_s_);
    const Vec position_b = position_at(b, now_s_);
    if (!((position_a - position_b).dot(all.velocity_mps[a] - all.velocity_mps[b]) < Scalar(0))) {
        return false;
    }
    move_to(a, now_s_);
    move_to(b, now_s_);
    touch(a, b);
    const Mover<Scalar> first{all.position_m[a], all.velocity_mps[a], all.mass_kg[a]};
    const Mover<Scalar> second{all.position_m[b], all.velocity_mps[b], all.mass_kg[b]};
    const Scalar restitution = restitution_of(was_just_hit(a) || was_just_hit(b));
    if (const auto hit = impact(first, second, restitution)) {
        all.velocity_mps[a] = hit->velocity_1_mps;
        all.velocity_mps[b] = hit->velocity_2_mps;
        record_->contacts.push_back({all.id_of(a), all.id_of(b), now_s_,
                                     first.position_m - all.radius_m[a] * hit->normal, hit->normal,
                                     hit->impulse_ns, first.position_m, second.position_m,
                                     first.velocity_mps, hit->velocity_1_mps, second.velocity_mps,
                                     hit->velocity_2_mps, first.mass_kg, second.mass_kg});
        account(record_->contacts.back(), record_->audit);
    }
    after_event(a, b);
    after_event(b, a);
    place_and_predict(a);
    place_and_predict(b);
    return true;
}

template <typename Scalar>
void SweptSolver<Scalar>::collide_wall(std::uint32_t body, std::uint32_t side) {
    Bodies<Scalar>& all = *bodies_;
    move_to(body, now_s_);
    const std::uint32_t axis = side / 2;
    const bool at_max = side % 2 == 1;
    const Scalar radius = all.radius_m[body];
    Vec& position = all.position_m[body];
    Vec& velocity = all.velocity_mps[body];
    const Vec before = velocity;
    position[axis] =
        at_max ? model_->walls->max_m[axis] - radius : model_->walls->min_m[axis] + radius;
    velocity[axis] *= -restitution_of(was_just_hit(body));
    Vec normal = Vec::Zero();
    normal[axis] = at_max ? Scalar(-1) : Scalar(1);
    const Scalar impulse = all.mass_kg[body] * std::abs(velocity[axis] - before[axis]);
    record_->contacts.push_back({all.id_of(body), std::nullopt, now_s_, position - radius * normal,
                                 normal, impulse, position, position - radius * normal, before,
                                 velocity, Vec::Zero(), Vec::Zero(), all.mass_kg[body],
                                 std::numeric_limits<Scalar>::infinity()});
    account(record_->contacts.back(), record_->audit);
    after_event(body, kNobody);
    place_and_predict(body);
}

template <typename Scalar>
void SweptSolver<Scalar>::fall(std::uint32_t body) {
    move_to(body, now_s_);
    record_->falls.push_back(
        {bodies_->id_of(body), now_s_, bodies_->position_m[body], bodies_->velocity_mps[body]});
    bodies_->remove(body);
    after_event(body, kNobody);
}

template <typename Scalar>
void SweptSolver<Scalar>::after_event(std::uint32_t body, std::uint32_t partner) {
    ++count_[body];
    partner_[body] = partner;
    hit_s_[body] = now_s_;
}

template <typename Scalar>
void SweptSolver<Scalar>::place_and_predict(std::uint32_t body) {
    const Box<Scalar> box = swept_box(body);
    broadphase_.place(body, box);
    predict(body, box);
}

template <typename Scalar>
void SweptSolver<Scalar>::touch(std::uint32_t a, std::uint32_t b) {
    Bodies<Scalar>& all = *bodies_;
    const Vec d = all.position_m[a] - all.position_m[b];
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

template <typename Scalar>
void SweptSolver<Scalar>::advance_everybody(Scalar time_s) {
    for (const BodyId id : bodies_->ids) move_to(id.index, time_s);
}

template <typename Scalar>
Vec2<Scalar> SweptSolver<Scalar>::position_at(std::uint32_t body, Scalar time_s) const {
    const Vec& position = bodies_->position_m[body];
    const Vec& velocity = bodies_->velocity_mps[body];
    const Scalar since_s = time_s - time_s_[body];
    return {position.x() + velocity.x() * since_s, position.y() + velocity.y() * since_s};
}

template <typename Scalar>
void SweptSolver<Scalar>::move_to(std::uint32_t body, Scalar time_s) {
    bodies_->position_m[body] = position_at(body, time_s);
    time_s_[body] = time_s;
}

template <typename Scalar>
Box<Scalar> SweptSolver<Scalar>::swept_box(std::uint32_t body) const {
    const Vec from = position_at(body, now_s_);
    const Vec to = position_at(body, span_s_);
    const Scalar radius = bodies_->radius_m[body];
    const Scalar extent = std::max(std::abs(from.x()), std::abs(from.y())) +
                          std::max(std::abs(to.x()), std::abs(to.y())) + radius;
    const Scalar reach =
        radius + static_cast<Scalar>(kBoxSlack) * std::numeric_limits<Scalar>::epsilon() * extent;
    return {std::min(from.x(), to.x()) - reach, std::min(from.y(), to.y()) - reach,
            std::max(from.x(), to.x()) + reach, std::max(from.y(), to.y()) + reach};
}

template <typename Scalar>
bool SweptSolver<Scalar>::is_immovable(std::uint32_t body) const {
    return std::isinf(bodies_->mass_kg[body]);
}

template <typename Scalar>
bool SweptSolver<Scalar>::was_just_hit(std::uint32_t body) const {
    return now_s_ - hit_s_[body] < static_cast<Scalar>(kElasticWithin) * span_s_;
}

template <typename Scalar>
Scalar SweptSolver<Scalar>::restitution_of(bool just_hit) const {
    return just_hit ? Scalar(1) : model_->restitution;
}

}  // namespace

std::uint32_t event_budget(std::size_t bodies) {
    return kBaseEventBudget + kEventBudgetPerBody * static_cast<std::uint32_t>(bodies);
}

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_swept_solver() {
    return std::make_unique<SweptSolver<Scalar>>();
}

template std::unique_ptr<Solver<double>> make_swept_solver();
template std::unique_ptr<Solver<float>> make_swept_solver();

}  // namespace fts::physics
