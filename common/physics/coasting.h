// Bodies in straight flight, and what will happen to each of them first: predicted once, kept until
// something else happens. What an event does to velocities is not known here (solver_event.h).
//
// Every body has one entry in the calendar, the earliest of the meetings, walls, falls and cell
// borders ahead of it. A body that is predicted looks at the bodies in its cell and the eight
// around it; whoever of a pair was predicted last is answerable for their meeting. A meeting is
// void once something has happened to the other body, which shows when it is due: then a new one is
// looked for. A body that enters a cell only looks into the three cells that came into view, as
// long as the meeting it knows of holds.
//
// When two bodies meet is a function of their last events alone, (position, velocity, time) of
// each, however late and from whichever cells it is asked. So the length of ticks does not show in
// the bits of a trajectory, and the cells only in so far as they tell when the epoch moves on. What
// recedes never meets; what overlaps and approaches meets now.
//
// Two bodies that an event left together, receding or at rest to each other but for round-off, are
// kept apart: they are not predicted to meet again before something happens to one of them. In a
// periodic scene this is said of one image, and they may meet through another.
//
// Bodies are numbered here in the order of their places, so that those who are near each other are
// near in memory too: `body` is such a number, `index_of` says who that is. What happens, and in
// which order, does not depend on it.
//
// Time is double, whatever the scalar, and counted from an epoch that moves on: see kRebaseEvery.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/physics/bodies.h"
#include "common/physics/bucket_calendar.h"
#include "common/physics/event_cells.h"
#include "common/physics/flight_filter.h"
#include "common/physics/roomy_vector.h"
#include "common/physics/solver.h"

namespace fts::physics {

// The epoch moves on after as many entries of the calendar as there are bodies, and at least so
// many, which makes its cost for each a constant. Until then nobody has flown farther than over
// some of the cells, so that times are as fine as positions are, for any number of collisions. It
// moves by powers of two, so that times to come stay exact.
inline constexpr std::uint32_t kRebaseEvery = 64;

// Bodies are numbered anew after so many times, while most are not far from where they were.
inline constexpr std::uint32_t kRenumberEvery = 32;

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

template <typename Scalar>
class Coasting {
  public:
    using Vec = Vec2<Scalar>;
    using Flight = physics::Flight<Scalar>;
    static constexpr std::uint32_t kNobody = EventCells<Scalar>::kNobody;

    // Takes over all living bodies, and predicts.
    void begin(const Bodies<Scalar>& bodies, const Model<Scalar>& model);

    // A span begins where the last one ended. `turns`: so many entries of the calendar may come up.
    void begin_span(double span_s, std::uint64_t turns);
    // What is due next; it stays due until its bodies are told of it.
    Due next() { return (this->*next_)(); }
    // Time goes on to a moment, not beyond what is due.
    void advance_to(double time_s) { now_s_ = std::max(now_s_, time_s); }
    // What was due has happened.
    void settle() {
        if (turns_to_rebase_-- == 0) rebase();
    }
    // The span ends where it was to end, or now.
    void end_span() { now_s_ = end_s_; }
    void break_span();

    double since_begin_s() const { return now_s_ - begin_s_; }
    double until_end_s() const { return end_s_ - now_s_; }
    double clock_s() const { return now_s_; }  // since the epoch
    double flown_s(std::uint32_t body) const { return now_s_ - flights_[body].since_s; }
    double last_hit_ago_s(std::uint32_t body) const { return now_s_ - prospects_[body].hit_s; }

    std::uint32_t index_of(std::uint32_t body) const { return prospects_[body].id.index; }
    BodyId id_of(std::uint32_t body) const { return prospects_[body].id; }
    std::uint32_t body_at(std::uint32_t index) const { return body_at_[index]; }
    const Flight& flight(std::uint32_t body) const { return flights_[body]; }
    // In the order of memory: the index of who lives in a place, or nobody.
    std::uint32_t places() const { return static_cast<std::uint32_t>(flights_.size()); }
    std::uint32_t living_at(std::uint32_t place) const { return living_at_[place]; }
    Scalar mass_kg(std::uint32_t body) const { return prospects_[body].mass_kg; }
    Vec position_m(std::uint32_t body) const { return flights_[body].position_at(now_s_); }
    // From b, or its nearest image, to a; now.
    Vec separation_m(std::uint32_t a, std::uint32_t b) const;

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
        prospects_[body].sides_kept_off |= static_cast<std::uint8_t>(1U << side);
    }
    bool is_immovable(std::uint32_t body) const { return std::isinf(prospects_[body].mass_kg); }
    // Whether no cell is beyond that of the body on some side: all that touch a wall are such.
    bool is_at_border(std::uint32_t body) const { return is_at_border(flights_[body]); }
    void predict(std::uint32_t body) { (this->*predict_)(body); }
    void remove(std::uint32_t body);

