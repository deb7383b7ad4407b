#include "server/ai/steering.h"

namespace fts::server::ai {
namespace {

constexpr double kStandoffM = 1.0;
constexpr double kAlignedCosine = 0.8;

}  // namespace

Intent chase(const Situation& situation) {
    const SeenBall* target = nearest_player(situation);
    if (target == nullptr) return rest(situation);
    const physics::Vec2d ghost = ghost_ball_m(situation, *target, 0.0);
    const physics::Vec2d push = unit_or_zero(target->position_m - ghost);
    const physics::Vec2d line = unit_or_zero(target->position_m - situation.own.position_m);
    if (line.dot(push) >= kAlignedCosine) return seek(situation, ghost + push);
    return seek(situation, ghost_ball_m(situation, *target, kStandoffM));
}

}  // namespace fts::server::ai
