// The numbers of the delta format, shared by the two ends of it (delta_encode.cpp,
// delta_decode.cpp) and private to them. proto/WIRE.md, "Snapshot parts", says the same in prose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>

#include "common/game/rules.h"
#include "common/replication/byte_stream.h"
#include "common/replication/delta.h"
#include "common/replication/snapshot.h"
#include "common/replication/state_digest.h"

namespace fts::replication::delta_format {

// ---- header
// ----------------------------------------------------------------------------------------

inline constexpr std::uint8_t kPhaseBits = 0x03;
inline constexpr std::uint8_t kLevelFollows = 0x04;
inline constexpr std::uint8_t kPhaseEndFollows = 0x08;
inline constexpr std::uint8_t kSeveralParts = 0x10;
inline constexpr std::uint8_t kKnownFlags = 0x1F;
static_assert(static_cast<std::uint8_t>(game::Phase::kShop) == kPhaseBits);

// Where a part begins and ends, in the order everything is written: balls by id, coins by id, hits.
inline constexpr std::uint32_t kFirstCoinKey = 0x10000;
inline constexpr std::uint32_t kHitsKey = 0x20000;
inline constexpr std::size_t kKeyBytes = 3;
static_assert(kHitsKey < (1U << (7 * kKeyBytes)));

inline constexpr std::size_t kPartNumberBytes = 2;
static_assert(kMaxParts < (std::size_t{1} << (7 * kPartNumberBytes)));

// Tick, age, flags, part and part count, digest (an arena is smaller), level, end of phase, range.
inline constexpr std::size_t kMaxHeaderBytes =
    kMaxVarintBytes + 1 + 1 + 2 * kPartNumberBytes + 2 + 2 + kMaxVarintBytes + 2 * kKeyBytes;
// Two ends of lists and a number of hits; then the digest of all that came before.
inline constexpr std::size_t kClosingBytes = 3;
inline constexpr std::size_t kDigestBytes = StateDigest::kBytes;
inline constexpr std::size_t kMaxHitsPerPart = 127;

// The age of a baseline is one byte.
static_assert(kMaxBaselineAgeTicks == std::numeric_limits<std::uint8_t>::max());

// ---- records of a list
// -----------------------------------------------------------------------------

// Below kPredictedRun a tag is the mask of what has changed.
inline constexpr std::uint8_t kPredictedRun = 0x80;  // + run - 1
inline constexpr std::uint8_t kRemovedRun = 0xC0;    // + run - 1
inline constexpr std::uint8_t kNudged = 0xE0;        // + 3 (dx + 1) + dy + 1; balls only
inline constexpr std::uint8_t kNotNudged = 4;
inline constexpr std::uint8_t kAdded = 0xF0;
inline constexpr std::uint8_t kEndOfList = 0xFF;
inline constexpr std::uint8_t kMaxPredictedRun = kRemovedRun - kPredictedRun;
inline constexpr std::uint8_t kMaxRemovedRun = kNudged - kRemovedRun;

inline constexpr std::uint8_t kVelocityChanged = 0x01;
inline constexpr std::uint8_t kPositionChanged = 0x02;
inline constexpr std::uint8_t kThrustChanged = 0x04;
inline constexpr std::uint8_t kBrakeChanged = 0x08;
inline constexpr std::uint8_t kBodyChanged = 0x20;
inline constexpr std::uint8_t kKnownBallChanges = 0x2F;

inline constexpr std::uint8_t kRadiusChanged = 0x01;
inline constexpr std::uint8_t kMassChanged = 0x02;
inline constexpr std::uint8_t kMassIsWide = 0x04;
inline constexpr std::uint8_t kKindChanged = 0x08;
inline constexpr std::uint8_t kPlayerChanged = 0x10;
inline constexpr std::uint8_t kHandlingChanged = 0x20;
inline constexpr std::uint8_t kKnownBodyChanges = 0x3F;

inline constexpr std::uint8_t kCoinMoved = 0x01;
inline constexpr std::uint8_t kCoinValueChanged = 0x02;
inline constexpr std::uint8_t kKnownCoinChanges = 0x03;

inline constexpr std::size_t kMaxPairBytes = 9;
inline constexpr std::size_t kMaxBodyBytes = 1 + 2 + 4 + 1 + 2 + 4 * kMaxVarintBytes;
inline constexpr std::size_t kMaxIdBytes = 3;
inline constexpr std::size_t kMaxAddedBytes = 1 + kMaxIdBytes;
inline constexpr std::size_t kMaxBallBytes =
    kMaxAddedBytes + 1 + 2 * kMaxPairBytes + 2 + kMaxBodyBytes;
inline constexpr std::size_t kMaxHitBytes =
    kMaxVarintBytes + 2 * kMaxIdBytes + kMaxPairBytes + kMaxVarintBytes;
inline constexpr std::size_t kMinHitBytes = 5;

static_assert(kMaxHeaderBytes + kMaxBallBytes + kClosingBytes + kDigestBytes <= kMinPartBytes);
static_assert(kMaxHeaderBytes + kMaxHitBytes + kClosingBytes + kDigestBytes <= kMinPartBytes);

// ---- pairs of residuals
// ----------------------------------------------------------------------------

// (x, y) in two's complement behind a prefix that says how wide they are.
struct PairWidth {
    std::uint8_t prefix;
    std::uint8_t prefix_bits;
    std::uint8_t bits;  // of each residual
    std::uint8_t bytes;
};
inline constexpr PairWidth kPairWidths[] = {
    {0, 2, 3, 1}, {1, 2, 7, 2}, {2, 2, 11, 3}, {3, 3, 18, 5}, {7, 8, 32, 9}};

// ---- prediction
// ------------------------------------------------------------------------------------

inline std::int32_t wrapping_sum(std::int32_t a, std::int64_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
inline std::int32_t wrapping_difference(std::int32_t a, std::int32_t b) {
    return wrapping_sum(a, -std::int64_t{b});
}

// Where a ball is after `ticks` at the mean of its two velocities (exact under a constant force,
// and straight-line motion when they are equal), rounded half up. Whole numbers throughout, so that
// both ends get the same.
std::int32_t predicted_position(std::int32_t position, std::int32_t velocity_before,
                                std::int32_t velocity_after, std::uint32_t ticks);
// Nobody pushes it, and a dash is an event that does not repeat itself.
BallState predicted(const BallState& before, std::uint32_t ticks);
inline CoinState predicted(const CoinState& before, std::uint32_t) {
    return before;
}

// Tells two baselines of the same tick apart: FNV-1a over 32-bit words, the top 16 bits of 64.
std::uint16_t digest_of(const Snapshot& snapshot);

// ---- the digest of a part
// --------------------------------------------------------------------------

// What was altered on the way is not shown, whatever it says.
std::vector<std::uint8_t> with_digest(std::span<const std::uint8_t> bytes);
// Nothing when the digest at the end is not that of what comes before it.
std::optional<std::span<const std::uint8_t>> without_digest(std::span<const std::uint8_t> part);

// ---- a decoded part
// --------------------------------------------------------------------------------

struct DecodedPart {
    PartHeader header;
    std::uint32_t begin_key = 0;
    std::uint32_t end_key = kHitsKey;
    Snapshot snapshot;
};
std::optional<DecodedPart> decode(const Snapshot& baseline, std::span<const std::uint8_t> bytes);

}  // namespace fts::replication::delta_format
