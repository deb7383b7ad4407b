// The working parts of the swept solver (see solver_swept.h), for one kind of space. Not for
// others.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "common/physics/broadphase.h"
#include "common/physics/event_queue.h"
#include "common/physics/impact.h"
#include "common/physics/simultaneous.h"
#include "common/physics/solver.h"
#include "common/physics/solver_swept.h"
#include "common/physics/swept_paths.h"
#include "common/physics/swept_space.h"

namespace fts::physics {

template <typename Scalar, typename Space>
class SweptEngine {
  public:
    DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                              Record<Scalar>& record);

  private:
    using Vec = Vec2<Scalar>;
    using Image = typename Space::Image;
    using Happening = Event<Scalar, Image>;
    using Path = typename SweptPaths<Scalar>::Motion;
    using Course = typename SweptPaths<Scalar>::Course;
    using Touching = typename SweptPaths<Scalar>::Touching;
    using Sight = typename SweptPaths<Scalar>::Sight;
    static constexpr Scalar kLongAgo = -std::numeric_limits<Scalar>::infinity();
    struct Partner {
        std::uint32_t body = kNoBody;
        [[no_unique_address]] Image image = {};
        friend auto operator<=>(const Partner&, const Partner&) = default;
    };

    // Of one body, in the drift.
    struct alignas(32) Known {
        Scalar time_s = Scalar(0);  // when its position holds
        Scalar hit_s = kLongAgo;    // the last collision
        std::uint32_t count = 0;    // events so far, and before
        Partner partner = {};       // whom it hit last, if nothing happened since
        bool is_touched = false;
    };
    // What a set of simultaneous contacts keeps apart until anything else happens to one of them.
    struct Hold {
        std::uint32_t a, b;  // b: or kWallHold and the side
        [[no_unique_address]] Image image;
        std::uint32_t count_a, count_b;
        friend auto operator<=>(const Hold&, const Hold&) = default;
    };
    static constexpr std::uint32_t kWallHold = 0xfffffff0;

    // When, and what it changes: swept_engine.cpp.
    void begin(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
               Record<Scalar>& record);
    void begin_knowledge();
    void begin_stretch();
    bool run_stretch();
    std::uint32_t looks_for(Scalar span_s) const;
    void begin_look(std::uint32_t look, Scalar until_s);
    bool run_look();
    void end_stretch(Scalar time_s);
    Scalar stretch_end() const;
    void shorten_stretch(std::uint32_t body);
    bool is_stale(const Happening& event) const {
        return event.count_a != known_[event.a].count ||
               (event.kind == EventKind::kBall && event.count_b != known_[event.b].count);
    }
    void count(std::uint32_t events, std::uint32_t cost) {
        report_.events += events;
        spent_ += cost;
    }
    void after_event(std::uint32_t body, const Partner& partner) {
        ++known_[body].count;
        known_[body].partner = partner;
        known_[body].hit_s = now_s_;
    }

    // What may happen: swept_predictions.cpp.
    void predict_everybody();
    void place_and_predict(std::uint32_t body);
    void follow_and_predict(std::uint32_t a, std::uint32_t b);
    void place_and_predict_set();
    std::span<const Vec> places();
    void begin_sights();
    void place(std::uint32_t body, const Course& course);
    void fit_strays();
    template <bool kEqualRadii>
    void predict_pairs();
    void predict_all_walls();
    void predict_images();
    void predict_strays();
    template <bool kAfterSet>
    void predict(std::uint32_t body, const Course& course);
    template <bool kAfterSet>
    void predict_meetings(std::uint32_t body, const Course& course);
    void predict_pair(std::uint32_t a, std::uint32_t b, Image image);
    void predict_from_now(std::uint32_t body, std::uint32_t other);
    template <bool kAfterSet>
    void predict_walls(std::uint32_t body);
    void predict_fall(std::uint32_t body);
    void expect(const Happening& event);
    void expect_meeting(Scalar time_s, std::uint32_t one, std::uint32_t other);
    // In the present look. What was due in an earlier one has happened there, or turned out to be
    // nothing.
    bool is_seen(Scalar time_s) const {
        return !(time_s > seen_until_s_ || time_s > until_s_) &&
               (is_first_look_ || !(time_s <= from_s_));
    }
    void keep(const Hold& hold) {
        if (looks_ > 1) kept_.push_back(hold);
    }
    // Of those kept in earlier looks.
    bool is_kept(const Hold& hold) const {
        return !is_first_look_ && !kept_.empty() &&
               std::binary_search(kept_.begin(), kept_.begin() + kept_before_, hold);
    }
    Path path_of(std::uint32_t body) const {
        return {position_at(body, now_s_), bodies_->velocity_mps[body], bodies_->radius_m[body],
                now_s_ - from_s_};
    }
    Course course_of(std::uint32_t body) const { return paths_.course_of(path_of(body)); }
    // By more than so much on each axis.
    [[gnu::always_inline]] bool keeps_off_walls(const Vec& position_m, Scalar radius_m,
                                                const Vec& by_m) const {
        const auto& walls = *model_->walls;
        const auto keeps_off = [&](int axis) {
            const Scalar below = position_m[axis] - (walls.min_m[axis] + radius_m);
            const Scalar above = (walls.max_m[axis] - radius_m) - position_m[axis];
            return std::min(below, above) > by_m[axis];
        };
        return keeps_off(0) && keeps_off(1);
    }

