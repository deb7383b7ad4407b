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
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/physics/bucket_calendar.h"
#include "common/physics/event_cells.h"
#include "common/physics/flight_filter.h"
#include "common/physics/flights.h"
#include "common/physics/roomy_vector.h"

namespace fts::physics {

// The epoch moves on after as many entries of the calendar as there are bodies, and at least so
// many, which makes its cost for each a constant. Until then nobody has flown farther than over
// some of the cells, so that times are as fine as positions are, for any number of collisions. It
// moves by powers of two, so that times to come stay exact.
inline constexpr std::uint32_t kRebaseEvery = 64;

// Bodies are numbered anew after so many times, while most are not far from where they were.
inline constexpr std::uint32_t kRenumberEvery = 32;

template <typename Scalar>
class Coasting : public Flights<Scalar, Prospect> {
  public:
    using Base = Flights<Scalar, Prospect>;
    using Base::index_of, Base::is_immovable, Base::position_m;
    using typename Base::Flight;
    using typename Base::Vec;

    // Takes over all living bodies, and predicts. It is for any.
    bool begin(const Bodies<Scalar>& bodies, const Model<Scalar>& model);

    // A span begins where the last one ended. `turns`: so many entries of the calendar may come up.
    void begin_span(double span_s, std::uint64_t turns) {
        this->lay_span(span_s);
        turns_left_ = turns;
    }
    // What is due next; it stays due until its bodies are told of it.
    Due next() { return (this->*next_)(); }
    // What was due has happened.
    void settle() {
        if (turns_to_rebase_-- == 0) rebase();
    }
    // The span ends now.
    void break_span() { this->break_off_span(); }

    // Whether no cell is beyond that of the body on some side: all that touch a wall are such.
    bool is_at_border(std::uint32_t body) const { return is_at_border(known_[body].cell); }
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
    bool look_around_both(const Turning<Scalar>& one, const Turning<Scalar>& other, Scalar factor,
                          Touches&& touches);
    // The same as `predict` of one or two, after they looked in this event and order, in which
    // nothing happened but to these, who are kept apart.
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
    using Border = Prospect::Border;
    using Base::flights_, Base::known_, Base::body_at_, Base::living_;
    using Base::model_, Base::extent_m_, Base::now_s_, Base::end_s_;
    using Base::time_after;
    using typename Base::Image;

    struct Meeting {
        double time_s;
        std::uint32_t with;
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
    struct InCell {
        std::uint32_t row = 0, column = 0, body = 0;
        friend auto operator<=>(const InCell&, const InCell&) = default;
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
    void renumber_by_cells();
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
    bool is_at_border(const std::uint32_t* cell) const {
        const auto is_inside = [&](std::uint32_t axis) {
            return cell[axis] > 0 && cell[axis] < cells_.last(axis);
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
    void find(const std::uint32_t* cell, const View& view, Visit&& visit);
    template <typename Visit>
    void find_across(const std::uint32_t* own, const View& view, Visit&& visit);

    std::uint64_t turns_left_ = 0;
    std::uint32_t turns_to_rebase_ = 0;
    Due (Coasting::*next_)() = nullptr;
    void (Coasting::*predict_)(std::uint32_t) = nullptr;
    void (Coasting::*predict_as_seen_)(const std::uint32_t*, std::uint32_t) = nullptr;
    const FlightKernels<Scalar>* kernels_ = nullptr;

    std::uint32_t rebases_to_renumber_ = 0;
    BucketCalendar calendar_;  // by index
    Few due_soon_;             // see fetch_upcoming
    EventCells<Scalar> cells_;
    std::vector<std::uint32_t> found_;  // by cells_.find
    Neighbours<Scalar> about_;
    Ahead<Scalar> ahead_;
    Neighbours<Scalar> seen_[2];
    Sight sights_[2];
    std::vector<Near> near_;
    std::vector<Vec> sample_m_;
    std::vector<InCell> in_cells_;  // by renumber_by_cells
};

template <typename Scalar>
template <typename Visit>
void Coasting<Scalar>::for_each_near(std::uint32_t body, Visit&& visit) {
    near_.clear();
    find<true>(known_[body].cell, View(), [&](const std::uint32_t* end, Image image) {
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
    std::uint32_t looks = 0;
    bool any = false;
    find<true>(known_[body].cell, View(), [&](std::uint32_t* end, Image image) {
        gather(end, body, partner, now_s_, seen_[sight], [&](const Neighbours<Scalar>& about) {
            ++looks;
            any = any || touches_any(about, ~0U, body, shift_of(image), factor, touches);
        });
    });
    const bool is_whole = looks == 1 && !(model_.periodic && is_at_border(body));
    sights_[sight] = {is_whole, ~0U, &seen_[sight]};
    return any;
}

template <typename Scalar>
template <typename Touches>
bool Coasting<Scalar>::look_around_both(const Turning<Scalar>& one, const Turning<Scalar>& other,
                                        Scalar factor, Touches&& touches) {
    const std::uint32_t a = one.body, b = other.body;
    const std::uint32_t *const cell_a = known_[a].cell, *const cell_b = known_[b].cell;
    typename EventCells<Scalar>::AboutTwo found;
    if (!(model_.periodic && (is_at_border(a) || is_at_border(b)))) {
        found = cells_.find_about_two(cell_a, cell_b, found_.data());
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
void Coasting<Scalar>::find(const std::uint32_t* cell, const View& view, Visit&& visit) {
    if (kMayBePeriodic && model_.periodic && is_at_border(cell)) {
        find_across(cell, view, visit);
        return;
    }
    visit(cells_.find(cell[0] + view.x0, cell[1] + view.y0, view.x1 - view.x0 + 1,
                      view.y1 - view.y0 + 1, found_.data()),
          Image());
}

template <typename Scalar>
template <typename Visit>
void Coasting<Scalar>::find_across(const std::uint32_t* own, const View& view, Visit&& visit) {
    struct Place {
        std::uint32_t cell;
        int image;
    };
    const auto place = [&](std::uint32_t axis, std::uint32_t step) -> Place {
        const std::uint32_t last = cells_.last(axis), cell = own[axis];
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

// Into the cache, one step for each stretch of the calendar: a body that will be due, then whom it
// meets and the cells about it.
template <typename Scalar>
void Coasting<Scalar>::fetch_upcoming() {
    const auto fetch = [&](std::uint32_t body) {
        __builtin_prefetch(&flights_[body], 1);
        __builtin_prefetch(&known_[body], 1);
    };
    for (std::uint32_t i = 0; i < due_soon_.count; ++i) {
        const std::uint32_t body = due_soon_.body[i], with = known_[body].with;
        cells_.fetch(known_[body].cell[0], known_[body].cell[1]);
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