    // Whether touches(body, other, separation) is true of anybody whose distance to `body`, now, is
    // below `factor` times their reach. Only of those in the cells about it: `factor` is hardly
    // more than 1. What is seen is kept for predict_as_seen, as the first of two sights.
    template <typename Touches>
    bool look_around(std::uint32_t body, Scalar factor, Touches&& touches) {
        return look_around(0, body, body, factor, touches);
    }
    // The same of each of two that meet; of anybody but them.
    template <typename Touches>
    bool look_around_both(std::uint32_t a, std::uint32_t b, Scalar factor, Touches&& touches);
    // The same as `predict` of one or two, after they looked in this event, in which nothing
    // happened but to these, who are kept apart.
    void predict_as_seen(std::uint32_t body) { (this->*predict_as_seen_)(&body, 1); }
    void predict_as_seen(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t both[] = {a, b};
        (this->*predict_as_seen_)(both, 2);
    }
    // Calls visit(other, separation) for every body in the cells about that of `body`, itself
    // included, once for each image, in ascending order of indices; the separation is from that
    // image to `body`, now.
    template <typename Visit>
    void for_each_near(std::uint32_t body, Visit&& visit);

  private:
    enum class Border : std::uint8_t { kNone, kCell, kWall, kFall };

    // What else is known of a body.
    struct alignas(64) Prospect {
        double meeting_s = 0.0;
        double border_s = 0.0;
        double hit_s = 0.0;  // the last event
        Scalar mass_kg = Scalar(0);
        std::uint32_t with = kNobody;   // whom it meets
        std::uint32_t with_events = 0;  // what had happened to that one when this was predicted
        std::uint32_t apart = kNobody;  // the first in its list of those it is kept apart from
        std::uint32_t turns_x = 0;      // how often it went round a periodic box, modulo 2^32
        std::uint32_t turns_y = 0;
        BodyId id;
        Border border = Border::kNone;
        std::uint8_t side = 0;
        std::uint8_t sides_kept_off = 0;  // a bit for each
    };
    struct Apart {
        std::uint32_t other;
        std::uint32_t other_events;
        std::uint32_t image_x, image_y;  // of the other, counted where both once were
        std::uint32_t next;
    };
    struct Meeting {
        double time_s;
        std::uint32_t with;
    };
    struct Image {  // of a neighbour: so many boxes away
        int x = 0, y = 0;
        friend auto operator<=>(const Image&, const Image&) = default;
    };
    struct InCell {
        std::uint32_t row = 0, column = 0, body = 0;
        friend auto operator<=>(const InCell&, const InCell&) = default;
    };
    // A few bodies that are due at about the same time.
    struct Few {
        std::uint32_t count = 0;
        std::uint32_t body[BucketCalendar::kMostSoon] = {};
    };
    struct Near {
        std::uint32_t index = kNobody;
        Image image;
        friend auto operator<=>(const Near&, const Near&) = default;
    };
    // What a body saw about it.
    struct Sight {
        bool is_whole = false;      // it is all that there is, through no other image
        std::uint32_t which = ~0U;  // a bit for each of those
        const Neighbours<Scalar>* about = nullptr;
    };
    // Of the nine cells about a body's own, counted from the lowest corner.
    struct View {
        std::uint32_t x0 = 0, x1 = 2, y0 = 0, y1 = 2;
    };
    template <bool kIsPeriodic, bool kHasWalls, bool kHasPlatform, bool kHasEqualRadii>
    struct Features {
        static constexpr bool kPeriodic = kIsPeriodic;
        static constexpr bool kWalls = kHasWalls;
        static constexpr bool kPlatform = kHasPlatform;
        static constexpr bool kEqualRadii = kHasEqualRadii;
    };

