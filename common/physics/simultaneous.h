// Contacts of one instant, resolved as a set: a rack that is broken, Newton's cradle, a ball in a
// wedge. Generalised reflections of Smith, Kaufman, Vouga, Tamstorf and Grinspun, "Reflections on
// Simultaneous Impact" (SIGGRAPH 2012).
//
// Policy. In one pass all contacts that approach are looked at together, (va - vb).n < 0 beyond
// round-off with n the unit normal from b towards a. They fall into components that share no
// movable body. A component of one contact is an ordinary collision, computed by impact() to the
// same bits. A component of several is reflected as a whole: with M the masses and N the normals
// of its contacts,
//
//     v' = the velocity nearest to v in the norm of M with N^T v' >= 0,
//        = v + M^-1 N lambda,   lambda >= 0,   lambda . (N^T v') = 0,
//     v+ = v + (1 + e) s (v' - v),   s = -(lambda . N^T v) / |v' - v|_M^2,
//
// where s is 1 but for the residue of lambda. Impulses only push and are equal and opposite, so
// momentum is kept; s makes the kinetic energy of a pass with e = 1 exact whatever lambda is; v' is
// unique, so the mirror symmetry of a scene survives and the order of contacts does not matter.
// Passes follow until nothing approaches: one ball into a cradle sends one out, two send two.
//
// Restitution below 1 acts on a body once: who was hit in an earlier pass, or is added as
// `elastic`, loses nothing (the TC model, see solver_swept.h). Otherwise a cradle would need
// infinitely many passes.
//
// It ends. Let q be the positions about any point. A pass changes q.Mv by (1 + e) s sum(lambda_i
// reach_i) > 0, and |q.Mv| <= |q|_M |v|_M does not grow since energy does not. So impulses have a
// finite sum, while each pass takes some in proportion to an approach above round-off: the passes
// are finitely many. How many depends on masses (two balls and a wall count the digits of pi), and
// a ball that exactly fills the room between two immovable ones has no way out. Passes are
// therefore bounded by max_passes(), and reaching it is reported; what still approaches then is the
// solver's next event.
//
// Contacts are found as they are needed: round the bodies of the event, then round each body that
// was hit. A crystal at rest is not gathered for a hit at its rim.
//
// How a solver uses it, when the pair (a, b) is due at `now` and anything else touches a or b:
//
//     set.begin(bodies.slots());
//     set.add(a, velocity[a], mass[a], was_just_hit(a));   // and b, and the bodies of all other
//     set.touch(a, b, position[a] - position[b]);          // collisions due at this same instant
//     const auto look_around = [&](std::uint32_t body) {
//         for (every ball c that touches body) {
//             set.add(c, velocity[c], mass[c], was_just_hit(c));     // harmless when known
//             set.touch(body, c, position[body] - position[c]);      // so is this
//         }
//         for (every side of the box that body touches) set.touch_wall(body, side);
//     };
//     const auto report = [&](std::span<const Hit<Scalar>> together) {
//         record_hits(bodies, now, together, record);      // hit_record.h
//     };
//     const Resolution done = set.resolve(restitution, look_around, report);
//     for (const std::uint32_t body : set.hit_bodies()) {
//         velocity[body] = set.velocity_mps(body);         // position: that of `now`
//         ... count as changed, so that what was predicted is stale
//     }
//     predict each of hit_bodies() anew, but for the pairs and walls of which set.keeps_apart()
//     and set.keeps_off_wall() are true: to round-off these do not approach.
//
// A periodic scene gives the separation to the image that is touched. Not thread-safe. No
// allocation after warm-up. The same calls give the same bits.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/physics/cone_projection.h"
#include "common/physics/scene.h"

namespace fts::physics {

// Passes of one resolution: so many, and so many more for each contact found.
inline constexpr std::uint32_t kBaseReflectionPasses = 64;
inline constexpr std::uint32_t kReflectionPassesPerContact = 4;
constexpr std::uint64_t max_passes(std::size_t contacts) {
    return kBaseReflectionPasses + std::uint64_t{kReflectionPassesPerContact} * contacts;
}

// What speeds and impulses are good to, in units of their round-off: what approaches slower than
// that does not approach.
inline constexpr double kApproachRoundOff = 16.0;

inline constexpr std::uint32_t kNoBody = 0xffffffff;

// What one contact did in one pass.
template <typename Scalar>
struct Hit {
    std::uint32_t a = kNoBody;
    std::uint32_t b = kNoBody;  // none: a wall
    Vec2<Scalar> separation_m;  // from b, or its image, to a; zero for a wall
    Vec2<Scalar> normal;        // unit, from b or the wall towards a
    Scalar impulse_ns;          // > 0
    Vec2<Scalar> velocity_a_before_mps, velocity_a_after_mps;
    Vec2<Scalar> velocity_b_before_mps, velocity_b_after_mps;  // zero for a wall
};

struct Resolution {
    std::uint32_t passes = 0;
    std::uint32_t hits = 0;
    bool unfinished = false;  // max_passes() was reached and something still approaches
};

// How near is touching: |gap| up to this, for a pair whose radii add up to `reach_m` and whose
// positions are known to the round-off of `extent_m`, the largest length that went into them
// (coordinates, and the way moved in the span).
template <typename Scalar>
Scalar touch_tolerance_m(Scalar reach_m, Scalar extent_m);

template <typename Scalar>
class ContactSet {
  public:
    using Vec = Vec2<Scalar>;

    // Forgets everything. `slots` is above every body's index.
    void begin(std::uint32_t slots);

