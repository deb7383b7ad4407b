#include "common/physics/crowd_coasting.h"

#include <cmath>
#include <limits>

#include "common/physics/solver_event.h"
#include "common/physics/time_of_impact.h"

namespace fts::physics {
namespace {

// A fit holds for so many windows, and bodies are numbered anew with it; the epoch moves on after
// so many, before times are much coarser than those of a window.
constexpr std::uint32_t kWindowsPerFit = 64;
constexpr std::uint32_t kWindowsPerEpoch = 16;
// A fit does not hold any more when there are so many strays more than after it, and a window ends
// early when there are so many times as many.
constexpr std::size_t kMoreStrays = 4;
constexpr std::size_t kBodiesPerStray = 1024;
constexpr std::size_t kManyTimes = 4;
// A crowd of which more than one in so many are strays is none.
constexpr std::size_t kFewestPerStray = 64;
// So many bodies that come into another window cost as much as an event.
constexpr std::size_t kBodiesPerTurn = 16;
// So many pairs a body usually need no more memory.
constexpr std::size_t kUsualPairs = 4;
// What happens in so many slices of the queue is brought into the cache together.
constexpr std::uint32_t kSlicesAtOnce = 8;
constexpr std::size_t kMostSoon = 64;
// So many do not fit in the caches that are near.
constexpr std::size_t kFewestToReadAhead = 32768;
// By how many units of round-off the box of a stray is larger than what it must hold.
constexpr double kStrayBoxSlack = 16.0;

}  // namespace

template <typename Scalar>
bool CrowdCoasting<Scalar>::begin(const Bodies<Scalar>& bodies, const Model<Scalar>& model) {
    if (bodies.ids.size() < kFewestInWindows || model.periodic) return false;
    this->take_over(bodies, model);
    number_living();
    kernels_ = &flight_kernels<Scalar>(best_simd_level(), model.equal_radii);
    for (auto& side : pairs_) side.reserve(kUsualPairs * bodies.slots() + kMeetingsAtOnce);
    queue_.reserve(bodies.slots());
    crowd_.reserve(bodies.slots());
    strays_.reserve(bodies.slots());
    near_.reserve(bodies.slots());
    soon_.reserve(kMostSoon);
    due_.reset();
    reads_ahead_ = bodies.ids.size() >= kFewestToReadAhead;
    windows_to_fit_ = windows_to_epoch_ = 0;
    strays_.clear();
    fitted_strays_ = 0;
    begin_window();
    return strays_.size() * kFewestPerStray <= bodies.ids.size();
}

template <typename Scalar>
void CrowdCoasting<Scalar>::begin_span(double span_s, std::uint64_t turns) {
    this->lay_span(span_s);
    turns_left_ = turns;
}

template <typename Scalar>
void CrowdCoasting<Scalar>::break_span() {
    this->break_off_span();
    if (due_) queue_.push(*due_);
    due_.reset();
}

template <typename Scalar>
Due CrowdCoasting<Scalar>::next() {
    while (!crowd_.empty()) {
        if (strays_.size() > fitted_strays_ + kManyTimes * more_strays()) [[unlikely]]
            begin_window();
        if (queue_.empty()) {
            if (!(until_s_ < end_s_)) return {};
            const std::uint64_t turns = crowd_.size() / kBodiesPerTurn + 1;
            if (turns_left_ < turns) return {Happening::kUnfinished, now_s_, 0, 0};
            turns_left_ -= turns;
            this->advance_to(until_s_);
            begin_window();
            continue;
        }
        if (reads_ahead_ && queue_.slice() >= read_to_slice_) read_ahead();
        if (queue_.next().time_s > end_s_) return {};
        const Expected first = queue_.pop();
        if (is_stale(first)) continue;
        if (turns_left_ == 0) {
            queue_.push(first);
            return {Happening::kUnfinished, now_s_, 0, 0};
        }
        --turns_left_;
        due_ = first;
        __builtin_prefetch(&known_[first.a], 1);
        if (first.kind == EventKind::kBall) __builtin_prefetch(&known_[first.b], 1);
        constexpr Happening kWhat[] = {Happening::kMeeting, Happening::kWall, Happening::kFall};
        return {kWhat[static_cast<int>(first.kind)], first.time_s, first.a, first.b};
    }
    return {};
}

// All that the events of the next slices will ask for is read at once, each kind for all of them,
// so that one wait is for many. That is quicker than to have it fetched without waiting.
template <typename Scalar>
void CrowdCoasting<Scalar>::read_ahead() {
    soon_.clear();
    const std::uint32_t end = queue_.slice() + 1 + kSlicesAtOnce;
    for (; read_to_slice_ < end; ++read_to_slice_) {
        queue_.for_each_in(read_to_slice_, [&](const Expected& event) {
            if (soon_.size() + 2 > kMostSoon) return;
            soon_.push_back(event.a);
            if (event.kind == EventKind::kBall) soon_.push_back(event.b);
        });
    }
    for (const std::uint32_t body : soon_) {
        read_ += flights_[body].events + known_[body].apart_from + paths_.cell_of(body);
    }
    for (const std::uint32_t body : soon_) read_ += paths_.read_cells(body);
    for (const std::uint32_t body : soon_) read_ += paths_.read_paths(body);
}

template <typename Scalar>
void CrowdCoasting<Scalar>::number_living() {
    crowd_.clear();
    for (std::uint32_t body = 0; body < this->places(); ++body) {
        if (this->living_at(body) != kNobody) crowd_.push_back(body);
    }
}

template <typename Scalar>
void CrowdCoasting<Scalar>::renumber_by_paths() {
    this->order_.clear();
    paths_.for_each([&](std::uint32_t body) { this->order_.push_back(body); });
    for (const std::uint32_t stray : paths_.strays()) this->order_.push_back(stray);
    for (std::uint32_t body = 0; body < this->places(); ++body) {
        if (this->living_at(body) == kNobody) this->order_.push_back(body);
    }
    this->renumber();
    number_living();
}

template <typename Scalar>
std::size_t CrowdCoasting<Scalar>::more_strays() const {
    return crowd_.size() / kBodiesPerStray + kMoreStrays;
}

template <typename Scalar>
void CrowdCoasting<Scalar>::fit() {
    windows_to_fit_ = kWindowsPerFit;
    paths_.fit(flights_, crowd_, now_s_, model_.walls, model_.equal_radii);
    paths_.begin(flights_, crowd_, now_s_);
    renumber_by_paths();
}

template <typename Scalar>
void CrowdCoasting<Scalar>::begin_window() {
    if (windows_to_epoch_-- == 0) {
        windows_to_epoch_ = kWindowsPerEpoch;
        this->move_epoch(this->coarse_now_s());
    }
    const bool fits = windows_to_fit_ == 0 || strays_.size() > fitted_strays_ + more_strays();
    --windows_to_fit_;
    if (fits) fit();
    until_s_ = now_s_ + paths_.window_s();
    queue_.begin(now_s_, until_s_);
    read_to_slice_ = 0;
    paths_.begin(flights_, crowd_, now_s_);
    strays_.assign(paths_.strays().begin(), paths_.strays().end());
    if (fits) fitted_strays_ = strays_.size();
    expect_all_pairs();
    for (const std::uint32_t stray : strays_) expect_meetings(stray);
    if (model_.walls) {
        for (const std::uint32_t body : paths_.at_border()) expect_walls(body);
        for (const std::uint32_t body : strays_) expect_walls(body);
    }
    if (model_.platform) {
        for (const std::uint32_t body : crowd_) expect_fall(body);
    }
}

template <typename Scalar>
void CrowdCoasting<Scalar>::remove(std::uint32_t body) {
    paths_.remove(body);
    std::erase(strays_, body);
    std::erase(crowd_, body);
    this->bury(body);
}

template <typename Scalar>
void CrowdCoasting<Scalar>::follow(std::uint32_t body) {
    const bool was_stray = paths_.is_stray(body);
    if (!paths_.follow(body, flights_[body], now_s_) && !was_stray) strays_.push_back(body);
}

template <typename Scalar>
void CrowdCoasting<Scalar>::predict_as_seen(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t both[] = {a, b};
    for (const int i : {0, 1}) {
        if (sights_[i].is_one) {
            paths_.follow(sights_[i]);
        } else {
            follow(both[i]);
        }
    }
    for (const int i : {0, 1}) expect_as_seen(both[i], sights_[i]);
}

template <typename Scalar>
void CrowdCoasting<Scalar>::expect_as_seen(std::uint32_t body,
                                           const typename FlightPaths<Scalar>::Sight& sight) {
    if (sight.is_one) {
        expect_meetings(body, [&](auto&& meet) { paths_.for_each_meeting(sight, meet); });
    } else {
        expect_meetings(body);
    }
    expect_others(body);
}

template <typename Scalar>
void CrowdCoasting<Scalar>::expect_meetings(std::uint32_t body) {
    expect_meetings(body, [&](auto&& meet) {
        if (paths_.is_stray(body)) {
            paths_.for_each_within(swept_box(flights_[body]), meet);
        } else {
            paths_.for_each_meeting(body, now_s_, meet);
        }
    });
}

template <typename Scalar>
void CrowdCoasting<Scalar>::expect_meeting(std::uint32_t body, std::uint32_t other) {
    const Flight &one = flights_[body], &two = flights_[other];
    const Approach<Scalar> approach(one, two);
    const Scalar reach = one.radius_m + two.radius_m;
    if (!(approach.rate() < Scalar(0)) || approach.surely_misses(reach)) return;
    const Scalar wait_s = time_until_contact<Scalar>({approach.x_m, approach.y_m},
                                                     {approach.x_mps, approach.y_mps}, reach);
    const double time_s = std::max(now_s_, approach.from_s + static_cast<double>(wait_s));
    if (!(time_s <= until_s_)) return;
    expect_meeting_at(time_s, body, other, this->may_be_kept_apart(approach, reach, body, other));
}

// What expect_meeting does for each pair that may meet, for several at a time.
template <typename Scalar>
void CrowdCoasting<Scalar>::expect_all_pairs() {
    auto &one = pairs_[0], &other = pairs_[1];
    one.clear();
    other.clear();
    paths_.for_each_pair([&](std::uint32_t a, std::uint32_t b) {
        one.push_back(a);
        other.push_back(b);
    });
    const std::size_t count = one.size();
    one.resize(count + kMeetingsAtOnce, crowd_.front());
    other.resize(count + kMeetingsAtOnce, crowd_.front());
    alignas(64) double time_s[kMeetingsAtOnce];
    for (std::size_t first = 0; first < count; first += kMeetingsAtOnce) {
        const std::uint32_t may_be_apart = kernels_->meet(flights_.data(), one.data() + first,
                                                          other.data() + first, now_s_, time_s);
        const std::size_t end = std::min<std::size_t>(kMeetingsAtOnce, count - first);
        for (std::size_t k = 0; k < end; ++k) {
            if (!(time_s[k] <= until_s_)) continue;
            expect_meeting_at(time_s[k], one[first + k], other[first + k],
                              (may_be_apart >> k & 1U) != 0);
        }
    }
}

template <typename Scalar>
void CrowdCoasting<Scalar>::expect_walls(std::uint32_t body) {
    const Flight& flight = flights_[body];
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        const Scalar speed = flight.velocity_mps[axis];
        const std::uint32_t up = speed > Scalar(0) ? 1 : 0, side = 2 * axis + up;
        if (speed == Scalar(0) || !this->has_wall(body, side)) continue;
        const Scalar edge_m = up == 1 ? model_.walls->max_m[axis] - flight.radius_m
                                      : model_.walls->min_m[axis] + flight.radius_m;
        const Scalar way_m = std::copysign(Scalar(1), speed) * (edge_m - flight.position_m[axis]);
        const Scalar wait_s = time_until_wall(way_m, std::abs(speed));
        expect({this->time_after(flight, wait_s), EventKind::kWall, body, side, flight.events, 0});
    }
}

