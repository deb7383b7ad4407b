// Bodies in straight flight, each from its last event on, and what an event does to a body. What
// will happen to them is foreseen by those that build on this: with a calendar (coasting.h), and in
// windows of time (crowd_coasting.h).
//
// Two bodies that an event left together, receding or at rest to each other but for round-off, are
// kept apart: they are not predicted to meet again before something happens to one of them. In a
// periodic scene this is said of one image, and they may meet through another.
//
// Bodies are numbered here in the order of their places, so that those who are near each other are
// near in memory too: `body` is such a number, `index_of` says who that is. What happens does not
// depend on it.
//
// Time is double, whatever the scalar, and counted from an epoch that moves on, so that times are
// as fine as positions are, for any number of collisions.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/physics/bodies.h"
#include "common/physics/flight.h"
#include "common/physics/prospect.h"
#include "common/physics/roomy_vector.h"
#include "common/physics/solver.h"

namespace fts::physics {

enum class Happening : std::uint8_t {
    kNothing,     // before the end of the span
    kMeeting,     // of `body` and `other`
    kWall,        // `other` is the side: -x, +x, -y, +y
    kFall,        // `body` leaves the platform
    kUnfinished,  // the turns allowed were used up before the end of the span
};

struct Due {
    Happening what = Happening::kNothing;
    double time_s = 0.0;
    std::uint32_t body = 0;
    std::uint32_t other = 0;
};

// How a body will fly on from now.
template <typename Scalar>
struct Turning {
    std::uint32_t body;
    Vec2<Scalar> position_m, velocity_mps;
};

// What is known of a body is Known, or a Prospect.
template <typename Scalar, typename KnownOf>
class Flights {
  public:
    using Vec = Vec2<Scalar>;
    using Flight = physics::Flight<Scalar>;

    // Time goes on to a moment, not beyond what is due.
    void advance_to(double time_s) { now_s_ = std::max(now_s_, time_s); }
    // The span ends where it was to end.
    void end_span() { now_s_ = end_s_; }

    double since_begin_s() const { return now_s_ - begin_s_; }
    double until_end_s() const { return end_s_ - now_s_; }
    double clock_s() const { return now_s_; }  // since the epoch
    double flown_s(std::uint32_t body) const { return now_s_ - flights_[body].since_s; }
    double last_hit_ago_s(std::uint32_t body) const { return now_s_ - known_[body].hit_s; }

    std::uint32_t index_of(std::uint32_t body) const { return flights_[body].index; }
    BodyId id_of(std::uint32_t body) const { return known_[body].id; }
    std::uint32_t body_at(std::uint32_t index) const { return body_at_[index]; }
    const Flight& flight(std::uint32_t body) const { return flights_[body]; }
    // In the order of memory: the index of who lives in a place, or nobody.
    std::uint32_t places() const { return static_cast<std::uint32_t>(flights_.size()); }
    std::uint32_t living_at(std::uint32_t place) const { return living_at_[place]; }
    Scalar mass_kg(std::uint32_t body) const { return flights_[body].mass_kg; }
    Vec position_m(std::uint32_t body) const { return flights_[body].position_at(now_s_); }
    // From b, or its nearest image, to a; now.
    Vec separation_m(std::uint32_t a, std::uint32_t b) const {
        return separation_m(position_m(a), position_m(b));
    }
    Vec separation_m(const Vec& a_m, const Vec& b_m) const {
        const Vec apart_m = a_m - b_m;
        return model_.periodic ? nearest_m(apart_m) : apart_m;
    }

    // The body is where it is now, and flies on from there.
    void move_to_now(std::uint32_t body) { set_position(body, position_m(body)); }
    void set_position(std::uint32_t body, const Vec& position_m) {
        flights_[body].position_m = position_m;
        flights_[body].since_s = now_s_;
    }
    // Something happened to the body, which must be moved to now: all that was predicted for it is
    // void, and it is kept apart from nobody. It must be predicted before the next `next`. An
    // immovable body flies on as if nothing had happened.
    void turn(std::uint32_t body, const Vec& velocity_mps);
    // To be called after `turn` and before `predict`, of what touches. Not both are immovable.
    void keep_apart(std::uint32_t a, std::uint32_t b);
    void keep_off_wall(std::uint32_t body, std::uint32_t side) {
        known_[body].sides_kept_off |= static_cast<std::uint8_t>(1U << side);
    }
    bool is_immovable(std::uint32_t body) const { return std::isinf(flights_[body].mass_kg); }

  protected:
    struct Image {  // of a neighbour: so many boxes away
        int x = 0, y = 0;
        friend auto operator<=>(const Image&, const Image&) = default;
    };

    // Takes over all living bodies; now is the epoch.
    void take_over(const Bodies<Scalar>& bodies, const Model<Scalar>& model);
    // A span begins where the last one ended.
    void lay_span(double span_s);
    void break_off_span();
    // The body is no longer among the living.
    void bury(std::uint32_t body);
    // All times become earlier.
    void move_epoch(double shift_s);
    // The greatest power of two that is not above now.
    double coarse_now_s() const;
    // All bodies, in the order of order_.
    void renumber();
    Vec nearest_m(const Vec& apart_m) const;  // of all images
    bool are_kept_apart(std::uint32_t a, std::uint32_t b, Image image) const;
    bool may_be_kept_apart(const Approach<Scalar>& approach, Scalar reach_m, std::uint32_t a,
                           std::uint32_t b) const {
        return approach.may_be_kept_apart(reach_m, flights_[a].velocity_mps.squaredNorm() +
                                                       flights_[b].velocity_mps.squaredNorm());
    }
    bool has_wall(std::uint32_t body, std::uint32_t side) const {
        return !is_immovable(body) && (known_[body].sides_kept_off >> side & 1U) == 0;
    }
    double time_after(const Flight& flight, Scalar wait_s) const {
        return std::max(now_s_, flight.since_s + static_cast<double>(wait_s));
    }

    Model<Scalar> model_;
    Vec extent_m_ = Vec::Zero();  // of the periodic box
    double now_s_ = 0.0;
    double begin_s_ = 0.0, end_s_ = 0.0;  // of the span
    RoomyVector<Flight> flights_;         // by body, as are the next
    RoomyVector<KnownOf> known_;
    RoomyVector<std::uint32_t> body_at_;  // by index
    std::vector<std::uint32_t> living_;   // indices, ascending
    // How often each went round the periodic box, modulo 2^32. By body, where there is one.
    struct Turns {
        std::uint32_t x = 0, y = 0;
    };
    std::vector<Turns> turns_;
    std::vector<std::uint32_t> order_;  // for renumber

  private:
    struct Apart {
        std::uint32_t other;
        std::uint32_t other_events;
        std::uint32_t image_x, image_y;  // of the other, counted where both once were
        std::uint32_t next;
    };
    void forget_apart(std::uint32_t body);

    double end_rest_s_ = 0.0;               // of the span's end
    std::vector<std::uint32_t> living_at_;  // the index by body, or kNobody
    RoomyVector<Apart> apart_;
    std::uint32_t free_apart_ = kNobody;
    RoomyVector<Flight> old_flights_;  // by renumber, as are the next
    RoomyVector<KnownOf> old_known_;
    std::vector<std::uint32_t> new_body_;
    std::vector<Turns> old_turns_;
};

extern template class Flights<double, Known>;
extern template class Flights<float, Known>;
extern template class Flights<double, Prospect>;
extern template class Flights<float, Prospect>;

}  // namespace fts::physics
