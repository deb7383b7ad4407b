#include <algorithm>
#include <iterator>

#include "common/replication/delta.h"
#include "common/replication/delta_format.h"

namespace fts::replication {
namespace delta_format {
namespace {

struct Residuals {
    std::int32_t x = 0, y = 0;
};

std::int32_t sign_extended(std::uint64_t packed, unsigned bits) {
    const std::uint64_t sign = std::uint64_t{1} << (bits - 1);
    const std::uint64_t value = packed & ((sign << 1) - 1);
    return static_cast<std::int32_t>(static_cast<std::uint32_t>((value ^ sign) - sign));
}

Residuals read_pair(ByteReader& in) {
    const std::uint8_t first = in.u8();
    for (const PairWidth& width : kPairWidths) {
        if ((first & ((1U << width.prefix_bits) - 1)) != width.prefix) continue;
        if (width.bits == 32) {
            const auto x = static_cast<std::uint32_t>(in.little_endian(4));
            const auto y = static_cast<std::uint32_t>(in.little_endian(4));
            return {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
        }
        const std::uint64_t packed = first | in.little_endian(width.bytes - 1U) << 8;
        return {sign_extended(packed >> width.prefix_bits, width.bits),
                sign_extended(packed >> (width.prefix_bits + width.bits), width.bits)};
    }
    in.fail();
    return {};
}

void read_body_changes(ByteReader& in, BallState& ball) {
    const std::uint8_t mask = in.u8();
    if (mask & ~kKnownBodyChanges) in.fail();
    if (mask & kRadiusChanged) ball.radius = static_cast<std::uint16_t>(in.little_endian(2));
    if (mask & kMassChanged) {
        ball.mass = static_cast<std::uint32_t>(in.little_endian(mask & kMassIsWide ? 4 : 2));
    }
    if (mask & kKindChanged) {
        const std::uint8_t both = in.u8();
        ball.kind = both >> 4;
        ball.behaviour = both & 0x0F;
        if (ball.kind > static_cast<std::uint8_t>(BallKind::kPlayer)) in.fail();
        if (ball.behaviour > static_cast<std::uint8_t>(kLastBehaviour)) in.fail();
    }
    if (mask & kPlayerChanged) ball.player_id = static_cast<std::uint16_t>(in.little_endian(2));
    if (mask & kHandlingChanged) {
        ball.handling.acceleration = in.varint();
        ball.handling.drag = in.varint();
        ball.handling.braking = in.varint();
        ball.handling.dash = in.varint();
    }
}

BallState read_changes(ByteReader& in, std::uint8_t mask, const BallState& before,
                       std::uint32_t ticks) {
    if (mask & ~kKnownBallChanges) in.fail();
    BallState ball = before;
    if (mask & kVelocityChanged) {
        const Residuals velocity = read_pair(in);
        ball.vx = wrapping_sum(before.vx, velocity.x);
        ball.vy = wrapping_sum(before.vy, velocity.y);
    }
    ball.x = predicted_position(before.x, before.vx, ball.vx, ticks);
    ball.y = predicted_position(before.y, before.vy, ball.vy, ticks);
    if (mask & kPositionChanged) {
        const Residuals position = read_pair(in);
        ball.x = wrapping_sum(ball.x, position.x);
        ball.y = wrapping_sum(ball.y, position.y);
    }
    if (mask & kThrustChanged) {
        ball.thrust_x = static_cast<std::int8_t>(in.u8());
        ball.thrust_y = static_cast<std::int8_t>(in.u8());
    }
    ball.brake = before.brake != ((mask & kBrakeChanged) != 0);
    if (mask & kBodyChanged) read_body_changes(in, ball);
    return ball;
}

CoinState read_changes(ByteReader& in, std::uint8_t mask, const CoinState& before, std::uint32_t) {
    if (mask & ~kKnownCoinChanges) in.fail();
    CoinState coin = before;
    if (mask & kCoinMoved) {
        const Residuals position = read_pair(in);
        coin.x = wrapping_sum(before.x, position.x);
        coin.y = wrapping_sum(before.y, position.y);
    }
    if (mask & kCoinValueChanged) {
        coin.value_coins = static_cast<std::uint16_t>(in.little_endian(2));
    }
    return coin;
}

std::optional<BallState> nudged(std::uint8_t tag, const BallState& before, std::uint32_t ticks) {
    const int direction = tag - kNudged;
    if (direction < 0 || direction > 8 || direction == kNotNudged) return std::nullopt;
    BallState ball = predicted(before, ticks);
    ball.x = wrapping_sum(ball.x, direction / 3 - 1);
    ball.y = wrapping_sum(ball.y, direction % 3 - 1);
    return ball;
}
std::optional<CoinState> nudged(std::uint8_t, const CoinState&, std::uint32_t) {
    return std::nullopt;
}

// The entries of `baseline` with ids in [begin, end), and what the part says became of them.
template <typename Entry>
class ListDecoder {
  public:
    ListDecoder(ByteReader& in, const std::vector<Entry>& baseline, std::uint32_t begin_id,
                std::uint32_t end_id, std::uint32_t ticks)
        : in_(in), next_id_(begin_id), end_id_(end_id), ticks_(ticks) {
        const auto before = [](const Entry& entry, std::uint32_t id) { return entry.id < id; };
        old_ = std::lower_bound(baseline.begin(), baseline.end(), begin_id, before);
        old_end_ = std::lower_bound(old_, baseline.end(), end_id, before);
    }

    std::vector<Entry> decode() {
        while (!in_.failed()) {
            const std::uint8_t tag = in_.u8();
            if (in_.failed()) break;
            if (tag == kEndOfList) {
                keep_predicted(old_end_ - old_);
                return std::move(entries_);
            }
            record(tag);
        }
        return {};
    }

  private:
    using Iterator = typename std::vector<Entry>::const_iterator;

    void record(std::uint8_t tag) {
        if (tag == kAdded) return add();
        if (old_ == old_end_) return refuse();
        if (tag < kPredictedRun) return take(read_changes(in_, tag, *old_, ticks_));
        if (tag < kRemovedRun) return keep_predicted(tag - kPredictedRun + 1);
        if (tag < kNudged) return remove(tag - kRemovedRun + 1);
        const auto entry = nudged(tag, *old_, ticks_);
        return entry ? take(*entry) : refuse();
    }
    void refuse() { in_.fail(); }
    void take(const Entry& entry) {
        entries_.push_back(entry);
        next_id_ = entry.id + 1U;
        ++old_;
    }
    void keep_predicted(std::ptrdiff_t count) {
        if (count > old_end_ - old_) return refuse();
        for (; count > 0; --count) take(predicted(*old_, ticks_));
    }
    void remove(std::ptrdiff_t count) {
        if (count > old_end_ - old_) return refuse();
        old_ += count;
        next_id_ = std::prev(old_)->id + 1U;
    }
    void add() {
        const std::uint32_t greatest_id = (old_ == old_end_ ? end_id_ : old_->id) - 1;
        if (next_id_ > greatest_id) return refuse();
        const std::uint32_t id = next_id_ + in_.varint_up_to(greatest_id - next_id_);
        Entry blank;
        blank.id = static_cast<std::uint16_t>(id);
        const std::uint8_t mask = in_.u8();
        if (mask >= kPredictedRun) in_.fail();
        entries_.push_back(read_changes(in_, mask, blank, 0));
        next_id_ = id + 1;
    }

    ByteReader& in_;
    Iterator old_, old_end_;
    std::uint32_t next_id_;
    std::uint32_t end_id_;
    std::uint32_t ticks_;
    std::vector<Entry> entries_;
};

std::vector<HitState> read_hits(ByteReader& in, Tick tick) {
    const std::size_t count = in.u8();
    std::vector<HitState> hits;
    if (count > kMaxHitsPerPart || count > in.rest().size() / kMinHitBytes) {
        in.fail();
        return hits;
    }
    hits.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        HitState hit;
        hit.tick = tick - in.varint();
        hit.a = static_cast<std::uint16_t>(in.varint_up_to(0xFFFF));
        hit.b = static_cast<std::uint16_t>(in.varint_up_to(0xFFFF));
        const Residuals point = read_pair(in);
        hit.x = point.x;
        hit.y = point.y;
        hit.impulse = in.varint();
        hits.push_back(hit);
    }
    return hits;
}

struct Preamble {
    PartHeader header;
    std::uint8_t flags = 0;
};

Preamble read_preamble(ByteReader& in) {
    Preamble preamble;
    PartHeader& header = preamble.header;
    header.tick = in.varint();
    const std::uint8_t age = in.u8();
    if (age > 0 && age >= header.tick) in.fail();
    header.baseline_tick = age == 0 ? 0 : header.tick - age;
    preamble.flags = in.u8();
    if (preamble.flags & ~kKnownFlags) in.fail();
    if (preamble.flags & kSeveralParts) {
        header.part = static_cast<std::uint16_t>(in.varint_up_to(kMaxParts - 1));
        header.part_count = static_cast<std::uint16_t>(in.varint_up_to(kMaxParts));
        if (header.part_count < 2 || header.part >= header.part_count) in.fail();
    }
    return preamble;
}

bool is_empty(const Snapshot& snapshot) {
    return snapshot.tick == 0 && snapshot.balls.empty() && snapshot.coins.empty();
}

// Arena, level and phase; fails unless `baseline` is the one the part was made against.
void read_arena_state(ByteReader& in, const Preamble& preamble, const Snapshot& baseline,
                      Snapshot& out) {
    const bool keyframe = preamble.header.baseline_tick == 0;
    out.tick = preamble.header.tick;
    out.phase = static_cast<game::Phase>(preamble.flags & kPhaseBits);
    if (keyframe) {
        out.arena = in.u8();
        if (!is_empty(baseline)) in.fail();
    } else {
        out.arena = baseline.arena;
        out.level = baseline.level;
        out.phase_end_tick = baseline.phase_end_tick;
        const auto digest = in.little_endian(2);
        if (baseline.tick != preamble.header.baseline_tick || digest != digest_of(baseline)) {
            in.fail();
        }
    }
    if (preamble.flags & kLevelFollows) out.level = static_cast<std::uint16_t>(in.little_endian(2));
    if (preamble.flags & kPhaseEndFollows) out.phase_end_tick = in.varint();
}

void read_range(ByteReader& in, DecodedPart& part) {
    part.begin_key = in.varint_up_to(kHitsKey);
    part.end_key = in.varint_up_to(kHitsKey);
    const bool is_first = part.header.part == 0;
    const bool is_last = part.header.part + 1 == part.header.part_count;
    if (part.begin_key > part.end_key || (is_first && part.begin_key != 0) ||
        (is_last && part.end_key != kHitsKey)) {
        in.fail();
    }
}

}  // namespace

std::optional<DecodedPart> decode(const Snapshot& baseline, std::span<const std::uint8_t> bytes) {
    const auto said = without_digest(bytes);
    if (!said) return std::nullopt;
    ByteReader in(*said);
    const Preamble preamble = read_preamble(in);
    DecodedPart part{.header = preamble.header, .snapshot = {}};
    Snapshot& snapshot = part.snapshot;
    if (in.failed()) return std::nullopt;
    read_arena_state(in, preamble, baseline, snapshot);
    if (preamble.flags & kSeveralParts) read_range(in, part);
    if (in.failed()) return std::nullopt;

    const std::uint32_t ticks = part.header.tick - part.header.baseline_tick;
    const auto id_in = [](std::uint32_t key, std::uint32_t first_key) {
        return std::clamp(key, first_key, first_key + kFirstCoinKey) - first_key;
    };
    snapshot.balls = ListDecoder<BallState>(in, baseline.balls, id_in(part.begin_key, 0),
                                            id_in(part.end_key, 0), ticks)
                         .decode();
    snapshot.coins =
        ListDecoder<CoinState>(in, baseline.coins, id_in(part.begin_key, kFirstCoinKey),
                               id_in(part.end_key, kFirstCoinKey), ticks)
            .decode();
    snapshot.hits = read_hits(in, snapshot.tick);
    if (!in.complete() || !is_canonical(snapshot)) return std::nullopt;
    return part;
}

}  // namespace delta_format

std::optional<PartHeader> peek_part(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    const delta_format::Preamble preamble = delta_format::read_preamble(in);
    if (in.failed()) return std::nullopt;
    return preamble.header;
}

std::optional<Snapshot> decode_part(const Snapshot& baseline, std::span<const std::uint8_t> bytes) {
    auto part = delta_format::decode(baseline, bytes);
    if (!part) return std::nullopt;
    return std::move(part->snapshot);
}

}  // namespace fts::replication
