#include "common/replication/snapshot_codec.h"

#include <algorithm>
#include <cassert>

#include "common/replication/byte_stream.h"
#include "common/replication/range_coder.h"
#include "common/replication/residual_part.h"
#include "common/replication/state_digest.h"

namespace fts::replication {
namespace {

using residual_part::kKnownFlags;
using residual_part::kPartOfSeveral;
using residual_part::PartCoder;

constexpr std::uint32_t kEndOfIds = 0x10000;
constexpr std::size_t kDigestBytes = StateDigest::kBytes;
// Tick, age, flags, two ids, digest.
constexpr std::size_t kMaxPartHeaderBytes = kMaxVarintBytes + 1 + 1 + 2 + 2 + kDigestBytes;
// A part is closed when it has less room than this; a ball hardly ever takes more.
constexpr std::size_t kRoomForBall = 64;
// A ball whose every adaptive bit is the unlikeliest. The longest is one that joins: ten numbers of
// 34 adaptive bits and 30 plain ones; 49 plain bits of its body; 17 adaptive ones of its control;
// whether it joins, and whether another does; and what the coder loses by
// rounding its range, less than a hundredth of a bit for each of at most 500 calls. So one ball
// always fits a part.
constexpr std::size_t kMaxAdaptiveBits = 11;
static_assert(kLeastChance << kMaxAdaptiveBits >= 0x10000U);
constexpr std::size_t kMaxBallBits =
    10 * (34 * kMaxAdaptiveBits + 30) + 49 + (17 + 2) * kMaxAdaptiveBits + 5;
static_assert(kMaxPartHeaderBytes + range_coder::kStateBytes +
                  std::max(kRoomForBall, kMaxBallBits / 8 + 1) <=
              kMinResidualPartBytes);

std::uint32_t digest_of_part(const ResidualPartHeader& header, std::uint8_t flags,
                             std::span<const BallState> balls, std::span<const std::uint8_t> bits) {
    StateDigest digest;
    digest.add(header.tick);
    digest.add(header.baseline_tick);
    digest.add(std::uint32_t{header.first_id} | std::uint32_t{header.last_id} << 16);
    digest.add(std::uint32_t{flags});
    for (const BallState& ball : balls) digest.add(ball);
    digest.add(bits);
    return digest.value();
}

struct OpenedPart {
    ResidualPartHeader header;
    std::uint8_t flags = 0;
    std::uint32_t digest = 0;
    std::span<const std::uint8_t> bits;
};

std::optional<OpenedPart> open(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    OpenedPart part;
    part.header.tick = in.varint();
    const std::uint32_t age = in.u8();
    part.flags = in.u8();
    if ((part.flags & kPartOfSeveral) != 0) {
        part.header.first_id = static_cast<std::uint16_t>(in.little_endian(2));
        part.header.last_id = static_cast<std::uint16_t>(in.little_endian(2));
    }
    part.digest = static_cast<std::uint32_t>(in.little_endian(kDigestBytes));
    if (in.failed() || (part.flags & ~kKnownFlags) != 0) return std::nullopt;
    if (age > 0 && age >= part.header.tick) return std::nullopt;
    if (part.header.first_id > part.header.last_id) return std::nullopt;
    part.header.baseline_tick = age == 0 ? 0 : part.header.tick - age;
    part.bits = in.rest();
    return part;
}

// Both lists side by side, in the order of their ids.
class Merge {
  public:
    Merge(const Prediction& expected, std::span<const BallState> truth)
        : expected_(expected.balls), truth_(truth) {}