    // What: swept_collisions.cpp.
    void process(const Happening& event);
    void collide_pair(const Happening& event);
    void collide_wall(const Happening& event);
    void fall(std::uint32_t body);
    void touch(std::uint32_t a, std::uint32_t b, Image image);

    // Several at once: swept_sets.cpp.
    struct Disc {
        std::uint32_t body;
        Vec position_m;
        Scalar radius_m;
        Scalar extent_m;
    };
    Disc disc_at(std::uint32_t body, const Vec& position_m) const;
    Box<Scalar> reach_of(const Disc& disc) const;
    bool touches(const Disc& disc, std::uint32_t other, const Vec& separation_m) const;
    Touching touching(const Disc& disc, Image image) const;
    Vec separation_from(const Disc& disc, std::uint32_t other, Image image) const {
        return space_.moved(disc.position_m, image) - position_at(other, now_s_);
    }
    bool is_touched_by_others(const Happening& event);
    enum class Among : std::uint8_t { kAll, kStrays };
    bool is_pair_touched(const Happening& event, Among others);
    bool look_ahead(const Happening& event, const std::optional<Impact<Scalar>>& hit);
    void sort_out_kept();
    void collide_set(const Happening& event);
    bool join_set(const Happening& event);
    void gather_simultaneous();
    void look_around(std::uint32_t body);
    template <typename Visit>
    void for_each_touching(std::uint32_t body, Visit&& visit);
    template <typename Visit>
    void for_each_touched_wall(std::uint32_t body, Visit&& visit) const;
    bool touches_wall(std::uint32_t body) const;
    // The largest length that goes into where a body is within the span.
    [[gnu::always_inline]] Scalar extent_m(std::uint32_t body) const {
        const Vec &position = bodies_->position_m[body], &velocity = bodies_->velocity_mps[body];
        return std::max(std::abs(position.x()), std::abs(position.y())) +
               std::max(std::abs(velocity.x()), std::abs(velocity.y())) * span_s_;
    }
    void add_to_set(std::uint32_t body);

    [[gnu::always_inline]] Vec position_at(std::uint32_t body, Scalar time_s) const {
        const Vec& position = bodies_->position_m[body];
        const Vec& velocity = bodies_->velocity_mps[body];
        const Scalar since_s = time_s - known_[body].time_s;
        return {position.x() + velocity.x() * since_s, position.y() + velocity.y() * since_s};
    }
    void move_to(std::uint32_t body, Scalar time_s) {
        Known& known = known_[body];
        bodies_->position_m[body] = position_at(body, time_s);
        known.time_s = time_s;
        // Whether it is new is not to be foreseen.
        touched_[touched_count_] = body;
        touched_count_ += known.is_touched ? 0U : 1U;
        known.is_touched = true;
    }
    // From b to the image of a.
    Vec separation_now(std::uint32_t a, std::uint32_t b, Image image) const {
        const Vec at_a = space_.moved(position_at(a, now_s_), image), at_b = position_at(b, now_s_);
        return {at_a.x() - at_b.x(), at_a.y() - at_b.y()};
    }
    std::span<const std::uint32_t> touched() const { return {touched_.data(), touched_count_}; }
    Box<Scalar> swept_box(std::uint32_t body) const;
    bool is_immovable(std::uint32_t body) const { return std::isinf(bodies_->mass_kg[body]); }
    bool was_just_hit(std::uint32_t body) const {
        return now_s_ - known_[body].hit_s < static_cast<Scalar>(kElasticWithin) * span_s_;
    }
    Scalar restitution_of(bool just_hit) const {
        return just_hit ? Scalar(1) : model_->restitution;
    }

    Space space_;
    Bodies<Scalar>* bodies_ = nullptr;
    const Model<Scalar>* model_ = nullptr;
    Record<Scalar>* record_ = nullptr;
    DriftReport<Scalar> report_;
    std::uint32_t budget_ = 0;
    std::uint32_t spent_ = 0;  // of the budget
    Scalar span_s_ = Scalar(0);
    Scalar until_s_ = Scalar(0);  // the end of the present stretch, within the span
    // The present look, within the stretch: in it events are found before look_until_s_, and those
    // seen up to seen_until_s_.
    Scalar from_s_ = Scalar(0);
    Scalar look_until_s_ = Scalar(0);
    Scalar seen_until_s_ = Scalar(0);
    bool is_first_look_ = true;
    std::uint32_t looks_ = 1;  // in a stretch
    Scalar now_s_ = Scalar(0);

    std::vector<Known> known_;  // by body
    // Of whom that is not as it was at first: so many, and room for one more.
    std::size_t touched_count_ = 0;
    std::vector<std::uint32_t> touched_;
    SweptPaths<Scalar> paths_;
    std::vector<std::uint32_t> strays_;  // whom paths_ does not hold
    std::size_t fitted_strays_ = 0;
    Broadphase<Scalar> strays_near_;
    std::vector<Box<Scalar>> boxes_;
    EventQueue<Happening> queue_;
    ContactSet<Scalar> set_;
    std::vector<Happening> not_in_set_;
    Sight sight_;  // of two that hit
    std::vector<Partner> near_;
    std::vector<Hold> kept_;
    std::ptrdiff_t kept_before_ = 0;  // the present look
    std::vector<Vec> places_;
    std::vector<Vec> ends_;  // of those touched
};

}  // namespace fts::physics
