// A crowd in straight flight, and what will happen within a short window of time: what coasting.h
// does with a calendar for few bodies, or unlike ones, for many of a kind and in less time.
//
// When a window begins all that may happen in it is found at once, along paths that lie sorted in
// memory (flight_paths.h); an event in it only looks for what else its bodies will do before the
// window ends. So nothing is foreseen that is far off, hardly anything is foreseen in vain, and
// nobody is told of cells. Where windows begin and end depends on what happened alone, and not on
// ticks.
//
// When two bodies meet is a function of their last events, as it is in coasting.h, so that windows
// show in no bits but those of the epoch, which moves on with them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/physics/event_queue.h"
#include "common/physics/flight_filter.h"
#include "common/physics/flight_paths.h"
#include "common/physics/flights.h"

namespace fts::physics {

template <typename Scalar>
class CrowdCoasting : public Flights<Scalar, Known> {
  public:
    using Base = Flights<Scalar, Known>;
    using typename Base::Flight;
    using typename Base::Vec;

    // Takes over all living bodies. False when they are not of a kind: then somebody else should.
    bool begin(const Bodies<Scalar>& bodies, const Model<Scalar>& model);

    // A span begins where the last one ended. `turns`: so many events may come up, or bodies come
    // into another window.
    void begin_span(double span_s, std::uint64_t turns);
    // What is due next, which is not told of again.
    Due next();
    // What was due has happened.
    void settle() { due_.reset(); }
    // The span ends now. What is due has not happened, and stays due.
    void break_span();

    // Whether it may touch a wall.
    bool is_at_border(std::uint32_t body) const {
        return paths_.is_stray(body) || paths_.is_at_border(body);
    }
    void predict(std::uint32_t body) {
        follow(body);
        expect_meetings(body);
        expect_others(body);
    }
    // The same of one, or of two that met and looked about them in this order.
    void predict_as_seen(std::uint32_t body) { predict(body); }
    void predict_as_seen(std::uint32_t a, std::uint32_t b);
    void remove(std::uint32_t body);

    // Whether touches(body, other, separation) is true of anybody whose distance to `body`, now, is
    // below `factor` times their reach: hardly more than 1.
    template <typename Touches>
    bool look_around(std::uint32_t body, Scalar factor, Touches&& touches) {
        return look_around(body, body, factor, touches);
    }
    // The same of each of two that meet, of anybody but them. What each will meet if it flies on
    // like this is seen at the same time, for predict_as_seen.
    template <typename Touches>
    bool look_around_both(const Turning<Scalar>& one, const Turning<Scalar>& other, Scalar factor,
                          Touches&& touches);
    // Calls visit(other, separation) for every body that is near `body`, itself included, in
    // ascending order of indices; the separation is from that one to `body`, now.
    template <typename Visit>
    void for_each_near(std::uint32_t body, Visit&& visit);

  private:
    using Expected = Event<double>;
    using Base::flights_, Base::known_, Base::model_, Base::now_s_, Base::end_s_;
    using Box = typename Model<Scalar>::Box;

    std::size_t more_strays() const;
    void fit();
    void begin_window();
    void number_living();
    void renumber_by_paths();
    void read_ahead();
    bool is_stale(const Expected& event) const {
        return flights_[event.a].events != event.count_a ||
               (event.kind == EventKind::kBall && flights_[event.b].events != event.count_b);
    }
    void follow(std::uint32_t body);
    void expect_others(std::uint32_t body) {
        if (model_.walls && is_at_border(body)) expect_walls(body);
        if (model_.platform) expect_fall(body);
    }
    void expect_as_seen(std::uint32_t body, const typename FlightPaths<Scalar>::Sight& sight);
    void expect_meetings(std::uint32_t body);
    // With strays and with those for whom `search` calls what it is given.
    template <typename Search>
    void expect_meetings(std::uint32_t body, Search&& search) {
        const auto meet = [&](std::uint32_t other) {
            if (other != body) expect_meeting(body, other);
        };
        std::for_each(strays_.begin(), strays_.end(), meet);
        search(meet);
    }
    void expect_meeting(std::uint32_t body, std::uint32_t other);
    // Within the window.
    void expect_meeting_at(double time_s, std::uint32_t a, std::uint32_t b, bool may_be_apart) {
        if (this->is_immovable(a) && this->is_immovable(b)) return;
        if (may_be_apart && this->are_kept_apart(a, b, {})) return;
        queue_.push({time_s, EventKind::kBall, a, b, flights_[a].events, flights_[b].events});
    }
    void expect_all_pairs();
    void expect_walls(std::uint32_t body);
    void expect_fall(std::uint32_t body);
    void expect(const Expected& event) {
        if (event.time_s <= until_s_) queue_.push(event);
    }
    Box swept_box(const Flight& flight) const;
    template <typename Touches>
    bool look_around(std::uint32_t body, std::uint32_t partner, Scalar factor, Touches&& touches);

