#include "common/physics/flights.h"

#include <bit>
#include <cassert>
#include <limits>
#include <utility>

#include "common/physics/periodic.h"

namespace fts::physics {

template <typename Scalar, typename KnownOf>
void Flights<Scalar, KnownOf>::take_over(const Bodies<Scalar>& bodies, const Model<Scalar>& model) {
    model_ = model;
    if (model_.periodic) extent_m_ = model_.periodic->extent_m();
    now_s_ = begin_s_ = end_s_ = end_rest_s_ = 0.0;
    flights_.assign(bodies.ids.size(), Flight());
    known_.assign(bodies.ids.size(), KnownOf());
    turns_.assign(model_.periodic ? bodies.ids.size() : 0, Turns());
    apart_.clear();
    free_apart_ = kNobody;
    body_at_.resize(bodies.slots());
    living_.clear();
    living_at_.clear();
    for (std::uint32_t body = 0; body < bodies.ids.size(); ++body) {
        const std::uint32_t index = bodies.ids[body].index;
        living_.push_back(index);
        living_at_.push_back(index);
        known_[body].id = bodies.ids[body];
        body_at_[index] = body;
        Flight& flight = flights_[body];
        flight.position_m = bodies.position_m[index];
        flight.velocity_mps = bodies.velocity_mps[index];
        flight.radius_m = bodies.radius_m[index];
        flight.mass_kg = bodies.mass_kg[index];
        flight.index = index;
        known_[body].hit_s = -std::numeric_limits<double>::infinity();
    }
}

// The sum of many spans to twice the precision (Knuth's two-sum), so that ticks do not add up their
// round-off.
template <typename Scalar, typename KnownOf>
void Flights<Scalar, KnownOf>::lay_span(double span_s) {
    const double ahead = span_s + end_rest_s_;
    begin_s_ = now_s_;
    end_s_ = now_s_ + ahead;
    const double rounded = end_s_ - now_s_;
    end_rest_s_ = (now_s_ - (end_s_ - rounded)) + (ahead - rounded);
}

template <typename Scalar, typename KnownOf>
void Flights<Scalar, KnownOf>::break_off_span() {
    end_s_ = now_s_;
    end_rest_s_ = 0.0;
}

template <typename Scalar, typename KnownOf>
Vec2<Scalar> Flights<Scalar, KnownOf>::nearest_m(const Vec& apart_m) const {
    // What is nearer than that has no nearer image.
    const auto is_near = [&](int axis) {
        return std::abs(apart_m[axis]) < Scalar(0.25) * extent_m_[axis];
    };
    if (is_near(0) && is_near(1)) return apart_m;
    return nearest_image<Scalar>(apart_m, model_.periodic);
}

template <typename Scalar, typename KnownOf>
void Flights<Scalar, KnownOf>::turn(std::uint32_t body, const Vec& velocity_mps) {
    known_[body].hit_s = now_s_;
    if (is_immovable(body)) return;
    assert(flights_[body].since_s == now_s_);
    flights_[body].velocity_mps = velocity_mps;
    ++flights_[body].events;
    known_[body].sides_kept_off = 0;
    forget_apart(body);
}

template <typename Scalar, typename KnownOf>
void Flights<Scalar, KnownOf>::keep_apart(std::uint32_t a, std::uint32_t b) {
    if (is_immovable(a)) std::swap(a, b);
    KnownOf& known = known_[a];
    if (!model_.periodic && known.apart_from == kNobody) {
        known.apart_from = b;
        known.apart_from_events = flights_[b].events;
        return;
    }
    Apart apart{b, flights_[b].events, 0, 0, known.apart};
    if (model_.periodic) {
        const Vec apart_m = position_m(a) - position_m(b);
        const auto boxes = [&](int axis) {
            if (std::abs(apart_m[axis]) < Scalar(0.25) * extent_m_[axis]) return 0U;
            const Scalar count = std::round(apart_m[axis] / extent_m_[axis]);
            return static_cast<std::uint32_t>(static_cast<std::int32_t>(count));
        };
        apart.image_x = boxes(0) + turns_[a].x - turns_[b].x;
        apart.image_y = boxes(1) + turns_[a].y - turns_[b].y;
    }
    if (free_apart_ == kNobody) {
        known.apart = static_cast<std::uint32_t>(apart_.size());
        apart_.push_back(apart);
        return;
    }
    const std::uint32_t place = std::exchange(free_apart_, apart_[free_apart_].next);
    apart_[place] = apart;
    known.apart = place;
}

template <typename Scalar, typename KnownOf>
void Flights<Scalar, KnownOf>::forget_apart(std::uint32_t body) {
    known_[body].apart_from = kNobody;
    std::uint32_t& first = known_[body].apart;
    while (first != kNobody) {
        const std::uint32_t freed = first;
        first = apart_[freed].next;
        apart_[freed].next = free_apart_;
        free_apart_ = freed;
    }
}

template <typename Scalar, typename KnownOf>
bool Flights<Scalar, KnownOf>::are_kept_apart(std::uint32_t a, std::uint32_t b, Image image) const {
    const auto a_has_b = [&](std::uint32_t one, std::uint32_t other, int x, int y) {
        const KnownOf& mine = known_[one];
        const std::uint32_t events = flights_[other].events;
        if (mine.apart_from == other && mine.apart_from_events == events) return true;
        for (std::uint32_t place = mine.apart; place != kNobody; place = apart_[place].next) {
            const Apart& apart = apart_[place];
            if (apart.other != other || apart.other_events != events) continue;
            if (!model_.periodic) return true;
            const Turns &my_turns = turns_[one], &its_turns = turns_[other];
            if (apart.image_x == static_cast<std::uint32_t>(x) + my_turns.x - its_turns.x &&
                apart.image_y == static_cast<std::uint32_t>(y) + my_turns.y - its_turns.y) {
                return true;
            }
        }
        return false;
    };
    return a_has_b(a, b, image.x, image.y) || a_has_b(b, a, -image.x, -image.y);
}

template <typename Scalar, typename KnownOf>
void Flights<Scalar, KnownOf>::bury(std::uint32_t body) {
    forget_apart(body);
    ++flights_[body].events;
    living_at_[body] = kNobody;
    living_.erase(std::lower_bound(living_.begin(), living_.end(), index_of(body)));
}

template <typename Scalar, typename KnownOf>
double Flights<Scalar, KnownOf>::coarse_now_s() const {
    constexpr std::uint64_t kExponent = 0x7ff0000000000000;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(now_s_) & kExponent);
}

