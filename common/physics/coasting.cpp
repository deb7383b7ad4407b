#include "common/physics/coasting.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "common/physics/periodic.h"
#include "common/physics/time_of_impact.h"

namespace fts::physics {
namespace {

// Cells are wider than the largest disc by this part of it, and by so many units of the round-off
// of coordinates, so that a body a little outside its cell is still next to all it touches.
constexpr double kCellRoom = 1.0 / 64.0;
constexpr double kCellRoundOff = 64.0;
// Of bodies kept apart, how far the gap may be open and the approach differ from none, as parts of
// reach and speed: far above round-off.
constexpr double kApartSlack = 1e-2;
// So many bodies tell whether the cells still suit all of them.
constexpr std::size_t kCellSample = 256;

}  // namespace

template <typename Scalar>
void Coasting<Scalar>::begin(const Bodies<Scalar>& bodies, const Model<Scalar>& model) {
    model_ = model;
    if (model_.periodic) extent_m_ = model_.periodic->extent_m();
    now_s_ = begin_s_ = end_s_ = end_rest_s_ = 0.0;
    flights_.assign(bodies.ids.size(), Flight());
    prospects_.assign(bodies.ids.size(), Prospect());
    apart_.clear();
    free_apart_ = kNobody;
    calendar_.reset(bodies.slots());
    due_soon_.count = 0;
    found_.resize(bodies.ids.size() + EventCells<Scalar>::kSpare + kGatherSpare);
    body_at_.resize(bodies.slots());
    living_.clear();
    for (std::uint32_t body = 0; body < bodies.ids.size(); ++body) {
        const std::uint32_t index = bodies.ids[body].index;
        living_.push_back(index);
        prospects_[body].id = bodies.ids[body];
        body_at_[index] = body;
        Flight& flight = flights_[body];
        flight.position_m = bodies.position_m[index];
        flight.velocity_mps = bodies.velocity_mps[index];
        flight.radius_m = bodies.radius_m[index];
        prospects_[body].mass_kg = bodies.mass_kg[index];
        prospects_[body].hit_s = -std::numeric_limits<double>::infinity();
    }
    if (model_.periodic) {
        choose<true, false, false>();
    } else if (model_.walls) {
        model_.platform ? choose<false, true, true>() : choose<false, true, false>();
    } else {
        model_.platform ? choose<false, false, true>() : choose<false, false, false>();
    }
    fit_cells();
}

template <typename Scalar>
template <bool kPeriodic, bool kWalls, bool kPlatform>
void Coasting<Scalar>::choose() {
    const auto choose_as = [&]<typename Has>(Has) {
        next_ = &Coasting::next_as<Has>;
        predict_ = &Coasting::predict_as<Has>;
        predict_as_seen_ = &Coasting::predict_as_seen_as<Has>;
    };
    kernels_ = &flight_kernels<Scalar>(best_simd_level(), model_.equal_radii);
    if (model_.equal_radii) {
        choose_as(Features<kPeriodic, kWalls, kPlatform, true>());
    } else {
        choose_as(Features<kPeriodic, kWalls, kPlatform, false>());
    }
}

template <typename Scalar>
void Coasting<Scalar>::fit_cells() {
    sample_m_.clear();
    Scalar radius = Scalar(0), coordinate = Scalar(0);
    for (const std::uint32_t index : living_) {
        const std::uint32_t body = body_at_[index];
        sample_m_.push_back(position_m(body));
        radius = std::max(radius, flights_[body].radius_m);
        coordinate = std::max(coordinate, sample_m_.back().cwiseAbs().maxCoeff());
    }
    const Scalar round_off = std::numeric_limits<Scalar>::epsilon() * coordinate;
    const Scalar width = Scalar(2) * radius * static_cast<Scalar>(1.0 + kCellRoom) +
                         static_cast<Scalar>(kCellRoundOff) * round_off;
    cells_.fit(sample_m_, width, model_.periodic ? model_.periodic : model_.walls,
               model_.periodic.has_value(), static_cast<std::uint32_t>(flights_.size()));
    turns_to_rebase_ = std::max(kRebaseEvery, static_cast<std::uint32_t>(living_.size()));
    for (std::uint32_t body = 0; body < flights_.size(); ++body) {
        const Vec position = position_m(body);
        for (std::uint32_t axis = 0; axis < 2; ++axis) {
            flights_[body].cell[axis] = cells_.cell_of(axis, position[axis]);
        }
    }
    renumber();
    // Of each pair the later one is answerable.
    for (const std::uint32_t index : living_) {
        const std::uint32_t body = body_at_[index];
        predict(body);
        cells_.put_in(body, flights_[body].cell[0], flights_[body].cell[1]);
    }
}

template <typename Scalar>
void Coasting<Scalar>::begin_span(double span_s, std::uint64_t turns) {
    // The sum of many spans to twice the precision (Knuth's two-sum), so that ticks do not add up
    // their round-off.
    const double ahead = span_s + end_rest_s_;
    begin_s_ = now_s_;
    end_s_ = now_s_ + ahead;
    const double rounded = end_s_ - now_s_;
    end_rest_s_ = (now_s_ - (end_s_ - rounded)) + (ahead - rounded);
    turns_left_ = turns;
}

template <typename Scalar>
void Coasting<Scalar>::break_span() {
    end_s_ = now_s_;
    end_rest_s_ = 0.0;
}

template <typename Scalar>
Vec2<Scalar> Coasting<Scalar>::separation_m(std::uint32_t a, std::uint32_t b) const {
    Vec apart_m = position_m(a) - position_m(b);
    if (!model_.periodic) return apart_m;
    // What is nearer than that has no nearer image.
    const auto is_near = [&](int axis) {
        return std::abs(apart_m[axis]) < Scalar(0.25) * extent_m_[axis];
    };
    if (is_near(0) && is_near(1)) return apart_m;
    return nearest_image<Scalar>(apart_m, model_.periodic);
}

template <typename Scalar>
void Coasting<Scalar>::turn(std::uint32_t body, const Vec& velocity_mps) {
    prospects_[body].hit_s = now_s_;
    if (is_immovable(body)) return;
    assert(flights_[body].since_s == now_s_);
    flights_[body].velocity_mps = velocity_mps;
    ++flights_[body].events;
    prospects_[body].sides_kept_off = 0;
    forget_apart(body);
}

template <typename Scalar>
void Coasting<Scalar>::keep_apart(std::uint32_t a, std::uint32_t b) {
    if (is_immovable(a)) std::swap(a, b);
    Apart apart{b, flights_[b].events, 0, 0, prospects_[a].apart};
    if (model_.periodic) {
        const Vec apart_m = position_m(a) - position_m(b);
        const auto boxes = [&](int axis) {
            if (std::abs(apart_m[axis]) < Scalar(0.25) * extent_m_[axis]) return 0U;
            const Scalar count = std::round(apart_m[axis] / extent_m_[axis]);
            return static_cast<std::uint32_t>(static_cast<std::int32_t>(count));
        };
        apart.image_x = boxes(0) + prospects_[a].turns_x - prospects_[b].turns_x;
        apart.image_y = boxes(1) + prospects_[a].turns_y - prospects_[b].turns_y;
    }
    if (free_apart_ == kNobody) {
        prospects_[a].apart = static_cast<std::uint32_t>(apart_.size());
        apart_.push_back(apart);
        return;
    }
    const std::uint32_t place = free_apart_;
    free_apart_ = apart_[place].next;
    apart_[place] = apart;
    prospects_[a].apart = place;
}

template <typename Scalar>
void Coasting<Scalar>::forget_apart(std::uint32_t body) {
    std::uint32_t& first = prospects_[body].apart;
    while (first != kNobody) {
        const std::uint32_t freed = first;
        first = apart_[freed].next;
        apart_[freed].next = free_apart_;
        free_apart_ = freed;
    }
}

template <typename Scalar>
bool Coasting<Scalar>::are_kept_apart(std::uint32_t a, std::uint32_t b, Image image) const {
    const auto a_has_b = [&](std::uint32_t one, std::uint32_t other, int x, int y) {
        const Prospect &mine = prospects_[one], &its = prospects_[other];
        for (std::uint32_t place = mine.apart; place != kNobody; place = apart_[place].next) {
            const Apart& apart = apart_[place];
            if (apart.other == other && apart.other_events == flights_[other].events &&
                apart.image_x == static_cast<std::uint32_t>(x) + mine.turns_x - its.turns_x &&
                apart.image_y == static_cast<std::uint32_t>(y) + mine.turns_y - its.turns_y) {
                return true;
            }
        }
        return false;
    };
    return a_has_b(a, b, image.x, image.y) || a_has_b(b, a, -image.x, -image.y);
}

template <typename Scalar>
void Coasting<Scalar>::remove(std::uint32_t body) {
    cells_.take_out(body, flights_[body].cell[0], flights_[body].cell[1]);
    forget_apart(body);
    calendar_.remove(index_of(body));
    ++flights_[body].events;
    living_at_[body] = kNobody;
    living_.erase(std::lower_bound(living_.begin(), living_.end(), index_of(body)));
}

template <typename Scalar>
void Coasting<Scalar>::enter_in_calendar(std::uint32_t body) {
    const Prospect& prospect = prospects_[body];
    calendar_.set(index_of(body), std::min(prospect.meeting_s, prospect.border_s));
}

template <typename Scalar>
void Coasting<Scalar>::rebase() {
    turns_to_rebase_ = std::max(kRebaseEvery, static_cast<std::uint32_t>(living_.size()));
    // The greatest power of two that is not above now.
    constexpr std::uint64_t kExponent = 0x7ff0000000000000;
    const double shift_s = std::bit_cast<double>(std::bit_cast<std::uint64_t>(now_s_) & kExponent);
    for (std::uint32_t body = 0; body < flights_.size(); ++body) {
        flights_[body].since_s -= shift_s;
        prospects_[body].meeting_s -= shift_s;
        prospects_[body].border_s -= shift_s;
        prospects_[body].hit_s -= shift_s;
    }
    calendar_.rebase(shift_s);
    now_s_ -= shift_s;
    begin_s_ -= shift_s;
    end_s_ -= shift_s;
    if (rebases_to_renumber_-- == 0) {
        renumber();
        cells_.clear();
        for (const std::uint32_t index : living_) {
            const Flight& flight = flights_[body_at_[index]];
            cells_.put_in(body_at_[index], flight.cell[0], flight.cell[1]);
        }
    }
    if (model_.periodic) return;
    sample_m_.clear();
    const std::size_t stride = living_.size() / kCellSample + 1;
    for (std::size_t i = 0; i < living_.size(); i += stride) {
        sample_m_.push_back(position_m(body_at_[living_[i]]));
    }
    if (!cells_.still_suits(sample_m_)) fit_cells();
}

template <typename Scalar>
template <typename Has>
Due Coasting<Scalar>::next_as() {
    for (;;) {
        const BucketCalendar::Entry first = calendar_.top();
        if (calendar_.has_gone_on()) fetch_upcoming();
        if (!(first.time_s <= end_s_)) return {};
        if (turns_left_ == 0) return {Happening::kUnfinished, now_s_, 0, 0};
        --turns_left_;
        const std::uint32_t body = body_at_[first.body];
        const Prospect& prospect = prospects_[body];
        if (prospect.meeting_s <= prospect.border_s) {
            if (holds(prospect)) {
                return {Happening::kMeeting, first.time_s, body, prospect.with};
            }
            advance_to(first.time_s);
            expect_meeting<Has>(body);
            enter_in_calendar(body);
            settle();
        } else if (prospect.border == Border::kCell) {
            advance_to(first.time_s);
            cross<Has>(body);
            settle();
        } else {
            const bool falls = Has::kPlatform && prospect.border == Border::kFall;
            return {falls ? Happening::kFall : Happening::kWall, first.time_s, body, prospect.side};
        }
    }
}

template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::predict_as(std::uint32_t body) {
    expect_meeting<Has>(body);
    expect_border<Has>(body);
    enter_in_calendar(body);
}

template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::predict_as_seen_as(const std::uint32_t* bodies, std::uint32_t count) {
    // Step by step for both: what takes long for one is under way while the other is looked at.
    for (std::uint32_t i = 0; i < count; ++i) expect_as_seen<Has>(sights_[i], bodies[i]);
    for (std::uint32_t i = 0; i < count; ++i) expect_border<Has>(bodies[i]);
    for (std::uint32_t i = 0; i < count; ++i) enter_in_calendar(bodies[i]);
}

template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::expect_as_seen(const Sight& seen, std::uint32_t body) {
    if (!seen.is_whole) return expect_meeting<Has>(body);
    Meeting best{kNever<double>, kNobody};
    look_at<Has>(*seen.about, seen.which, body, Image(), best);
    expect(body, best);
}

template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::expect_meeting(std::uint32_t body) {
    Meeting best{kNever<double>, kNobody};
    look<Has>(body, View(), best);
    expect(body, best);
}

template <typename Scalar>
void Coasting<Scalar>::expect(std::uint32_t body, const Meeting& meeting) {
    Prospect& prospect = prospects_[body];
    prospect.meeting_s = meeting.time_s;
    prospect.with = meeting.with;
    if (meeting.with != kNobody) prospect.with_events = flights_[meeting.with].events;
}

template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::look(std::uint32_t body, const View& view, Meeting& best) {
    const Flight& self = flights_[body];
    find<Has::kPeriodic>(self, view, [&](std::uint32_t* end, Image image) {
        gather(end, body, kNobody, self.since_s, about_, [&](const Neighbours<Scalar>& about) {
            look_at<Has>(about, ~0U, body, image, best);
        });
    });
}

// Whom it meets first, if before the best that is known.
template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::look_at(const Neighbours<Scalar>& about, std::uint32_t which,
                               std::uint32_t body, Image image, Meeting& best) {
    const Flight& self = flights_[body];
    const Vec shift_m = shift_of(image);
    const auto consider_all = [&](std::uint32_t bits) {
        for (; bits != 0; bits &= bits - 1) {
            const auto k = static_cast<std::uint32_t>(std::countr_zero(bits));
            const Scalar radius_m = Has::kEqualRadii ? self.radius_m : about.radius_m[k];
            consider({self, about, k, shift_m}, self.radius_m + radius_m, body, about.body[k],
                     image, best);
        }
    };
    kernels_->look_ahead(about, which, self, shift_m, now_s_, ahead_);
    if (ahead_.first == 0) return;
    const double earliest_s = ahead_.earliest_s[std::countr_zero(ahead_.first)];
    if (earliest_s > best.time_s) return;
    consider_all(ahead_.first);
    consider_all(kernels_->until(ahead_, about.count, best.time_s) & ~ahead_.first);
}

// Whether it meets one of those about it before the best that is known.
template <typename Scalar>
void Coasting<Scalar>::consider(const Approach<Scalar>& approach, Scalar reach_m,
                                std::uint32_t body, std::uint32_t other, Image image,
                                Meeting& best) const {
    constexpr Scalar kNear = static_cast<Scalar>(1.0 + kApartSlack);
    constexpr Scalar kBarely = static_cast<Scalar>(kApartSlack * kApartSlack);
    const Scalar wait_s = time_until_contact<Scalar>({approach.x_m, approach.y_m},
                                                     {approach.x_mps, approach.y_mps}, reach_m);
    const double time_s = std::max(now_s_, approach.from_s + static_cast<double>(wait_s));
    if (time_s > best.time_s || time_s == kNever<double>) return;
    if (time_s == best.time_s && !is_before(other, best.with)) return;
    if (is_immovable(body) && is_immovable(other)) return;
    // Those kept apart touch when they are left together, and approach by round-off only.
    const Scalar apart_squared = approach.distance_squared(), rate = approach.rate();
    if ((apart_squared < kNear * reach_m * reach_m ||
         rate * rate < kBarely * apart_squared *
                           (flights_[body].velocity_mps.squaredNorm() +
                            flights_[other].velocity_mps.squaredNorm())) &&
        are_kept_apart(body, other, image)) {
        return;
    }
    best = {time_s, other};
}

// Which way a body goes is anybody's guess, so there are no branches but for walls.
template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::expect_border(std::uint32_t body) {
    const Flight& flight = flights_[body];
    Prospect& prospect = prospects_[body];
    double time_s[2] = {kNever<double>, kNever<double>};
    Border border[2] = {Border::kNone, Border::kNone};
    std::uint32_t up[2];
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        const Scalar speed = flight.velocity_mps[axis];
        const std::uint32_t cell = flight.cell[axis];
        up[axis] = speed > Scalar(0) ? 1 : 0;
        border[axis] = Border::kCell;
        Scalar edge_m = cells_.edge_m(axis, cell + up[axis]);
        if (!Has::kPeriodic && cell == up[axis] * cells_.last(axis)) [[unlikely]] {
            border[axis] =
                Has::kWalls && has_wall(body, 2 * axis + up[axis]) ? Border::kWall : Border::kNone;
            if (border[axis] == Border::kNone) continue;
            edge_m = up[axis] == 1 ? model_.walls->max_m[axis] - flight.radius_m
                                   : model_.walls->min_m[axis] + flight.radius_m;
        }
        // As time_until_wall does, without asking for the direction.
        const Scalar way_m = std::copysign(Scalar(1), speed) * (edge_m - flight.position_m[axis]);
        const Scalar wait_s = std::max(Scalar(0), way_m) / std::abs(speed);
        time_s[axis] = speed == Scalar(0) ? kNever<double> : time_after(flight, wait_s);
    }
    const std::uint32_t axis = time_s[1] < time_s[0] ? 1 : 0;
    prospect.border_s = time_s[axis];
    prospect.border = border[axis];
    prospect.side = static_cast<std::uint8_t>(2 * axis + up[axis]);
    if constexpr (Has::kPlatform) {
        const double fall_s = time_after(
            flight,
            time_until_edge<Scalar>(*model_.platform, flight.position_m, flight.velocity_mps));
        if (!(fall_s < prospect.border_s)) return;
        prospect.border_s = fall_s;
        prospect.border = Border::kFall;
    }
}