    template <bool kPeriodic, bool kWalls, bool kPlatform>
    void choose();
    void fit_cells();
    void renumber();
    void forget_apart(std::uint32_t body);
    bool are_kept_apart(std::uint32_t a, std::uint32_t b, Image image) const;
    bool holds(const Prospect& prospect) const {
        return prospect.with == kNobody || flights_[prospect.with].events == prospect.with_events;
    }
    void rebase();
    bool is_before(std::uint32_t body, std::uint32_t other) const {
        return other == kNobody || index_of(body) < index_of(other);
    }
    void enter_in_calendar(std::uint32_t body);
    void fetch_upcoming();

    template <typename Has>
    Due next_as();
    template <typename Has>
    void predict_as(std::uint32_t body);
    template <typename Has>
    void expect_meeting(std::uint32_t body);
    template <typename Has>
    void expect_border(std::uint32_t body);
    bool has_wall(std::uint32_t body, std::uint32_t side) const {
        return !is_immovable(body) && (prospects_[body].sides_kept_off >> side & 1U) == 0;
    }
    double time_after(const Flight& flight, Scalar wait_s) const {
        return std::max(now_s_, flight.since_s + static_cast<double>(wait_s));
    }
    template <typename Has>
    void look(std::uint32_t body, const View& view, Meeting& best);
    template <typename Has>
    void predict_as_seen_as(const std::uint32_t* bodies, std::uint32_t count);
    template <typename Has>
    void expect_as_seen(const Sight& seen, std::uint32_t body);
    template <typename Has>
    void look_at(const Neighbours<Scalar>& about, std::uint32_t which, std::uint32_t body,
                 Image image, Meeting& best);
    void consider(const Approach<Scalar>& approach, Scalar reach_m, std::uint32_t body,
                  std::uint32_t other, Image image, Meeting& best) const;
    template <typename Touches>
    bool look_around(std::uint32_t sight, std::uint32_t body, std::uint32_t partner, Scalar factor,
                     Touches&& touches);
    template <typename Touches>
    bool touches_any(const Neighbours<Scalar>& about, std::uint32_t which, std::uint32_t body,
                     const Vec& shift_m, Scalar factor, Touches&& touches);
    // Calls visit(about) for those in found_ up to `end`, as they are since a moment at which a
    // flight of `body` begins.
    template <typename Visit>
    void gather(std::uint32_t* end, std::uint32_t body, std::uint32_t partner, double since_s,
                Neighbours<Scalar>& about, Visit&& visit);
    template <typename Has>
    void cross(std::uint32_t body);
    template <typename Has>
    void look_in_front(std::uint32_t body, std::uint32_t axis, std::uint32_t up, Meeting& best);
    void expect(std::uint32_t body, const Meeting& meeting);
    void go_round(std::uint32_t body, std::uint32_t axis, bool up);
    bool is_at_border(const Flight& flight) const {
        const auto is_inside = [&](std::uint32_t axis) {
            return flight.cell[axis] > 0 && flight.cell[axis] < cells_.last(axis);
        };
        return !is_inside(0) || !is_inside(1);
    }
    Vec shift_of(Image image) const {
        return {extent_m_.x() * static_cast<Scalar>(image.x),
                extent_m_.y() * static_cast<Scalar>(image.y)};
    }
    // Fills found_ and calls visit(end of it, image), at once for all cells of the view, but in a
    // periodic box at whose border the body is: there for each cell.
    template <bool kMayBePeriodic, typename Visit>
    void find(const Flight& self, const View& view, Visit&& visit);
    template <typename Visit>
    void find_across(const Flight& self, const View& view, Visit&& visit);

    Model<Scalar> model_;
    Vec extent_m_ = Vec::Zero();  // of the periodic box
    double now_s_ = 0.0;
    double begin_s_ = 0.0, end_s_ = 0.0, end_rest_s_ = 0.0;  // of the span
    std::uint64_t turns_left_ = 0;
    std::uint32_t turns_to_rebase_ = 0;
    Due (Coasting::*next_)() = nullptr;
    void (Coasting::*predict_)(std::uint32_t) = nullptr;
    void (Coasting::*predict_as_seen_)(const std::uint32_t*, std::uint32_t) = nullptr;
    const FlightKernels<Scalar>* kernels_ = nullptr;

