// ArenaMirror: what a client knows of its arena, from messages and snapshots, and what of it is to
// be seen at a moment. Knows no connection and no clock.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "client/core/glance.h"
#include "client/core/interpolation.h"
#include "client/core/view.h"
#include "common/game/rules.h"
#include "common/replication/lattice_world.h"
#include "common/replication/messages.h"
#include "common/replication/snapshot.h"

namespace fts::client {

// Snapshots kept to draw between; about two seconds at 30 Hz.
inline constexpr std::size_t kMaxHeldSnapshots = 64;
// Hits that wait for their moment to be drawn; the oldest give way.
inline constexpr std::size_t kMaxPendingHits = 4096;

class ArenaMirror {
  public:
    void apply(const replication::ServerMessage& message);
    // Whole, and newer than every one before it.
    // `controls`: what is known of what people did since that one.
    void add(std::shared_ptr<const replication::Snapshot> snapshot,
             std::vector<replication::ControlEvent> controls = {});

    bool has_snapshot() const { return !snapshots_.empty(); }
    replication::Tick newest_tick() const;
    std::uint16_t own_player_id() const { return own_player_id_; }
    const game::Tiers& tiers() const { return wallet_.tiers; }
    // What both ends know of a level; empty before its message has come.
    std::optional<replication::Course> course_of(int number) const;
    int tick_rate_hz() const { return tick_rate_hz_; }
    // Hits that gave way before they were seen.
    std::uint64_t hits_dropped_count() const { return hits_dropped_count_; }

    // Everything but the link. With no snapshot yet: no balls, and server_time_s 0. Moments must
    // not go back from one call to the next; hits up to this one are in it and in no later one.
    View view_at(double server_time_s);
    // Everything but link and age, for who draws nothing at that moment: what is before it is over,
    // as after `view_at`.
    Glance glance_at(double server_time_s);

  private:
    // The newest of that number; null when there is none.
    const replication::LevelStarted* find_level(int number) const;
    // The same, or the newest of all; there is one.
    const replication::LevelStarted& level_numbered(int number) const;
    void drop_before(double draw_tick);
    std::vector<BallPose> poses_at(double draw_tick);
    void add_balls(View& view, double draw_tick);
    void add_hits(View& view, double draw_tick);
    void drop_oldest();

    std::optional<FlightInterpolation> interpolation_;  // on the level that is shown
    int interpolated_level_ = 0;
    int tick_rate_hz_ = game::kTickRateHz;
    std::uint16_t own_player_id_ = 0;
    // The newest last. Drawing lags behind messages, so the level before is still needed for a
    // while.
    std::deque<replication::LevelStarted> levels_;
    std::optional<replication::LevelEnded> last_level_end_;
    std::vector<replication::PlayerInfo> players_;
    replication::Wallet wallet_;
    std::optional<replication::CollisionReport> last_own_hit_;
    std::deque<std::shared_ptr<const replication::Snapshot>> snapshots_;  // ascending by tick
    std::deque<std::vector<replication::ControlEvent>> controls_;         // that led to each
    std::deque<replication::HitState> pending_hits_;
    std::uint64_t hits_dropped_count_ = 0;
};

}  // namespace fts::client
