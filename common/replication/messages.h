// What client and server say to each other over the reliable ordered channel, as plain values, and
// the two unreliable payloads. wire.h turns them into bytes and back; this file sees no Protobuf.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/game/input.h"
#include "common/game/level.h"
#include "common/game/upgrades.h"
#include "common/physics/scene.h"
#include "common/physics/solver_choice.h"
#include "common/replication/snapshot.h"

namespace fts::replication {

// ---- client to server, reliable
// --------------------------------------------------------------------

struct JoinRequest {
    std::string name;  // cut to kMaxNameBytes, control characters removed, by the server
    int arena = -1;    // -1: wherever there is room
};
struct BuyRequest {
    std::uint64_t request_id = 0;  // unique per player for ever; the same id is never charged twice
    game::Stat stat = game::Stat::kMass;
    int tier = 0;  // the tier the player has seen; a stale one is refused
};
struct ChatRequest {
    std::string text;
};
struct ReadyRequest {};  // done shopping
using ClientMessage = std::variant<JoinRequest, BuyRequest, ChatRequest, ReadyRequest>;

// ---- server to client, reliable
// --------------------------------------------------------------------

struct Welcome {
    std::uint16_t player_id = 0;  // > 0
    int arena = 0;
    int tick_rate_hz = 0;
    int snapshot_rate_hz = 0;
    std::string server_name;
};
struct JoinRefused {
    std::string reason;  // for people
};
struct LevelStarted {
    int number = 0;
    int level_count = 0;
    std::string name;
    std::string hint;
    physics::Platform platform;
    int ai_balls = 0;
    physics::SolverChoice solver;  // both ends simulate with it
};
enum class LevelOutcome : std::uint8_t { kCleared, kLost, kTimeUp, kCampaignComplete };
struct LevelEnded {
    int number = 0;
    LevelOutcome outcome = LevelOutcome::kCleared;
    int coins_earned = 0;  // by the receiving player in this level
};
struct PlayerInfo {
    std::uint16_t player_id = 0;
    std::string name;
    std::uint8_t colour = 0;  // index into the palette
    int knock_offs = 0, assists = 0, falls = 0, lives = 0;
    int coins = 0;
    bool ready = false;
};
struct Roster {  // all players of the arena, sorted by id; sent when anything in it changes
    std::vector<PlayerInfo> players;
};
struct Wallet {  // the receiving player's, sent when it changes
    int coins = 0;
    game::Tiers tiers{};
};
enum class PurchaseOutcome : std::uint8_t {
    kBought,
    kAlreadyBought,  // this request id was settled before; nothing was charged again
    kTooExpensive,
    kLastTier,
    kStalePrice,  // the tier is not the one the player has now
    kShopClosed,
    kStoreFailed,  // it could not be written down; nothing was charged
};
struct PurchaseResult {
    std::uint64_t request_id = 0;
    PurchaseOutcome outcome = PurchaseOutcome::kBought;
};
struct ChatLine {
    std::uint16_t player_id = 0;  // 0: the server
    std::string text;
};
struct KnockOff {
    std::uint16_t victim_ball = 0;
    std::uint16_t victim_player = 0;  // 0: an AI ball
    struct Share {
        std::uint16_t player_id = 0;
        int coins = 0;
        bool assist = false;
    };
    std::vector<Share> shares;  // empty: nobody's doing
};
// One hit of the receiving player's own ball, in full doubles, so that a learner can check that
// momentum and energy are conserved to the last bit.
struct CollisionReport {
    Tick tick = 0;
    double time_in_tick_s = 0.0;
    struct Side {
        std::uint16_t ball = 0;
        std::uint16_t player_id = 0;
        double mass_kg = 0.0, radius_m = 0.0;
        physics::Vec2d position_m = physics::Vec2d::Zero();
        physics::Vec2d velocity_before_mps = physics::Vec2d::Zero();
        physics::Vec2d velocity_after_mps = physics::Vec2d::Zero();
    };
    Side own, other;
    physics::Vec2d normal = physics::Vec2d::UnitX();  // unit, from other to own
    double impulse_ns = 0.0;
    // Above 1: one of so many contacts of one instant that were resolved together. Momentum and
    // energy were kept by all of them, not by these two alone.
    std::uint32_t contacts_at_once = 1;
};
// One of several parts (delta.h) of a snapshot that is not told from a baseline.
struct KeyframePart {
    std::vector<std::uint8_t> part;  // at most kMaxKeyframePartBytes
};
inline constexpr std::size_t kMaxKeyframePartBytes = 1024;
using ServerMessage =
    std::variant<Welcome, JoinRefused, LevelStarted, LevelEnded, Roster, Wallet, PurchaseResult,
                 ChatLine, KnockOff, CollisionReport, KeyframePart>;

// ---- client to server, unreliable
// -------------------------------------------------------------------

inline constexpr std::size_t kMaxInputsPerPacket = 32;

struct InputPacket {
    Tick acked_snapshot_tick = 0;            // the newest whole snapshot held; 0: none
    std::uint32_t first_sequence = 0;        // of inputs[0]; consecutive
    std::vector<game::InputCommand> inputs;  // oldest first, at most kMaxInputsPerPacket
};

// ---- server to client, unreliable
// -------------------------------------------------------------------

// How early inputs come, in the byte that each SnapshotPacket has for it.
inline constexpr double kInputSlackStepTicks = 1.0 / 16.0;
inline constexpr std::uint8_t kMaxInputSlack = 254;  // that long, or longer
inline constexpr std::uint8_t kNoInputWaited = 255;  // a tick had to do without

struct SnapshotPacket {
    enum class Kind : std::uint8_t {
        kStates,         // delta.h: a whole snapshot
        kSomeStates,     // delta.h: some of the balls of a snapshot, without a baseline
        kEvents,         // control_events.h: all that led from the baseline to the newest snapshot
        kEarlierEvents,  // the same, but to one that is not the newest: more is to come
    };
    std::uint32_t acked_input_sequence = 0;  // newest input the server has applied; 0: none
    // The least time that an input waited for its tick since the snapshot before, in
    // kInputSlackStepTicks rounded down.
    std::uint8_t input_slack = kNoInputWaited;
    Kind kind = Kind::kStates;
    std::vector<std::uint8_t> part;
};
bool tells_states(SnapshotPacket::Kind kind);  // and not events

}  // namespace fts::replication