    RoomyVector<Flight> flights_;  // by body, as are the next
    RoomyVector<Prospect> prospects_;
    RoomyVector<std::uint32_t> body_at_;    // by index, as is the calendar
    std::vector<std::uint32_t> living_;     // indices, ascending
    std::vector<std::uint32_t> living_at_;  // the same by body, or kNobody
    std::uint32_t rebases_to_renumber_ = 0;
    std::vector<InCell> places_;  // by renumber, as are the next
    RoomyVector<Flight> old_flights_;
    RoomyVector<Prospect> old_prospects_;
    std::vector<std::uint32_t> new_body_;
    RoomyVector<Apart> apart_;
    std::uint32_t free_apart_ = kNobody;
    BucketCalendar calendar_;
    Few due_soon_;  // see fetch_upcoming
    EventCells<Scalar> cells_;
    std::vector<std::uint32_t> found_;  // by cells_.find
    Neighbours<Scalar> about_;
    Ahead<Scalar> ahead_;
    Neighbours<Scalar> seen_[2];
    Sight sights_[2];
    std::vector<Near> near_;
    std::vector<Vec> sample_m_;
};

template <typename Scalar>
template <typename Visit>
void Coasting<Scalar>::for_each_near(std::uint32_t body, Visit&& visit) {
    near_.clear();
    find<true>(flights_[body], View(), [&](const std::uint32_t* end, Image image) {
        for (const std::uint32_t* at = found_.data(); at != end; ++at)
            near_.push_back({index_of(*at), image});
    });
    std::sort(near_.begin(), near_.end());
    const Vec position = position_m(body);
    for (const auto& [index, image] : near_) {
        const std::uint32_t other = body_at_[index];
        visit(other, Vec((position - position_m(other)) - shift_of(image)));
    }
}

template <typename Scalar>
template <typename Touches>
bool Coasting<Scalar>::touches_any(const Neighbours<Scalar>& about, std::uint32_t which,
                                   std::uint32_t body, const Vec& shift_m, Scalar factor,
                                   Touches&& touches) {
    const Vec position = position_m(body);
    std::uint32_t close =
        which & kernels_->close(about, position - shift_m, flights_[body].radius_m, factor);
    for (; close != 0; close &= close - 1) {
        const std::uint32_t other = about.body[std::countr_zero(close)];
        if (touches(body, other, Vec((position - position_m(other)) - shift_m))) return true;
    }
    return false;
}

template <typename Scalar>
template <typename Touches>
bool Coasting<Scalar>::look_around(std::uint32_t sight, std::uint32_t body, std::uint32_t partner,
                                   Scalar factor, Touches&& touches) {
    const Flight& self = flights_[body];
    std::uint32_t looks = 0;
    bool any = false;
    find<true>(self, View(), [&](std::uint32_t* end, Image image) {
        gather(end, body, partner, now_s_, seen_[sight], [&](const Neighbours<Scalar>& about) {
            ++looks;
            any = any || touches_any(about, ~0U, body, shift_of(image), factor, touches);
        });
    });
    const bool is_whole = looks == 1 && !(model_.periodic && is_at_border(self));
    sights_[sight] = {is_whole, ~0U, &seen_[sight]};
    return any;
}

template <typename Scalar>
template <typename Touches>
bool Coasting<Scalar>::look_around_both(std::uint32_t a, std::uint32_t b, Scalar factor,
                                        Touches&& touches) {
    const Flight &one = flights_[a], &other = flights_[b];
    typename EventCells<Scalar>::AboutTwo found;
    if (!(model_.periodic && (is_at_border(one) || is_at_border(other)))) {
        found = cells_.find_about_two(one.cell, other.cell, found_.data());
    }
    if (found.end == nullptr) {
        return look_around(0, a, b, factor, touches) || look_around(1, b, a, factor, touches);
    }
    bool any = false;
    gather(found.end, a, b, now_s_, seen_[0], [&](const Neighbours<Scalar>& about) {
        any = touches_any(about, found.about[0], a, Vec::Zero(), factor, touches) ||
              touches_any(about, found.about[1], b, Vec::Zero(), factor, touches);
    });
    sights_[0] = {true, found.about[0], &seen_[0]};
    sights_[1] = {true, found.about[1], &seen_[0]};
    return any;
}

