// View: everything that a screen draws or a pilot decides on, at one moment, as plain values in SI
// units. Made anew for each frame by Session; holds no reference into it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/game/level.h"
#include "common/game/upgrades.h"
#include "common/physics/scene.h"
#include "common/replication/messages.h"

namespace fts::client {

struct BallView {
    std::uint16_t id = 0;
    physics::Vec2d position_m = physics::Vec2d::Zero();  // interpolated
    physics::Vec2d velocity_mps = physics::Vec2d::Zero();
    physics::Vec2d thrust = physics::Vec2d::Zero();  // |thrust| <= 1
    double radius_m = 0.0;
    double mass_kg = 0.0;
    bool is_player = false;
    bool is_own = false;
    bool braking = false;
    game::Behaviour behaviour = game::Behaviour::kChaser;  // of an AI ball
    std::uint16_t player_id = 0;
    std::uint8_t colour = 0;
    std::string name;  // of a player
};

struct CoinView {
    std::uint16_t id = 0;
    physics::Vec2d position_m = physics::Vec2d::Zero();
    int value_coins = 1;
};

struct HitView {
    physics::Vec2d point_m = physics::Vec2d::Zero();
    double impulse_ns = 0.0;
    std::uint16_t a = 0, b = 0;
};

struct LinkView {
    double rtt_s = 0.0;
    double loss = 0.0;  // [0, 1]
    // The moment drawn is this far behind a snapshot that arrives now after its usual flight.
    double interpolation_delay_s = 0.0;
    bool starved = false;  // this frame had no newer snapshot to draw towards
    // The least time that inputs waited at the server for their tick, as last reported; 0: none
    // was there in time.
    double input_slack_s = 0.0;
};

struct View {
    double server_time_s = 0.0;  // the moment that is drawn
    game::Phase phase = game::Phase::kWaiting;
    double phase_remaining_s = 0.0;  // 0 when open-ended
    replication::LevelStarted level;
    std::optional<replication::LevelEnded> last_level_end;
    std::vector<BallView> balls;  // sorted by id
    std::vector<CoinView> coins;
    std::vector<HitView> hits;  // that happened since the previous view was made
    std::vector<replication::PlayerInfo> players;
    std::uint16_t own_player_id = 0;
    std::optional<std::size_t> own_ball;  // index into balls; empty while off the platform
    // Where the server's snapshots have the own ball at this moment, when it is drawn where it is
    // predicted to be instead.
    std::optional<physics::Vec2d> own_by_server_m;
    int coins_held = 0;
    game::Tiers tiers{};
    std::optional<replication::CollisionReport> last_own_hit;
    LinkView link;

    const replication::PlayerInfo* own_player() const;
};

}  // namespace fts::client