    double until_s_ = 0.0;  // the end of the window
    std::uint64_t turns_left_ = 0;
    FlightPaths<Scalar> paths_;
    typename FlightPaths<Scalar>::Sight sights_[2];  // of two that meet
    std::vector<std::uint32_t> crowd_;               // living bodies, in the order of memory
    std::vector<std::uint32_t> strays_;              // who is not among the paths
    std::size_t fitted_strays_ = 0;
    EventQueue<Expected> queue_;
    std::optional<Expected> due_;
    std::uint32_t windows_to_fit_ = 0, windows_to_epoch_ = 0;
    std::vector<std::uint32_t> near_;  // indices
    const FlightKernels<Scalar>* kernels_ = nullptr;
    RoomyVector<std::uint32_t> pairs_[2];  // by expect_all_pairs, one and other
    bool reads_ahead_ = false;
    std::uint32_t read_to_slice_ = 0;
    std::vector<std::uint32_t> soon_;  // by read_ahead
    std::uint32_t read_ = 0;           // of no account
};

template <typename Scalar>
template <typename Touches>
bool CrowdCoasting<Scalar>::look_around(std::uint32_t body, std::uint32_t partner, Scalar factor,
                                        Touches&& touches) {
    bool any = false;
    const auto look_at = [&](std::uint32_t other) {
        if (any || other == body || other == partner) return;
        any = touches(body, other, this->separation_m(body, other));
    };
    for (const std::uint32_t stray : strays_) look_at(stray);
    if (paths_.is_stray(body)) {
        paths_.for_each_within(swept_box(flights_[body]), look_at);
    } else {
        paths_.for_each_close(body, now_s_, factor, look_at);
    }
    return any;
}

template <typename Scalar>
template <typename Touches>
bool CrowdCoasting<Scalar>::look_around_both(const Turning<Scalar>& one,
                                             const Turning<Scalar>& other, Scalar factor,
                                             Touches&& touches) {
    sights_[0] = paths_.see(one, now_s_, factor);
    sights_[1] = paths_.see(other, now_s_, factor);
    if (!sights_[0].is_one || !sights_[1].is_one) [[unlikely]] {
        return look_around(one.body, other.body, factor, touches) ||
               look_around(other.body, one.body, factor, touches);
    }
    const bool sees_more = !paths_.sees_but_one(sights_[0]) || !paths_.sees_but_one(sights_[1]);
    if (!sees_more && strays_.empty()) [[likely]]
        return false;
    bool any = false;
    for (const auto& sight : sights_) {
        const auto look_at = [&](std::uint32_t third) {
            if (any || third == one.body || third == other.body) return;
            any = touches(sight.body, third, this->separation_m(sight.body, third));
        };
        std::for_each(strays_.begin(), strays_.end(), look_at);
        if (sees_more) paths_.for_each_close(sight, look_at);
    }
    return any;
}

template <typename Scalar>
template <typename Visit>
void CrowdCoasting<Scalar>::for_each_near(std::uint32_t body, Visit&& visit) {
    near_.clear();
    const auto add = [&](std::uint32_t other) { near_.push_back(this->index_of(other)); };
    std::for_each(strays_.begin(), strays_.end(), add);
    paths_.for_each_within(swept_box(flights_[body]), add);
    std::sort(near_.begin(), near_.end());
    const Vec position = this->position_m(body);
    for (const std::uint32_t index : near_) {
        const std::uint32_t other = this->body_at(index);
        visit(other, Vec(position - this->position_m(other)));
    }
}

extern template class CrowdCoasting<double>;
extern template class CrowdCoasting<float>;

}  // namespace fts::physics
