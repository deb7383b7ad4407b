// OwnBallPrediction: where the own ball is by now, ahead of what the server has said of it: the
// newest snapshot, run on by the physics that both ends share with the inputs that the server has
// not answered yet. Others keep the controls that they had in the snapshot.
//
// It may be wrong: somebody steers otherwise, and hits come out differently. What the next snapshot
// corrects is blended in over about kBlendS; more than kMaxBlendM is taken over at once.
//
// Times in seconds of any monotonic clock, passed in. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/game/input.h"
#include "common/game/movement.h"
#include "common/replication/lattice_world.h"

namespace fts::client {

class OwnBallPrediction {
  public:
    static constexpr double kBlendS = 0.1;
    static constexpr double kMaxBlendM = 2.0;

    struct Pose {
        physics::Vec2d position_m = physics::Vec2d::Zero();
        physics::Vec2d velocity_mps = physics::Vec2d::Zero();
    };

    // An input was made for the next tick; sequence numbers are 1, 2, 3, ... `stats`: of the own
    // ball.
    void push(const game::InputCommand& input, const game::BallStats& stats, int tick_rate_hz,
              double now_s);
    // `snapshot` is the newest, and holds what the inputs up to `acked` have done.
    void rebase(const replication::Course& course, const replication::Snapshot& snapshot,
                std::uint16_t player_id, std::uint32_t acked);

    // Empty while the own ball is not on the platform, nothing moves, or the newest inputs lead it
    // off. Moments do not go back from one call to the next.
    std::optional<Pose> pose(double now_s);

  private:
    struct Sent {
        std::uint32_t sequence = 0;
        game::InputCommand input;
        bool dashes = false;
    };
    void advance(const Sent& sent);
    std::optional<Pose> body() const;

    std::deque<Sent> waiting_;  // not answered yet
    std::uint32_t newest_sequence_ = 0;
    game::DashState dash_;  // after the newest input

    std::optional<replication::LatticeWorld> world_;
    std::uint16_t ball_id_ = 0;
    double tick_s_ = 0.0;
    std::optional<Pose> before_, after_;  // the newest tick
    double pushed_s_ = 0.0;

    physics::Vec2d error_m_ = physics::Vec2d::Zero();  // still to be blended in
    double blended_s_ = 0.0;
};

}  // namespace fts::client
