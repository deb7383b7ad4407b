#include "server/attention.h"

#include <algorithm>
#include <limits>

#include "common/physics/time_of_impact.h"

namespace fts::server {
namespace {

using physics::Vec2d;
using replication::BallState;
using replication::Snapshot;
using replication::Tick;

// Who was never told of has waited this long: so that what is near still comes before what is far.
constexpr Tick kLongestWaitTicks = 600;

std::uint32_t weight_of(const BallState& ball, const BallState& own) {
    const Vec2d apart_m = position_of(ball) - position_of(own);
    const double reach_m = (ball.radius + own.radius) * replication::kRadiusStepM;
    const Vec2d relative_mps = velocity_of(ball) - velocity_of(own);
    if (physics::time_until_contact(apart_m, relative_mps, reach_m) <= Attention::kOnCourseS) {
        return Attention::kOnCourseWeight;
    }
    return apart_m.norm() - reach_m <= Attention::kNearM ? Attention::kNearWeight : 1;
}

}  // namespace

std::vector<BallState> Attention::most_wanted(const Snapshot& now, std::uint16_t own_player,
                                              std::size_t count) const {
    struct Wanted {
        std::uint64_t weight = 0;
        std::uint16_t id = 0;
        const BallState* ball = nullptr;
    };
    const auto own = std::ranges::find_if(now.balls, [&](const BallState& ball) {
        return own_player != 0 && ball.player_id == own_player;
    });
    std::vector<Wanted> wanted;
    wanted.reserve(now.balls.size());
    for (const BallState& ball : now.balls) {
        std::uint64_t weight = ticks_waited(ball.id, now.tick);
        if (own != now.balls.end()) weight *= weight_of(ball, *own);
        if (own != now.balls.end() && ball.id == own->id) {
            weight = std::numeric_limits<std::uint64_t>::max();
        }
        wanted.push_back({weight, ball.id, &ball});
    }
    const std::size_t chosen = std::min(count, wanted.size());
    std::partial_sort(wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(chosen),
                      wanted.end(), [](const Wanted& a, const Wanted& b) {
                          return a.weight != b.weight ? a.weight > b.weight : a.id < b.id;
                      });
    wanted.resize(chosen);
    std::ranges::sort(wanted, {}, &Wanted::id);
    std::vector<BallState> balls;
    balls.reserve(chosen);
    for (const Wanted& one : wanted) balls.push_back(*one.ball);
    return balls;
}

void Attention::told(Tick tick, std::span<const BallState> balls) {
    for (const BallState& ball : balls) {
        if (ball.id >= told_.size()) told_.resize(ball.id + std::size_t{1});
        told_[ball.id] = tick;
    }
}

Tick Attention::ticks_waited(std::uint16_t id, Tick now) const {
    const Tick told = id < told_.size() ? told_[id] : 0;
    return told == 0 || told > now ? kLongestWaitTicks : std::min(kLongestWaitTicks, now - told);
}

}  // namespace fts::server