template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::cross(std::uint32_t body) {
    Flight& flight = flights_[body];
    const Prospect& prospect = prospects_[body];
    const std::uint32_t axis = prospect.side / 2, up = prospect.side % 2;
    const bool knows_meeting = holds(prospect);
    cells_.take_out(body, flight.cell[0], flight.cell[1]);
    if (Has::kPeriodic && flight.cell[axis] == up * cells_.last(axis)) {
        go_round(body, axis, up == 1);
    } else {
        flight.cell[axis] += 2 * up - 1;
    }
    cells_.put_in(body, flight.cell[0], flight.cell[1]);
    if (knows_meeting) {
        Meeting best{prospect.meeting_s, prospect.with};
        look_in_front<Has>(body, axis, up, best);
        expect(body, best);
    } else {
        expect_meeting<Has>(body);
    }
    expect_border<Has>(body);
    enter_in_calendar(body);
}

// Into the three cells that came into view.
template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::look_in_front(std::uint32_t body, std::uint32_t axis, std::uint32_t up,
                                     Meeting& best) {
    const Flight& self = flights_[body];
    if (Has::kPeriodic && is_at_border(self)) {
        View view;
        (axis == 0 ? view.x0 : view.y0) = 2 * up;
        (axis == 0 ? view.x1 : view.y1) = 2 * up;
        return look<Has>(body, view, best);
    }
    gather(cells_.find_three(self.cell, axis, up, found_.data()), body, kNobody, self.since_s,
           about_,
           [&](const Neighbours<Scalar>& about) { look_at<Has>(about, ~0U, body, Image(), best); });
}

template <typename Scalar>
void Coasting<Scalar>::go_round(std::uint32_t body, std::uint32_t axis, bool up) {
    move_to_now(body);
    Flight& flight = flights_[body];
    Prospect& prospect = prospects_[body];
    std::uint32_t& turns = axis == 0 ? prospect.turns_x : prospect.turns_y;
    if (up) {
        flight.position_m[axis] -= extent_m_[axis];
        flight.cell[axis] = 0;
        ++turns;
    } else {
        flight.position_m[axis] += extent_m_[axis];
        flight.cell[axis] = cells_.last(axis);
        --turns;
    }
}

template class Coasting<double>;
template class Coasting<float>;

}  // namespace fts::physics
