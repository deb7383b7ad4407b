// Glance: what a player without a screen needs of a frame: the newest whole snapshot as it came,
// which costs nothing, however many balls there are, where a View is all of them at the moment that
// is drawn. Made by Session.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "client/core/view.h"
#include "common/replication/snapshot.h"

namespace fts::client {

struct Glance {
    LinkView link;  // of the View that would be drawn now
    // Null: there is none yet. Sessions that share replays mostly hold the same one.
    std::shared_ptr<const replication::Snapshot> newest;
    // How far `newest` is behind a snapshot that arrives now after its usual flight.
    double age_s = 0.0;
    // That `newest` is of; empty while its message has not come.
    std::optional<physics::Platform> platform;
    int tick_rate_hz = 0;
    std::uint16_t own_player_id = 0;
    std::optional<replication::PlayerInfo> own_player;
    int coins_held = 0;
    game::Tiers tiers{};
};

}  // namespace fts::client
