// Two pure functions: a snapshot as bytes against a baseline that both ends hold, and back. The
// format is in proto/WIRE.md.
//
// A snapshot that does not fit one datagram is cut into parts, each of which can be decoded alone
// with only the baseline: a part covers a range of ball and coin ids. Nothing is left out: every
// ball of the snapshot is in exactly one part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/replication/snapshot.h"

namespace fts::replication {

inline constexpr std::size_t kMinPartBytes = 96;
// With parts of this size or more the greatest snapshot (65536 balls and as many coins, all new,
// and 100,000 hits) fits kMaxParts; delta_encode.cpp has the proof.
inline constexpr std::size_t kAmplePartBytes = 600;
inline constexpr std::size_t kMaxParts = 16383;
inline constexpr Tick kMaxBaselineAgeTicks = 255;  // about four seconds

// Encodes `current` against `baseline` (an empty Snapshot with tick 0 for a keyframe). Each part is
// at most `max_part_bytes` (>= kMinPartBytes). Both snapshots are canonical. Lossless:
// `decode_part` gives back every bit.
//
// A baseline that a part cannot name (tick 0, not older than `current`, more than
// kMaxBaselineAgeTicks older, or of another arena) is not used: the parts are a keyframe then, and
// say so. Empty when the snapshot would need more than kMaxParts parts; never so from
// kAmplePartBytes on.
std::vector<std::vector<std::uint8_t>> encode_delta(const Snapshot& baseline,
                                                    const Snapshot& current,
                                                    std::size_t max_part_bytes);

struct PartHeader {
    Tick tick = 0;
    Tick baseline_tick = 0;  // 0: keyframe
    std::uint16_t part = 0, part_count = 1;
};
// What the part says of itself, or nothing when it is malformed.
std::optional<PartHeader> peek_part(std::span<const std::uint8_t> bytes);

// The balls, coins and hits of this part, as a canonical snapshot (every part carries the arena
// state). Nothing when the bytes are malformed or were altered, or `baseline` is not the one they
// were made against (a keyframe wants an empty Snapshot with tick 0). Never asserts, never
// allocates more than bytes and baseline can justify.
std::optional<Snapshot> decode_part(const Snapshot& baseline, std::span<const std::uint8_t> bytes);

// Puts the parts of one tick together as they arrive, in any order; parts that came before are
// passed over. Holds at most kMaxPendingTicks unfinished ticks: when more are begun the oldest is
// given up, and so is every tick older than one that is completed.
class SnapshotAssembler {
  public:
    static constexpr std::size_t kMaxPendingTicks = 4;

    // The whole snapshot once the last missing part has arrived; nothing until then, or when the
    // part is malformed or does not go with those before (`malformed_count` grows), or not newer
    // than a tick already completed.
    std::optional<Snapshot> add(const Snapshot& baseline, std::span<const std::uint8_t> bytes);
    std::uint64_t malformed_count() const { return malformed_count_; }

  private:
    struct Piece {
        std::uint16_t part = 0;
        std::uint32_t begin_key = 0, end_key = 0;
        Snapshot snapshot;
    };
    struct Pending {
        PartHeader header;          // of the first part that arrived
        std::vector<Piece> pieces;  // sorted by part
    };
    enum class Fit : std::uint8_t { kNew, kRepeated, kContradicts };

    Pending* pending_for(const PartHeader& header);
    static Fit insert(Pending& pending, Piece piece);
    static std::optional<Snapshot> joined(Pending pending);

    std::vector<Pending> pending_;
    Tick newest_complete_ = 0;
    bool any_complete_ = false;
    std::uint64_t malformed_count_ = 0;
};

}  // namespace fts::replication
