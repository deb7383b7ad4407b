// What a snapshot costs on the wire: every coder to many clients over a link that loses datagrams
// and acknowledgements.
//
// There are two traces of the same start and the same steering: a free one, and for the coders that
// ask for it one whose server puts its state on the lattice at every snapshot. Soon they are other
// motions of the same kind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/replication/snapshot_codec.h"
#include "server/lab/arena_trace.h"

namespace fts::lab {

// How many share what is encoded once.
inline constexpr std::size_t kStudyClients = 64;
// No baseline is older than a part can say.
inline constexpr double kMaxDelayMs = 1000.0 * replication::kMaxPredictedTicks / kTraceTickRateHz;

struct ReplicationRequest {
    std::size_t count = 901;
    std::uint64_t seed = 1;   // of the traces, and of what the link loses
    double rate_hz = 20.0;    // 60 over a whole number
    double delay_ms = 100.0;  // [0, kMaxDelayMs]
    double loss = 0.05;
    double seconds = 60.0;
};

struct CoderRow {
    std::string coder;
    bool snapped = false;  // which of the two traces
    double bits_per_ball = 0.0;
    double bytes_per_snapshot = 0.0;
    double datagrams = 0.0;  // a snapshot
    double usable = 0.0;     // part of the snapshots that arrive whole
    double encode_us = 0.0;  // of the processor, a client and snapshot
    double decode_us = 0.0;  // a snapshot
    double baselines = 0.0;  // different ones among all clients, a snapshot
    std::uint64_t decoded = 0;
    std::uint64_t wrong = 0;          // refused, or not what was sent: never shown
    std::uint64_t keyframes = 0;      // snapshots to a client that had acknowledged nothing kept
    std::uint64_t damaged = 0;        // decoded again with a byte altered or missing
    std::uint64_t damaged_shown = 0;  // and not refused
};

struct ReplicationStudy {
    std::vector<CoderRow> rows;
    double rms_speed_mps = 0.0;
    // What snapping adds to the kinetic energy of the snapped trace, as a part of it; below zero
    // where it takes.
    double snapping_energy_per_s = 0.0;
    std::size_t done = 0, of = 0;  // snapshots
    std::string error;             // empty: none
    bool stopped() const { return done < of; }
};

ReplicationStudy study_replication(
    const ReplicationRequest& request, const std::function<bool()>& go_on,
    const std::function<void(std::size_t done, std::size_t of)>& progress);

std::string table_of(const ReplicationRequest& request, const ReplicationStudy& study);
std::string json_of(const ReplicationRequest& request, const ReplicationStudy& study);
std::string svg_of(const ReplicationRequest& request, const ReplicationStudy& study);
std::string command_of(const ReplicationRequest& request);

}  // namespace fts::lab