template <typename Scalar, typename KnownOf>
void Flights<Scalar, KnownOf>::move_epoch(double shift_s) {
    for (std::uint32_t body = 0; body < flights_.size(); ++body) {
        flights_[body].since_s -= shift_s;
        known_[body].move_epoch(shift_s);
    }
    now_s_ -= shift_s;
    begin_s_ -= shift_s;
    end_s_ -= shift_s;
}

template <typename Scalar, typename KnownOf>
void Flights<Scalar, KnownOf>::renumber() {
    const auto bodies = static_cast<std::uint32_t>(flights_.size());
    assert(order_.size() == bodies);
    old_flights_ = flights_;
    old_known_ = known_;
    new_body_.resize(bodies);
    for (std::uint32_t body = 0; body < bodies; ++body) {
        const std::uint32_t old_body = order_[body];
        new_body_[old_body] = body;
        flights_[body] = old_flights_[old_body];
        known_[body] = old_known_[old_body];
    }
    for (std::uint32_t body = 0; body < bodies; ++body) {
        body_at_[index_of(body)] = body;
        known_[body].for_each_other([&](std::uint32_t& other) {
            if (other != kNobody) other = new_body_[other];
        });
    }
    if (model_.periodic) {
        old_turns_ = turns_;
        for (std::uint32_t body = 0; body < bodies; ++body)
            turns_[new_body_[body]] = old_turns_[body];
    }
    living_at_.assign(bodies, kNobody);
    for (const std::uint32_t index : living_) living_at_[body_at_[index]] = index;
    for (Apart& apart : apart_) apart.other = new_body_[apart.other];
}

template class Flights<double, Known>;
template class Flights<float, Known>;
template class Flights<double, Prospect>;
template class Flights<float, Prospect>;

}  // namespace fts::physics
