#include "server/ai/steering.h"

namespace fts::server::ai {
namespace {

constexpr double kAtEaseM = 6.0;
constexpr double kUneasyEdgeM = 4.0;

}  // namespace

Intent flee(const Situation& situation) {
    const SeenBall* hunter = nearest_player(situation);
    if (hunter == nullptr) return rest(situation);
    const SeenBall& own = situation.own;
    const physics::Vec2d away = own.position_m - hunter->position_m;
    const double distance_m = away.norm();
    if (distance_m > kAtEaseM) return rest(situation);

    const double room_m = physics::distance_to_edge_m(*situation.platform, own.position_m);
    const physics::Vec2d edge = physics::nearest_edge_point_m(*situation.platform, own.position_m);
    const physics::Vec2d inward = unit_or_zero(own.position_m - edge);
    physics::Vec2d wanted = unit_or_zero(away);
    if (room_m < kUneasyEdgeM) {
        // With its back to the edge it slips away along it.
        const physics::Vec2d along = wanted - wanted.dot(inward) * inward;
        physics::Vec2d slip = unit_or_zero(along);
        if (slip.isZero()) slip = {-inward.y(), inward.x()};
        const double fear_of_edge = 1.0 - room_m / kUneasyEdgeM;
        wanted = slip + inward * fear_of_edge;
    }
    return {.thrust = unit_or_zero(wanted)};
}

}  // namespace fts::server::ai
