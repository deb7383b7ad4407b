#include "server/ai/steering.h"

namespace fts::server::ai {
namespace {

// The post is this far from the target towards the inside, and a target this much closer to the
// edge than the guard is struck.
constexpr double kPostStandoffM = 2.0;
constexpr double kStrikeLeadM = 1.0;
constexpr double kStrikeEdgeM = 3.5;

}  // namespace

Intent guard_edge(const Situation& situation) {
    const SeenBall* target = nearest_player(situation);
    if (target == nullptr) return rest(situation);
    const double own_room_m =
        physics::distance_to_edge_m(*situation.platform, situation.own.position_m);
    const double target_room_m =
        physics::distance_to_edge_m(*situation.platform, target->position_m);
    if (target_room_m < kStrikeEdgeM && target_room_m + kStrikeLeadM < own_room_m)
        return seek(situation, target->position_m);
    return arrive(situation, ghost_ball_m(situation, *target, kPostStandoffM));
}

}  // namespace fts::server::ai
