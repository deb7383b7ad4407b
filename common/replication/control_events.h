// What happens to an arena that both ends simulate alike: who steers how, which balls and coins
// come and go, and when a phase begins. With a server that keeps its state on the lattice
// (lattice_world.h) nothing else need travel: arena_replay.h makes snapshots of it.
//
// Two pure functions: the events since a baseline as bytes, with a digest of the snapshot they lead
// to, and back. The format is in proto/WIRE.md, "Control parts".
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/replication/snapshot.h"

namespace fts::replication {

struct ControlEvent {
    Tick tick = 0;  // acts in the step that leads to this tick, and from then on
    std::uint16_t ball = 0;
    std::int8_t thrust_x = 0, thrust_y = 0;
    bool brake = false;
    bool dash = false;  // one dash, in this step alone
    friend bool operator==(const ControlEvent&, const ControlEvent&) = default;
};

struct ArenaChange {
    enum class Kind : std::uint8_t {
        kBallPut,   // before the step: a new ball, or another mass and handling of one
        kBallGone,  // before the step; who falls is gone without it
        kPhase,     // after the step; everything halts unless it is the phase of play
        kCoinPut,   // after the step
        kCoinGone,  // after the step
    };
    Kind kind = Kind::kBallPut;
    Tick tick = 0;        // the step that leads to this tick
    BallState ball = {};  // of kBallGone its id alone
    CoinState coin = {};  // of kCoinGone its id alone
    game::Phase phase = game::Phase::kWaiting;
    Tick phase_end_tick = 0;

    static ArenaChange ball_put(Tick tick, const BallState& ball);
    static ArenaChange ball_gone(Tick tick, std::uint16_t id);
    static ArenaChange phase_begun(Tick tick, game::Phase phase, Tick phase_end_tick);
    static ArenaChange coin_put(Tick tick, const CoinState& coin);
    static ArenaChange coin_gone(Tick tick, std::uint16_t id);
    friend bool operator==(const ArenaChange&, const ArenaChange&) = default;
};
inline constexpr ArenaChange::Kind kLastChange = ArenaChange::Kind::kCoinGone;

struct ArenaEvents {
    std::vector<ControlEvent> controls;  // by ball, then by tick, without repeats of both
    std::vector<ArenaChange> changes;    // in the order they happened
    friend bool operator==(const ArenaEvents&, const ArenaEvents&) = default;
};
bool is_canonical(const ArenaEvents& events);

// `events` is canonical; every tick is in (baseline.tick, outcome.tick], which are at most
// kMaxPredictedTicks apart, and every control of a ball that is in the baseline or put. Arena and
// level of both snapshots are the same. `outcome` is what a replay gives; its hits do not matter.
std::vector<std::uint8_t> encode_events(const Snapshot& baseline, const ArenaEvents& events,
                                        const Snapshot& outcome);

struct ControlPartHeader {
    Tick tick = 0, baseline_tick = 0;
};
// What the part says of itself, or nothing when it is malformed.
std::optional<ControlPartHeader> peek_control_part(std::span<const std::uint8_t> bytes);

struct ControlPart {
    Tick tick = 0;
    std::uint32_t outcome_digest = 0;
    ArenaEvents events;
};
// Nothing when the bytes are not a part made against a baseline of this tick. Whether it was this
// baseline, and whether the bytes are those that were sent, the digest of the outcome tells: where
// it is another, the part is to be refused.
std::optional<ControlPart> decode_events(const Snapshot& baseline,
                                         std::span<const std::uint8_t> bytes);

// Of balls, coins, phase and level; not of tick or hits.
std::uint32_t outcome_digest_of(const Snapshot& snapshot);

}  // namespace fts::replication
