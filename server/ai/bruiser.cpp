#include "server/ai/steering.h"

namespace fts::server::ai {
namespace {

constexpr double kDashReachM = 3.5;
constexpr double kAimedCosine = 0.95;

}  // namespace

Intent charge(const Situation& situation) {
    const SeenBall* target = nearest_player(situation);
    if (target == nullptr) return rest(situation);
    Intent intent = seek(situation, target->position_m);
    const physics::Vec2d way = target->position_m - situation.own.position_m;
    intent.dash = way.norm() < kDashReachM && unit_or_zero(way).dot(intent.thrust) > kAimedCosine;
    return intent;
}

}  // namespace fts::server::ai