    // A body that may be hit. `mass_kg` up to infinity; `elastic`: loses nothing when hit. Without
    // effect when it is a member already.
    void add(std::uint32_t body, const Vec& velocity_mps, Scalar mass_kg, bool elastic);
    // Two members touch; `separation_m`, not zero, is from b to a. Without effect when known or
    // when neither can be moved.
    void touch(std::uint32_t a, std::uint32_t b, const Vec& separation_m);
    // A member touches a side of the box: -x, +x, -y, +y.
    void touch_wall(std::uint32_t body, std::uint32_t side);

    // Passes until nothing approaches. look_around(body) is asked once for each movable member
    // that was there before or was hit. report(hits) is told of each component of each pass, in
    // order.
    template <typename LookAround, typename Report>
    Resolution resolve(Scalar restitution, LookAround&& look_around, Report&& report);

    // After resolve: those that were hit, immovable ones too, in the order they first were.
    std::span<const std::uint32_t> hit_bodies() const { return hit_bodies_; }
    bool holds(std::uint32_t body) const;
    // Of a member.
    const Vec& velocity_mps(std::uint32_t body) const;
    bool was_hit(std::uint32_t body) const;

    // Whether this contact is in the set and does not approach.
    bool keeps_apart(std::uint32_t a, std::uint32_t b, const Vec& separation_m) const;
    bool keeps_off_wall(std::uint32_t body, std::uint32_t side) const;
    std::size_t contacts() const { return contacts_.size(); }

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;

    struct Member {
        std::uint32_t body = kNoBody;
        Vec velocity_mps = Vec::Zero();
        Scalar mass_kg = Scalar(0);
        Scalar speed_scale_mps = Scalar(0);  // the largest speed it had or was given
        std::uint32_t first_contact = kNone;
        std::uint32_t parent = kNone;  // in the forest of components
        std::uint32_t in_projection = kNone;
        bool elastic = false;
        bool was_hit = false;
        bool has_looked = false;
        bool is_immovable = false;
    };
    struct Touch {
        std::uint32_t a = kNone, b = kNone;            // members; b kNone for a wall
        std::uint32_t next_a = kNone, next_b = kNone;  // the next contact of a, of b
        std::uint32_t side = 0;                        // of the box, when it is a wall
        Vec separation_m = Vec::Zero(), normal = Vec::Zero();
        bool is_due = false;
    };
    struct Projected {  // a member in projection_
        std::uint32_t member = kNone;
        Vec2d push_ns = Vec2d::Zero();  // what its contacts give it
        double pushed_ns = 0.0;         // the sum of their sizes
    };
    struct Approaching {
        std::uint32_t component;
        std::uint32_t contact;
        friend auto operator<=>(const Approaching&, const Approaching&) = default;
    };

    std::uint32_t index_of(std::uint32_t body) const;
    std::uint32_t find(std::uint32_t a, std::uint32_t b, std::uint32_t side) const;
    std::uint32_t next_of(std::uint32_t contact, std::uint32_t member) const;
    void link(const Touch& touch);
    void make_due(std::uint32_t contact);
    Scalar approach_mps(const Touch& touch) const;
    bool approaches(const Touch& touch) const;
    std::uint32_t root_of(std::uint32_t member);
    void join(std::uint32_t contact);
    bool find_components();
    // Component [first, last) of approaching_; fills hits_.
    void reflect(std::size_t first, std::size_t last, Scalar restitution);
    void reflect_one(const Touch& touch, Scalar restitution);
    void reflect_many(std::size_t first, std::size_t last, double restitution);
    Scalar restitution_of(std::size_t first, std::size_t last, Scalar restitution) const;
    void project(std::size_t first, std::size_t last);
    void push(std::uint32_t member, double impulse_ns, const Vec2d& normal);
    void move_on(const Projected& projected, double step);
    void give(std::uint32_t member, const Vec& velocity_mps, Scalar pushed_mps);
    void mark_hit(std::uint32_t member);
    Hit<Scalar> hit_of(const Touch& touch, Scalar impulse_ns) const;
    void everybody_looks();
    std::uint32_t who_looks_next();

    std::vector<Member> members_;
    std::vector<Touch> contacts_;
    std::vector<std::uint32_t> member_of_;  // by body
    std::vector<std::uint32_t> due_;        // contacts whose approach may have changed
    std::vector<Approaching> approaching_;
    std::vector<std::uint32_t> to_look_;  // members, in order; those up to looked_ have
    std::size_t looked_ = 0;
    std::vector<std::uint32_t> hit_bodies_;
    std::vector<Hit<Scalar>> hits_;
    ConeProjection projection_;
    std::vector<Projected> projected_;
};

template <typename Scalar>
template <typename LookAround, typename Report>
Resolution ContactSet<Scalar>::resolve(Scalar restitution, LookAround&& look_around,
                                       Report&& report) {
    Resolution done;
    everybody_looks();
    for (;;) {
        for (std::uint32_t body = who_looks_next(); body != kNoBody; body = who_looks_next()) {
            look_around(body);
        }
        if (!find_components()) return done;
        if (done.passes >= max_passes(contacts_.size())) {
            done.unfinished = true;
            return done;
        }
        ++done.passes;
        for (std::size_t first = 0, last = 0; first < approaching_.size(); first = last) {
            last = first + 1;
            while (last < approaching_.size() &&
                   approaching_[last].component == approaching_[first].component) {
                ++last;
            }
            reflect(first, last, restitution);
            done.hits += static_cast<std::uint32_t>(hits_.size());
            report(std::span<const Hit<Scalar>>(hits_));
        }
    }
}

extern template class ContactSet<double>;
extern template class ContactSet<float>;

}  // namespace fts::physics
