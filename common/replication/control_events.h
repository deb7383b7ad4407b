// What steers a simulation that both ends have in common: who changed what they hold, and when.
// With a server that keeps its state on the lattice (lattice_world.h) nothing else need travel.
//
// Two pure functions: the events since a baseline as bytes, with a digest of the state they lead
// to, and back; and `replay`, which both ends run. The format is in proto/WIRE.md, "Control parts".
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/replication/lattice_world.h"
#include "common/replication/snapshot.h"

namespace fts::replication {

struct ControlEvent {
    Tick tick = 0;  // acts from this tick on
    std::uint16_t ball = 0;
    std::int8_t thrust_x = 0, thrust_y = 0;
    bool brake = false;
    friend bool operator==(const ControlEvent&, const ControlEvent&) = default;
};

// Sorted by ball, then by tick, without repeats of both: how they travel.
bool is_canonical(std::span<const ControlEvent> events);

// What becomes of `baseline` in `ticks` when the server snaps at every multiple of
// `snapshot_ticks`. Events of balls that are not there do nothing.
std::vector<BallState> replay(const Course& course, std::span<const BallState> baseline,
                              Tick baseline_tick, Tick tick, Tick snapshot_ticks,
                              std::span<const ControlEvent> events);

// `events` is canonical, of balls of the baseline, in [baseline_tick, tick); at most
// kMaxPredictedTicks lie between the two. `outcome` is what `replay` gives.
std::vector<std::uint8_t> encode_events(std::span<const BallState> baseline, Tick baseline_tick,
                                        Tick tick, std::span<const ControlEvent> events,
                                        std::span<const BallState> outcome);

struct ControlPart {
    Tick tick = 0, baseline_tick = 0;
    std::uint32_t outcome_digest = 0;
    std::vector<ControlEvent> events;
};
// Nothing when the bytes are not a part made against a baseline of this tick. Whether it was this
// baseline, and whether the bytes are those that were sent, the digest of the outcome tells: where
// it is another, the part is to be refused.
std::optional<ControlPart> decode_events(std::span<const BallState> baseline, Tick baseline_tick,
                                         std::span<const std::uint8_t> bytes);
std::uint32_t digest_of(std::span<const BallState> balls);

}  // namespace fts::replication
