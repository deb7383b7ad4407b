// Field: one snapshot as pilots look at it, in SI units: whatever takes time for each ball is found
// here once, and all bots that hold the snapshot share it. Sight: the same as one of them sees it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "client/core/glance.h"

namespace fts::bot {

struct FieldBall {
    std::uint16_t id = 0;
    std::uint16_t player_id = 0;  // 0: an AI ball
    physics::Vec2d position_m = physics::Vec2d::Zero();
    physics::Vec2d velocity_mps = physics::Vec2d::Zero();
    double radius_m = 0.0;
    double mass_kg = 0.0;
    double to_edge_m = 0.0;  // below 0: past it
};

struct Field {
    double server_time_s = 0.0;
    physics::Platform platform;
    std::vector<FieldBall> ai_balls;  // each sorted by id
    std::vector<FieldBall> player_balls;
    std::vector<client::CoinView> coins;
};

Field field_of(const replication::Snapshot& snapshot, const physics::Platform& platform,
               int tick_rate_hz);

struct Sight {
    const Field& field;
    const FieldBall* own = nullptr;  // of player_balls; null while it is off the platform
    game::Tiers tiers{};
    double lag_s = 0.0;  // from the moment of the field to the one at which a command acts
};

Sight sight_of(const Field& field, std::uint16_t own_player_id, const game::Tiers& tiers,
               double lag_s);

// The fields of the newest snapshots of one server's arenas. Not thread-safe.
class Fields {
  public:
    // Null before a snapshot and its level are known.
    std::shared_ptr<const Field> of(const client::Glance& glance);

  private:
    struct Kept {
        std::shared_ptr<const replication::Snapshot> snapshot;
        std::shared_ptr<const Field> field;
    };
    struct Arena {
        // Not all bots have the newest yet.
        std::array<Kept, 4> recent;
        std::size_t next = 0;
    };
    std::map<std::uint8_t, Arena> arenas_;
};

}  // namespace fts::bot
