// Two pure functions: a snapshot as bytes against a baseline that both ends hold, and back. The format
// is in proto/WIRE.md.
//
// A snapshot that does not fit one datagram is cut into parts, each of which can be decoded alone with
// only the baseline: a part covers a range of ball and coin ids. Nothing is left out: every ball of the
// snapshot is in exactly one part.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/replication/snapshot.h"

namespace fts::replication {

// Encodes `current` against `baseline` (an empty Snapshot with tick 0 for a keyframe). Each part is at
// most `max_part_bytes` (>= 64). Both snapshots are canonical.
std::vector<std::vector<std::uint8_t>> encode_delta(const Snapshot& baseline, const Snapshot& current,
                                                    std::size_t max_part_bytes);

struct PartHeader {
    Tick tick = 0;
    Tick baseline_tick = 0;  // 0: keyframe
    std::uint16_t part = 0, part_count = 1;
};
// What the part says of itself, or nothing when it is malformed.
std::optional<PartHeader> peek_part(std::span<const std::uint8_t> bytes);

// The balls, coins and hits of this part, as a snapshot (arena state filled in from every part).
// Nothing when the bytes are malformed or `baseline` is not the one they were made against. Never
// asserts, never allocates more than the bytes can justify.
std::optional<Snapshot> decode_part(const Snapshot& baseline, std::span<const std::uint8_t> bytes);

// Puts the parts of one tick together as they arrive, in any order.
class SnapshotAssembler {
  public:
    // The whole snapshot once the last missing part has arrived; nothing until then, or when the part
    // is malformed (`malformed_count` grows) or older than a tick already completed.
    std::optional<Snapshot> add(const Snapshot& baseline, std::span<const std::uint8_t> bytes);
    std::uint64_t malformed_count() const { return malformed_count_; }

  private:
    struct Pending {
        Tick tick = 0;
        std::vector<std::optional<Snapshot>> parts;
    };
    std::vector<Pending> pending_;
    Tick newest_complete_ = 0;
    std::uint64_t malformed_count_ = 0;
};

}  // namespace fts::replication
