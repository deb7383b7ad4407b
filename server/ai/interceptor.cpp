#include <algorithm>

#include "server/ai/steering.h"

namespace fts::server::ai {

Intent intercept(const Situation& situation) {
    const SeenBall* target = nearest_player(situation);
    if (target == nullptr) return rest(situation);
    const double distance_m = (target->position_m - situation.own.position_m).norm();
    // The situation is already one look-ahead on; a far target is foreseen once more as far at
    // most.
    const double flight_s =
        std::min(distance_m / situation.stats.top_speed_mps, situation.look_ahead_s);
    return seek(situation, target->position_m + target->velocity_mps * flight_s);
}

}  // namespace fts::server::ai
