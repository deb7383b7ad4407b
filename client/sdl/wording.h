// Numbers and sentences as people read them. Everything here is pure.
#pragma once

#include <string>

#include "client/core/view.h"
#include "common/replication/messages.h"

namespace fts::sdl {

// With a true minus sign; "–" for what is not finite.
std::string fixed(double value, int decimals);
// Like fixed, with a plus sign where it is not negative.
std::string signed_fixed(double value, int decimals);
// "2.3 × 10⁻¹⁶"; "0" for exactly zero.
std::string scientific(double value);
// "0:07", "1:40"; rounded up, never negative.
std::string clock_time(double seconds);
std::string mass_text(double mass_kg);
std::string coins_text(int coins);

// What is conserved in one hit, before and after it.
struct HitSums {
    physics::Vec2d momentum_before_ns, momentum_after_ns;
    double energy_before_j = 0.0, energy_after_j = 0.0;
    double relative_energy_change = 0.0;    // (after - before) / before
    double relative_momentum_change = 0.0;  // |after - before| / (|p1| + |p2|) before
};
HitSums sums_of(const replication::CollisionReport& hit);

// The other party of a hit: "Ana", "the chaser", "an AI ball".
std::string other_name(const client::View& view, const replication::CollisionReport& hit);
// One sentence that says what masses and geometry did.
std::string explain(const replication::CollisionReport& hit);

std::string knock_off_line(const client::View& view, const replication::KnockOff& knock_off,
                           const std::string& victim);
std::string player_name(const client::View& view, std::uint16_t player_id);

}  // namespace fts::sdl
