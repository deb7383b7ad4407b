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
// So many bodies tell whether the cells still suit all of them.
constexpr std::size_t kCellSample = 256;

}  // namespace

template <typename Scalar>
bool Coasting<Scalar>::begin(const Bodies<Scalar>& bodies, const Model<Scalar>& model) {
    this->take_over(bodies, model);
    calendar_.reset(bodies.slots());
    due_soon_.count = 0;
    found_.resize(bodies.ids.size() + EventCells<Scalar>::kSpare + kGatherSpare);
    if (model_.periodic) {
        choose<true, false, false>();
    } else if (model_.walls) {
        model_.platform ? choose<false, true, true>() : choose<false, true, false>();
    } else {
        model_.platform ? choose<false, false, true>() : choose<false, false, false>();
    }
    fit_cells();
    return true;
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
            known_[body].cell[axis] = cells_.cell_of(axis, position[axis]);
        }
    }
    rebases_to_renumber_ = kRenumberEvery;
    renumber_by_cells();
    // Of each pair the later one is answerable.
    for (const std::uint32_t index : living_) {
        const std::uint32_t body = body_at_[index];
        predict(body);
        cells_.put_in(body, known_[body].cell[0], known_[body].cell[1]);
    }
}

template <typename Scalar>
void Coasting<Scalar>::renumber_by_cells() {
    in_cells_.clear();
    for (std::uint32_t body = 0; body < this->places(); ++body) {
        in_cells_.push_back({known_[body].cell[1], known_[body].cell[0], body});
    }
    std::sort(in_cells_.begin(), in_cells_.end());
    this->order_.clear();
    for (const InCell& place : in_cells_) this->order_.push_back(place.body);
    this->renumber();
}

template <typename Scalar>
void Coasting<Scalar>::remove(std::uint32_t body) {
    cells_.take_out(body, known_[body].cell[0], known_[body].cell[1]);
    calendar_.remove(index_of(body));
    this->bury(body);
}

template <typename Scalar>
void Coasting<Scalar>::enter_in_calendar(std::uint32_t body) {
    const Prospect& prospect = known_[body];
    calendar_.set(index_of(body), std::min(prospect.meeting_s, prospect.border_s));
}

template <typename Scalar>
void Coasting<Scalar>::rebase() {
    turns_to_rebase_ = std::max(kRebaseEvery, static_cast<std::uint32_t>(living_.size()));
    const double shift_s = this->coarse_now_s();
    this->move_epoch(shift_s);
    calendar_.rebase(shift_s);
    if (rebases_to_renumber_-- == 0) {
        rebases_to_renumber_ = kRenumberEvery;
        renumber_by_cells();
        cells_.clear();
        for (const std::uint32_t index : living_) {
            const std::uint32_t body = body_at_[index];
            cells_.put_in(body, known_[body].cell[0], known_[body].cell[1]);
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
        const Prospect& prospect = known_[body];
        if (prospect.meeting_s <= prospect.border_s) {
            if (holds(prospect)) {
                return {Happening::kMeeting, first.time_s, body, prospect.with};
            }
            this->advance_to(first.time_s);
            expect_meeting<Has>(body);
            enter_in_calendar(body);
            settle();
        } else if (prospect.border == Border::kCell) {
            this->advance_to(first.time_s);
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
    Prospect& prospect = known_[body];
    prospect.meeting_s = meeting.time_s;
    prospect.with = meeting.with;
    if (meeting.with != kNobody) prospect.with_events = flights_[meeting.with].events;
}

template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::look(std::uint32_t body, const View& view, Meeting& best) {
    const Flight& self = flights_[body];
    find<Has::kPeriodic>(known_[body].cell, view, [&](std::uint32_t* end, Image image) {
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
    const Scalar wait_s = time_until_contact<Scalar>({approach.x_m, approach.y_m},
                                                     {approach.x_mps, approach.y_mps}, reach_m);
    const double time_s = std::max(now_s_, approach.from_s + static_cast<double>(wait_s));
    if (time_s > best.time_s || time_s == kNever<double>) return;
    if (time_s == best.time_s && !is_before(other, best.with)) return;
    if (is_immovable(body) && is_immovable(other)) return;
    if (this->may_be_kept_apart(approach, reach_m, body, other) &&
        this->are_kept_apart(body, other, image)) {
        return;
    }
    best = {time_s, other};
}

// Which way a body goes is anybody's guess, so there are no branches but for walls.
template <typename Scalar>
template <typename Has>
void Coasting<Scalar>::expect_border(std::uint32_t body) {
    const Flight& flight = flights_[body];
    Prospect& prospect = known_[body];
    double time_s[2] = {kNever<double>, kNever<double>};
    Border border[2] = {Border::kNone, Border::kNone};
    std::uint32_t up[2];
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        const Scalar speed = flight.velocity_mps[axis];
        const std::uint32_t cell = prospect.cell[axis];
        up[axis] = speed > Scalar(0) ? 1 : 0;
        border[axis] = Border::kCell;
        Scalar edge_m = cells_.edge_m(axis, cell + up[axis]);
        if (!Has::kPeriodic && cell == up[axis] * cells_.last(axis)) [[unlikely]] {
            border[axis] = Has::kWalls && this->has_wall(body, 2 * axis + up[axis]) ? Border::kWall
                                                                                    : Border::kNone;
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
    Prospect& prospect = known_[body];
    const std::uint32_t axis = prospect.side / 2, up = prospect.side % 2;
    const bool knows_meeting = holds(prospect);
    cells_.take_out(body, prospect.cell[0], prospect.cell[1]);
    if (Has::kPeriodic && prospect.cell[axis] == up * cells_.last(axis)) {
        go_round(body, axis, up == 1);
    } else {
        prospect.cell[axis] += 2 * up - 1;
    }
    cells_.put_in(body, prospect.cell[0], prospect.cell[1]);
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
    if (Has::kPeriodic && is_at_border(body)) {
        View view;
        (axis == 0 ? view.x0 : view.y0) = 2 * up;
        (axis == 0 ? view.x1 : view.y1) = 2 * up;
        return look<Has>(body, view, best);
    }
    gather(cells_.find_three(known_[body].cell, axis, up, found_.data()), body, kNobody,
           self.since_s, about_,
           [&](const Neighbours<Scalar>& about) { look_at<Has>(about, ~0U, body, Image(), best); });
}

template <typename Scalar>
void Coasting<Scalar>::go_round(std::uint32_t body, std::uint32_t axis, bool up) {
    this->move_to_now(body);
    Flight& flight = flights_[body];
    std::uint32_t& cell = known_[body].cell[axis];
    std::uint32_t& turns = axis == 0 ? this->turns_[body].x : this->turns_[body].y;
    if (up) {
        flight.position_m[axis] -= extent_m_[axis];
        cell = 0;
        ++turns;
    } else {
        flight.position_m[axis] += extent_m_[axis];
        cell = cells_.last(axis);
        --turns;
    }
}

template class Coasting<double>;
template class Coasting<float>;

}  // namespace fts::physics