template <typename Scalar>
template <typename Visit>
void Coasting<Scalar>::gather(std::uint32_t* end, std::uint32_t body, std::uint32_t partner,
                              double since_s, Neighbours<Scalar>& about, Visit&& visit) {
    std::fill_n(end, kGatherSpare, body);
    for (const std::uint32_t* at = found_.data(); at < end; at += Neighbours<Scalar>::kMost) {
        const auto count = std::min<std::ptrdiff_t>(end - at, Neighbours<Scalar>::kMost);
        kernels_->gather(flights_.data(), at, static_cast<std::uint32_t>(count), body, partner,
                         since_s, about);
        visit(about);
    }
}

template <typename Scalar>
template <bool kMayBePeriodic, typename Visit>
void Coasting<Scalar>::find(const Flight& self, const View& view, Visit&& visit) {
    if (kMayBePeriodic && model_.periodic && is_at_border(self)) {
        find_across(self, view, visit);
        return;
    }
    visit(cells_.find(self.cell[0] + view.x0, self.cell[1] + view.y0, view.x1 - view.x0 + 1,
                      view.y1 - view.y0 + 1, found_.data()),
          Image());
}

template <typename Scalar>
template <typename Visit>
void Coasting<Scalar>::find_across(const Flight& self, const View& view, Visit&& visit) {
    struct Place {
        std::uint32_t cell;
        int image;
    };
    const auto place = [&](std::uint32_t axis, std::uint32_t step) -> Place {
        const std::uint32_t last = cells_.last(axis), cell = self.cell[axis];
        if (step == 0 && cell == 0) return {last, -1};
        if (step == 2 && cell == last) return {0, 1};
        return {cell + step - 1, 0};
    };
    for (std::uint32_t y = view.y0; y <= view.y1; ++y) {
        const Place row = place(1, y);
        for (std::uint32_t x = view.x0; x <= view.x1; ++x) {
            const Place column = place(0, x);
            std::uint32_t* const end =
                cells_.find(column.cell + 1, row.cell + 1, 1, 1, found_.data());
            if (end != found_.data()) visit(end, Image{column.image, row.image});
        }
    }
}

// In the order of their cells. To be put into these is left to the caller.
template <typename Scalar>
void Coasting<Scalar>::renumber() {
    rebases_to_renumber_ = kRenumberEvery;
    const auto bodies = static_cast<std::uint32_t>(flights_.size());
    places_.clear();
    for (std::uint32_t body = 0; body < bodies; ++body) {
        places_.push_back({flights_[body].cell[1], flights_[body].cell[0], body});
    }
    std::sort(places_.begin(), places_.end());
    old_flights_ = flights_;
    old_prospects_ = prospects_;
    new_body_.resize(bodies);
    for (std::uint32_t body = 0; body < bodies; ++body) {
        const std::uint32_t old_body = places_[body].body;
        new_body_[old_body] = body;
        flights_[body] = old_flights_[old_body];
        prospects_[body] = old_prospects_[old_body];
    }
    for (std::uint32_t body = 0; body < bodies; ++body) {
        body_at_[index_of(body)] = body;
        std::uint32_t& with = prospects_[body].with;
        if (with != kNobody) with = new_body_[with];
    }
    living_at_.assign(bodies, kNobody);
    for (const std::uint32_t index : living_) living_at_[body_at_[index]] = index;
    for (Apart& apart : apart_) apart.other = new_body_[apart.other];
}

// Into the cache, one step for each stretch of the calendar: a body that will be due, then whom it
// meets and the cells about it.
template <typename Scalar>
void Coasting<Scalar>::fetch_upcoming() {
    const auto fetch = [&](std::uint32_t body) {
        __builtin_prefetch(&flights_[body], 1);
        __builtin_prefetch(&prospects_[body], 1);
    };
    for (std::uint32_t i = 0; i < due_soon_.count; ++i) {
        const std::uint32_t body = due_soon_.body[i], with = prospects_[body].with;
        cells_.fetch(flights_[body].cell[0], flights_[body].cell[1]);
        fetch(with == kNobody ? body : with);
    }
    due_soon_.count = 0;
    for (const std::uint32_t index : calendar_.soon()) {
        fetch(due_soon_.body[due_soon_.count++] = body_at_[index]);
    }
}

extern template class Coasting<double>;
extern template class Coasting<float>;

}  // namespace fts::physics
