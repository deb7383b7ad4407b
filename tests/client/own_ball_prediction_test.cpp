// The own ball is shown where the server will have it, as long as nobody else does anything that it
// cannot know; and what it could not know is blended in, not jumped to.
#include "client/core/own_ball_prediction.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/game/rules.h"
#include "common/game/upgrades.h"

namespace fts::client {
namespace {

using replication::BallState;
using replication::kPositionStepM;
using replication::Snapshot;

constexpr std::uint16_t kMyself = 7;
constexpr double kStepS = game::kTickDurationS;

BallState ball_of(std::uint16_t id, double x_m, std::uint16_t player_id) {
    const game::BallStats stats = game::stats_for({});
    BallState state;
    state.id = id;
    state.x = replication::quantise(x_m, kPositionStepM);
    state.radius = static_cast<std::uint16_t>(
        replication::quantise(stats.radius_m, replication::kRadiusStepM));
    state.mass =
        static_cast<std::uint32_t>(replication::quantise(stats.mass_kg, replication::kMassStepKg));
    state.player_id = player_id;
    state.kind = static_cast<std::uint8_t>(player_id != 0 ? replication::BallKind::kPlayer
                                                          : replication::BallKind::kAi);
    state.handling = replication::quantised(game::handling_of(stats));
    return state;
}

// A server that applies inputs `lag` ticks after they were made, and a client beside it.
class FarServer {
  public:
    explicit FarServer(std::vector<BallState> balls)
        : course_(replication::course_of(physics::Disc{20.0}, {})), server_(course_, balls) {
        tell();
    }

    void tick(const game::InputCommand& input) {
        now_s_ += kStepS;
        sent_.push_back(input);
        prediction.push(input, game::stats_for({}), game::kTickRateHz, now_s_);
        if (sent_.size() <= kLag) return;
        const game::InputCommand& due = sent_[applied_++];
        if (const auto slot = server_.slot_of(1)) {
            server_.steer(*slot,
                          {.thrust_x = due.thrust_x, .thrust_y = due.thrust_y, .brake = due.brake});
            if (game::advance_dash(dash_, game::stats_for({}), due, game::kTickRateHz)) {
                server_.dash(*slot);
            }
        }
        server_.advance(kStepS);
        own_path_.push_back(server_.slot_of(1) ? server_.body(1).position_m
                                               : physics::Vec2d::Zero());
        ++tick_;
        if (tick_ % 2 == 0) tell();
    }
    void tell() {
        Snapshot snapshot;
        snapshot.tick = tick_;
        snapshot.phase = phase;
        server_.snap();
        snapshot.balls = server_.balls();
        prediction.rebase(course_, snapshot, kMyself, static_cast<std::uint32_t>(applied_));
    }
    // What is shown once the newest input has had its tick.
    std::optional<physics::Vec2d> shown_m() {
        const auto pose = prediction.pose(now_s_ + kStepS);
        return pose ? std::optional(pose->position_m) : std::nullopt;
    }
    const std::vector<physics::Vec2d>& own_path() const { return own_path_; }
    replication::LatticeWorld& server() { return server_; }
    double now_s() const { return now_s_; }

    static constexpr std::size_t kLag = 6;
    OwnBallPrediction prediction;
    game::Phase phase = game::Phase::kPlaying;

  private:
    replication::Course course_;
    replication::LatticeWorld server_;
    std::vector<game::InputCommand> sent_;
    std::size_t applied_ = 0;
    replication::Tick tick_ = 100;
    double now_s_ = 50.0;
    game::DashState dash_;
    std::vector<physics::Vec2d> own_path_;
};

game::InputCommand wandering(int i) {
    const double angle = 0.11 * i;
    return {.thrust_x = static_cast<std::int8_t>(std::lround(120.0 * std::cos(angle))),
            .thrust_y = static_cast<std::int8_t>(std::lround(120.0 * std::sin(angle))),
            .brake = i % 40 > 34,
            .dash = i % 50 == 20};
}

TEST(OwnBallPrediction, ShowsWhatTheServerComesToWhenItHasHadTheInputs) {
    FarServer far({ball_of(1, 0.0, kMyself), ball_of(2, 2.5, 0), ball_of(3, -3.0, 0)});
    std::vector<physics::Vec2d> shown;
    for (int i = 0; i < 300; ++i) {
        far.tick(wandering(i));
        shown.push_back(far.shown_m().value());
    }
    double worst_m = 0.0;
    for (std::size_t i = 0; i < far.own_path().size(); ++i) {
        worst_m = std::max(worst_m, (shown[i] - far.own_path()[i]).norm());
    }
    // Rounding to the lattice on the way, magnified by hits.
    EXPECT_LE(worst_m, 1e-3);
}

TEST(OwnBallPrediction, BlendsInWhatNobodyCouldKnow) {
    FarServer far({ball_of(1, 0.0, kMyself)});
    for (int i = 0; i < 60; ++i) far.tick({.thrust_x = 127});
    const physics::Vec2d before_m = far.shown_m().value();
    // Something pushes it aside on the server.
    const std::size_t slot = far.server().slot_of(1).value();
    far.server().steer(slot, {.thrust_y = 127});
    far.server().dash(slot);
    physics::Vec2d last_m = before_m;
    double longest_step_m = 0.0;
    for (int i = 0; i < 40; ++i) {
        far.tick({.thrust_x = 127});
        const physics::Vec2d now_m = far.shown_m().value();
        longest_step_m = std::max(longest_step_m, (now_m - last_m).norm());
        last_m = now_m;
    }
    EXPECT_GT(last_m.y(), 0.5);
    EXPECT_LT(longest_step_m, 0.35);
}

TEST(OwnBallPrediction, IsSilentWhereThereIsNothingToPredict) {
    FarServer far({ball_of(2, 2.5, 0)});
    far.tick({.thrust_x = 127});
    EXPECT_FALSE(far.shown_m());
    FarServer waiting({ball_of(1, 0.0, kMyself)});
    waiting.phase = game::Phase::kCountdown;
    waiting.tell();
    waiting.tick({.thrust_x = 127});
    EXPECT_FALSE(waiting.shown_m());
    FarServer falling({ball_of(1, 19.9, kMyself)});
    for (int i = 0; i < 90; ++i) falling.tick({.thrust_x = 127});
    EXPECT_FALSE(falling.shown_m()) << "it has left the platform";
}

TEST(OwnBallPrediction, MovesWithTheFirstInputWhileTheServerIsFarAway) {
    FarServer far({ball_of(1, 0.0, kMyself)});
    for (int i = 0; i < 3; ++i) far.tick({.thrust_x = 127});
    EXPECT_GT(far.shown_m()->x(), 0.0);
    EXPECT_TRUE(far.own_path().empty());
}

}  // namespace
}  // namespace fts::client