template <typename Scalar>
void CrowdCoasting<Scalar>::expect_fall(std::uint32_t body) {
    const Flight& flight = flights_[body];
    const auto left_s = static_cast<Scalar>(until_s_ - flight.since_s);
    const Vec way_m = flight.velocity_mps.cwiseAbs() * left_s;
    if (surely_stays<Scalar>(*model_.platform, flight.position_m, way_m)) return;
    const Scalar wait_s =
        time_until_edge<Scalar>(*model_.platform, flight.position_m, flight.velocity_mps);
    expect({this->time_after(flight, wait_s), EventKind::kFall, body, 0, flight.events, 0});
}

// Where its disc may be from now to the end of the window.
template <typename Scalar>
auto CrowdCoasting<Scalar>::swept_box(const Flight& flight) const -> Box {
    const Vec from = flight.position_at(now_s_), to = flight.position_at(until_s_);
    const Scalar extent = from.cwiseAbs().maxCoeff() + to.cwiseAbs().maxCoeff() + flight.radius_m;
    const Vec reach =
        Vec::Constant(flight.radius_m + static_cast<Scalar>(kStrayBoxSlack) *
                                            std::numeric_limits<Scalar>::epsilon() * extent);
    return {from.cwiseMin(to) - reach, from.cwiseMax(to) + reach};
}

template class CrowdCoasting<double>;
template class CrowdCoasting<float>;

}  // namespace fts::physics
