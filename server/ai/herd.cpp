#include "server/ai/steering.h"

namespace fts::server::ai {
namespace {

constexpr double kStrayedM = 4.0;
constexpr double kElbowRoomM = 0.4;

}  // namespace

Intent run_with_herd(const Situation& situation) {
    const SeenBall& own = situation.own;
    physics::Vec2d centre = own.position_m;
    physics::Vec2d apart = physics::Vec2d::Zero();
    double count = 1.0;
    for (const SeenBall& other : situation.others) {
        if (other.is_player || other.behaviour != game::Behaviour::kHerd) continue;
        centre += other.position_m;
        count += 1.0;
        const physics::Vec2d away = own.position_m - other.position_m;
        if (away.norm() < own.radius_m + other.radius_m + kElbowRoomM) apart += unit_or_zero(away);
    }
    centre /= count;
    const SeenBall* target = nearest_player(situation);
    if (target == nullptr) return rest(situation);
    const bool strayed = (centre - own.position_m).norm() > kStrayedM;
    Intent intent = seek(situation, strayed ? centre : target->position_m);
    intent.thrust = unit_or_zero(intent.thrust + apart);
    return intent;
}

}  // namespace fts::server::ai
