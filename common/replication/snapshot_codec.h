// Two pure functions: the balls of a snapshot as bytes against what both ends expect of them, and
// back. What is coded is the residual, truth less expectation, by an adaptive range coder whose
// models start from what the expectation says of itself. The format is in proto/WIRE.md, "Residual
// parts".
//
// Every part can be decoded alone, with only the baseline that the prediction was made of, and ends
// with a digest of what it says: a part that was altered, cut short, or made against another
// prediction is nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/replication/prediction.h"
#include "common/replication/snapshot.h"

namespace fts::replication {

inline constexpr std::size_t kMinResidualPartBytes = 1024;
// The age of a baseline is one byte.
inline constexpr Tick kMaxPredictedTicks = 255;

// `truth` ascends by id, without repeats, as do the balls of the prediction. The prediction is for
// a tick at most kMaxPredictedTicks after its baseline's, or of nothing. Each part has at most
// `max_part_bytes` (>= kMinResidualPartBytes) and covers the ids from one up to the next part's.
std::vector<std::vector<std::uint8_t>> encode_balls(const Prediction& expected,
                                                    std::span<const BallState> truth,
                                                    std::size_t max_part_bytes);

struct ResidualPartHeader {
    Tick tick = 0;
    Tick baseline_tick = 0;  // 0: of nothing
    std::uint16_t first_id = 0, last_id = 0xFFFF;
};
// What the part says of itself, or nothing when it is malformed: what to predict to decode it.
std::optional<ResidualPartHeader> peek_residual_part(std::span<const std::uint8_t> bytes);

// All balls with the ids that the part covers. Nothing when the bytes are not a part of this tick
// and baseline, or their digest is another. Never asserts on bytes; never does more work than bytes
// and prediction can justify.
std::optional<std::vector<BallState>> decode_balls(const Prediction& expected,
                                                   std::span<const std::uint8_t> bytes);

}  // namespace fts::replication