    bool done() const { return truth_.empty() && expected_.empty(); }
    std::uint32_t next_id() const {
        const std::uint32_t a = truth_.empty() ? kEndOfIds : truth_.front().id;
        const std::uint32_t b = expected_.empty() ? kEndOfIds : expected_.front().state.id;
        return std::min(a, b);
    }
    // Null where only the other list has the next id.
    const BallState* truth() const {
        return !truth_.empty() && truth_.front().id == next_id() ? &truth_.front() : nullptr;
    }
    const Expectation* expected() const {
        return !expected_.empty() && expected_.front().state.id == next_id() ? &expected_.front()
                                                                             : nullptr;
    }
    void advance() {
        const std::uint32_t id = next_id();
        if (!truth_.empty() && truth_.front().id == id) truth_ = truth_.subspan(1);
        if (!expected_.empty() && expected_.front().state.id == id) {
            expected_ = expected_.subspan(1);
        }
    }

  private:
    std::span<const Expectation> expected_;
    std::span<const BallState> truth_;
};

std::uint8_t flags_of(Merge merge) {
    std::uint8_t flags = 0;
    for (; !merge.done(); merge.advance()) {
        const BallState* const truth = merge.truth();
        const Expectation* const expected = merge.expected();
        if (expected == nullptr) {
            flags |= residual_part::kSomeJoin;
        } else if (truth == nullptr) {
            flags |= residual_part::kSomeLeave;
        } else {
            if (!same_body(expected->state, *truth)) {
                flags |= residual_part::kSomeBodyChanges;
            }
            if (!same_control(expected->state, *truth)) {
                flags |= residual_part::kSomeControlChanges;
            }
        }
    }
    return flags;
}

struct WrittenPart {
    std::vector<std::uint8_t> bytes;
    Merge rest;  // what is left for the next part
    std::size_t entries = 0;
};

// Ends before the part is full, or after so many entries.
WrittenPart write_part(const Prediction& expected, Merge merge, std::uint32_t first_id,
                       std::uint8_t flags, std::size_t max_bytes, std::size_t max_entries) {
    RangeEncoder encoder;
    PartCoder<RangeEncoder> coder(encoder, expected, flags);
    std::vector<BallState> said;
    said.reserve(std::min(max_entries, expected.balls.size()));
    std::uint32_t unsaid_id = first_id;
    std::size_t entries = 0;
    for (; !merge.done() && entries < max_entries; merge.advance(), ++entries) {
        if (encoder.size_limit() + kMaxPartHeaderBytes + kRoomForBall > max_bytes) break;
        const std::uint32_t id = merge.next_id();
        const Expectation* const predicted = merge.expected();
        BallState ball = merge.truth() != nullptr ? *merge.truth() : BallState{};
        if (predicted == nullptr) {
            coder.joins_before(true);
            coder.new_ball(id - unsaid_id, ball);
        } else {
            coder.joins_before(false);
            if (!coder.leaves(merge.truth() == nullptr)) coder.expected_ball(*predicted, ball);
        }
        if (merge.truth() != nullptr) said.push_back(ball);
        unsaid_id = id + 1;
    }
    coder.joins_before(false);
    const std::uint32_t last_id = merge.done() ? kEndOfIds - 1 : merge.next_id() - 1;
    const ResidualPartHeader header{expected.tick, expected.baseline_tick,
                                    static_cast<std::uint16_t>(first_id),
                                    static_cast<std::uint16_t>(last_id)};
    if (first_id > 0 || last_id + 1 < kEndOfIds) flags |= kPartOfSeveral;
    ByteWriter out;
    out.varint(header.tick);
    out.u8(static_cast<std::uint8_t>(
        header.baseline_tick == 0 ? 0 : header.tick - header.baseline_tick));
    out.u8(flags);
    if ((flags & kPartOfSeveral) != 0) {
        out.little_endian(header.first_id, 2);
        out.little_endian(header.last_id, 2);
    }
    const std::vector<std::uint8_t> bits = encoder.finish();
    out.little_endian(digest_of_part(header, flags, said, bits), kDigestBytes);
    out.append(bits);
    return {out.take(), merge, entries};
}

// The balls of an opened part; nothing as soon as they make no sense.
class PartReader {
  public:
    PartReader(const Prediction& expected, const OpenedPart& part)
        : expected_(expected),
          part_(part),
          decoder_(part.bits),
          coder_(decoder_, expected, part.flags),
          unsaid_id_(part.header.first_id) {}

