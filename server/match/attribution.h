// Attribution: who knocked whom off. Pure bookkeeping of contacts; knows no world, coin or message.
//
// The definition:
//
// 1. Each ball keeps the contacts it suffered: {actor, tick, impulse J}. A hit is a contact of both
//    balls, once with each as the victim.
// 2. A contact weighs J 2^(-age / 2 s), and is forgotten
//      - 6 s after it happened;
//      - when its victim respawns;
//      - when its victim has since spent 1.5 s on end well inside the platform, which is where the
//        distance to the edge is at least 0.3 of the greatest there is (on a disc: within 0.7 R).
// 3. A contact is decisive when J >= 0.1 m v_max, m and v_max being the victim's mass and top
// speed.
// 4. When a ball falls, the knock-off belongs to the actor of its latest decisive contact. Without
// one
//    nobody is credited.
// 5. Every other actor whose contacts hold at least 25 % of the weight that remains of all the
// victim's
//    contacts at that moment assists. The owner's share is 70 % and the assistants divide 30 % by
//    their weights; without assistants the owner's share is everything.
// 6. Billiards: whoever holds a share and was itself knocked within 2 s before the contact it is
// held for
//    passes half of it to the one who knocked it. Knocked means by a decisive contact in which the
//    other came at it: at more than half of their approach speed. The receiver passes on in the
//    same way, over at most kMaxLinks links; the victim and those already in the chain receive
//    nothing.
// 7. The knock-off counts for the owner when the owner is a player, else for the first player down
// the
//    owner's chain of 6. Everybody else's share is an assist. AI balls hold shares as players do,
//    and nobody is paid for them.
// 8. Balls that fall in one tick are credited before any of them is forgotten: two that knock each
// other
//    off are each credited for the other.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "common/physics/scene.h"

namespace fts::server {

// A player through all of the player's balls, or one AI ball.
struct Actor {
    std::uint16_t player_id = 0;
    std::uint16_t ball_id = 0;  // 0 for a player
    bool is_player() const { return player_id != 0; }
    friend auto operator<=>(const Actor&, const Actor&) = default;
};

class Attribution {
  public:
    static constexpr double kHalfLifeS = 2.0;
    static constexpr double kExpiryS = 6.0;
    static constexpr double kCalmS = 1.5;
    static constexpr double kCalmEdgeShare = 0.3;
    static constexpr double kDecisiveShare = 0.1;
    static constexpr double kAssistShare = 0.25;
    static constexpr double kOwnerShare = 0.7;
    static constexpr double kBilliardS = 2.0;
    static constexpr int kMaxLinks = 4;
    // When a victim has more, the oldest is forgotten early and counted.
    static constexpr std::size_t kMaxContacts = 64;

    struct Hit {
        Actor victim, actor;
        std::uint32_t tick = 0;  // never less than that of the hit before
        double impulse_ns = 0.0;
        double victim_full_momentum_ns = 0.0;  // m v_max
        bool actor_came = false;               // at more than half of the approach speed
    };
    struct Share {
        Actor actor;
        double fraction = 0.0;  // of the knock-off; all shares add up to 1
        bool assist = false;
        friend bool operator==(const Share&, const Share&) = default;
    };

    void record(const Hit& hit);
    // Once a tick for each ball on the platform.
    void observe(Actor actor, std::uint32_t tick, bool well_inside);
    void respawned(Actor victim);
    // Drops what has expired; call it now and then to keep the memory bounded.
    void expire(std::uint32_t now);
    void clear();

    // Sorted: the one the knock-off counts for first, then by share, greatest first, then by actor.
    // Empty when it was nobody's doing.
    std::vector<Share> credit(Actor victim, std::uint32_t now) const;

    std::uint64_t contacts_forgotten_early() const { return forgotten_early_; }

  private:
    struct Contact {
        Actor actor;
        std::uint32_t tick = 0;
        std::uint64_t order = 0;
        double impulse_ns = 0.0;
        bool decisive = false;
        bool actor_came = false;
    };
    struct Victim {
        std::deque<Contact> contacts;  // oldest first: what is forgotten is at the front
        std::uint32_t inside_since = 0;
        bool inside = false;
    };
    struct Pass {
        Actor holder;
        const Contact* contact = nullptr;
        double fraction = 0.0;
    };

    const Contact* knock_before(Actor holder, const Contact& contact,
                                const std::vector<Actor>& chain) const;
    std::vector<Actor> pass_on(Pass pass, Actor victim, std::map<Actor, double>& fractions) const;

    std::map<Actor, Victim> victims_;
    std::uint64_t next_order_ = 1;
    std::uint64_t forgotten_early_ = 0;
};

// Rule 6: whether the actor did more than half of the approach. `towards_victim` is the unit line
// of centres from the actor to the victim; velocities are those before the hit.
bool came_at(const physics::Vec2d& actor_velocity_mps, const physics::Vec2d& victim_velocity_mps,
             const physics::Vec2d& towards_victim);

// Whole coins by largest remainder: adds up to `coins` exactly; equal remainders favour the earlier
// share.
std::vector<int> split_coins(int coins, const std::vector<Attribution::Share>& shares);

}  // namespace fts::server
