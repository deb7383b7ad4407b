// The ways to send a snapshot that `fts-lab replication` compares: ours, and what others do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/lab/arena_trace.h"

namespace fts::lab {

using Datagram = std::vector<std::uint8_t>;
inline constexpr std::size_t kMaxDatagramBytes = 1200;
// The game's format takes a velocity step for four position steps a second, where the traces have
// ten; velocities are told to it in the former, so that it predicts what it would in a game.
inline constexpr double kGameStepsPerTraceStep =
    kTraceLattice.velocity_step_mps / kTraceLattice.position_step_m * replication::kPositionStepM /
    replication::kVelocityStepMps;

class SnapshotCoder {
  public:
    virtual ~SnapshotCoder() = default;

    virtual std::string name() const = 0;
    // Whether the server keeps its state on the lattice.
    virtual bool wants_lattice() const { return false; }
    // What of a snapshot it is there to show.
    virtual std::vector<replication::BallState> shown(const TraceSnapshot& snapshot) const;
    // `history` ends with the snapshot to send and begins with the baseline; alone: of nothing.
    // Each payload that is longer than a datagram is cut, and needs all its pieces.
    virtual std::vector<Datagram> encode(std::span<const TraceSnapshot> history) const = 0;
    virtual std::optional<std::vector<replication::BallState>> decode(
        const TraceSnapshot* baseline, std::span<const Datagram> payloads) const = 0;
};

std::vector<std::unique_ptr<SnapshotCoder>> all_coders(replication::Tick snapshot_ticks);

// Those of others (plain_coders.cpp).
std::unique_ptr<SnapshotCoder> make_protobuf_coder();
std::unique_ptr<SnapshotCoder> make_bit_packing_coder();
std::unique_ptr<SnapshotCoder> make_delta_coder();

}  // namespace fts::lab