    std::optional<std::vector<BallState>> read() {
        const auto begin = std::lower_bound(
            expected_.balls.begin(), expected_.balls.end(), part_.header.first_id,
            [](const Expectation& ball, std::uint16_t id) { return ball.state.id < id; });
        for (auto it = begin; it != expected_.balls.end() && it->state.id <= part_.header.last_id;
             ++it) {
            if (!read_joins(it->state.id) || decoder_.ran_out()) return std::nullopt;
            if (!coder_.leaves(false)) {
                BallState ball;
                ball.id = it->state.id;
                coder_.expected_ball(*it, ball);
                balls_.push_back(ball);
            }
            unsaid_id_ = it->state.id + 1U;
        }
        if (!read_joins(part_.header.last_id + 1U) || !decoder_.complete()) return std::nullopt;
        return std::move(balls_);
    }

  private:
    bool read_joins(std::uint32_t end_id) {
        while (coder_.joins_before(false)) {
            BallState ball;
            const std::uint32_t gap = coder_.new_ball(0, ball);
            if (decoder_.ran_out() || unsaid_id_ >= end_id || gap >= end_id - unsaid_id_) {
                return false;
            }
            ball.id = static_cast<std::uint16_t>(unsaid_id_ + gap);
            unsaid_id_ = ball.id + 1U;
            balls_.push_back(ball);
        }
        return true;
    }

    const Prediction& expected_;
    const OpenedPart& part_;
    RangeDecoder decoder_;
    PartCoder<RangeDecoder> coder_;
    std::vector<BallState> balls_;
    std::uint32_t unsaid_id_;
};

bool has_known_kinds(const BallState& ball) {
    return ball.kind <= static_cast<std::uint8_t>(BallKind::kPlayer) &&
           ball.behaviour <= static_cast<std::uint8_t>(kLastBehaviour);
}

}  // namespace

std::vector<std::vector<std::uint8_t>> encode_balls(const Prediction& expected,
                                                    std::span<const BallState> truth,
                                                    std::size_t max_part_bytes) {
    assert(max_part_bytes >= kMinResidualPartBytes);
    assert(expected.baseline_tick == 0
               ? expected.balls.empty()
               : expected.tick > expected.baseline_tick &&
                     expected.tick - expected.baseline_tick <= kMaxPredictedTicks);
    Merge merge(expected, truth);
    const std::uint8_t flags = flags_of(merge);
    std::vector<std::vector<std::uint8_t>> parts;
    do {
        const std::uint32_t first_id = parts.empty() ? 0 : merge.next_id();
        std::size_t entries = expected.balls.size() + truth.size();
        WrittenPart part = write_part(expected, merge, first_id, flags, max_part_bytes, entries);
        while (part.bytes.size() > max_part_bytes) {
            entries = part.entries / 2;
            part = write_part(expected, merge, first_id, flags, max_part_bytes, entries);
        }
        parts.push_back(std::move(part.bytes));
        merge = part.rest;
    } while (!merge.done());
    return parts;
}

std::optional<ResidualPartHeader> peek_residual_part(std::span<const std::uint8_t> bytes) {
    const auto part = open(bytes);
    if (!part) return std::nullopt;
    return part->header;
}

std::optional<std::vector<BallState>> decode_balls(const Prediction& expected,
                                                   std::span<const std::uint8_t> bytes) {
    const auto part = open(bytes);
    if (!part || part->header.tick != expected.tick ||
        part->header.baseline_tick != expected.baseline_tick) {
        return std::nullopt;
    }
    auto balls = PartReader(expected, *part).read();
    if (!balls || !std::all_of(balls->begin(), balls->end(), has_known_kinds)) return std::nullopt;
    const std::uint32_t digest = digest_of_part(part->header, part->flags, *balls, part->bits);
    if (digest != part->digest) return std::nullopt;
    return balls;
}

}  // namespace fts::replication
