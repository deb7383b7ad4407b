// The working parts of the swept solver (see solver_swept.h), for one kind of space. Not for
// others.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/physics/broadphase.h"
#include "common/physics/event_queue.h"
#include "common/physics/simultaneous.h"
#include "common/physics/solver.h"
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
    using Touching = typename SweptPaths<Scalar>::Touching;
    static constexpr Scalar kLongAgo = -std::numeric_limits<Scalar>::infinity();
    struct Partner {
        std::uint32_t body = kNoBody;
        [[no_unique_address]] Image image = {};
        friend auto operator<=>(const Partner&, const Partner&) = default;
    };

    // When, and what it changes: swept_engine.cpp.
    void begin(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
               Record<Scalar>& record);
    void begin_knowledge();
    void begin_stretch();
    bool run_stretch();
    void end_stretch(Scalar time_s);
    Scalar stretch_end() const;
    void shorten_stretch(std::uint32_t body);
    void place(std::uint32_t body);
    void fit_strays();
    void predict_everybody();
    template <bool kEqualRadii>
    void predict_pairs();
    void predict_all_walls();
    void predict_images();
    void predict_strays();
    template <bool kAfterSet>
    void predict(std::uint32_t body);
    template <bool kAfterSet>
    void predict_meetings(std::uint32_t body);
    void predict_pair(std::uint32_t a, std::uint32_t b, Image image);
    Path path_of(std::uint32_t body) const {
        return {position_at(body, now_s_), bodies_->velocity_mps[body], bodies_->radius_m[body],
                now_s_ - from_s_};
    }
    template <bool kAfterSet>
    void predict_walls(std::uint32_t body);
    void predict_fall(std::uint32_t body);
    void expect(const Happening& event);
    bool is_stale(const Happening& event) const;
    void count(std::uint32_t events, std::uint32_t cost);
    void after_event(std::uint32_t body, const Partner& partner);
    void place_and_predict(std::uint32_t body);
    void place_and_predict_set();

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
    bool is_pair_touched(const Happening& event);
    void collide_set(const Happening& event);
    bool join_set(const Happening& event);
    void gather_simultaneous();
    void look_around(std::uint32_t body);
    template <typename Visit>
    void for_each_touching(std::uint32_t body, Visit&& visit);
    template <typename Visit>
    void for_each_touched_wall(std::uint32_t body, Visit&& visit) const;
    Scalar extent_m(std::uint32_t body) const;
    void add_to_set(std::uint32_t body);

    Vec position_at(std::uint32_t body, Scalar time_s) const {
        const Vec& position = bodies_->position_m[body];
        const Vec& velocity = bodies_->velocity_mps[body];
        const Scalar since_s = time_s - time_s_[body];
        return {position.x() + velocity.x() * since_s, position.y() + velocity.y() * since_s};
    }
    void move_to(std::uint32_t body, Scalar time_s) {
        if (is_touched_[body] == 0) {
            is_touched_[body] = 1;
            touched_.push_back(body);
        }
        bodies_->position_m[body] = position_at(body, time_s);
        time_s_[body] = time_s;
    }
    // From b to the image of a.
    Vec separation_now(std::uint32_t a, std::uint32_t b, Image image) const {
        return space_.moved(position_at(a, now_s_), image) - position_at(b, now_s_);
    }
    Box<Scalar> swept_box(std::uint32_t body) const;
    bool is_immovable(std::uint32_t body) const { return std::isinf(bodies_->mass_kg[body]); }
    bool was_just_hit(std::uint32_t body) const;
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
    Scalar from_s_ = Scalar(0);  // the present stretch, within the span
    Scalar until_s_ = Scalar(0);
    Scalar now_s_ = Scalar(0);

    std::vector<Scalar> time_s_;        // by body: when its position holds
    std::vector<std::uint32_t> count_;  // by body: events so far
    std::vector<Partner> partner_;      // by body: whom it hit last, if nothing happened since
    std::vector<Scalar> hit_s_;         // by body: the last collision
    std::vector<std::uint8_t> is_touched_;
    std::vector<std::uint32_t> touched_;  // of whom the above is not as it was at first
    SweptPaths<Scalar> paths_;
    std::vector<std::uint32_t> strays_;  // whom paths_ does not hold
    std::size_t fitted_strays_ = 0;
    Broadphase<Scalar> strays_near_;
    std::vector<Box<Scalar>> boxes_;
    EventQueue<Happening> queue_;
    ContactSet<Scalar> set_;
    std::vector<Happening> not_in_set_;
    std::vector<Partner> near_;
};

}  // namespace fts::physics
