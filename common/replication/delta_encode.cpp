#include <algorithm>
#include <cassert>
#include <utility>

#include "common/replication/delta.h"
#include "common/replication/delta_format.h"

namespace fts::replication {
namespace delta_format {
namespace {

constexpr std::size_t kMaxCoinBytes = kMaxAddedBytes + 1 + kMaxPairBytes + 2;
constexpr std::size_t kIds = 0x10000;
constexpr std::size_t kManyHits = 100'000;
// A part is closed when the next record does not fit, so at most one record's worth of it is left
// empty; and, of the parts that are full by their number of hits, there are few.
constexpr std::size_t kLeastUsedBytes =
    kAmplePartBytes - kMaxHeaderBytes - kClosingBytes - kDigestBytes - kMaxBallBytes;
static_assert((kIds * (kMaxBallBytes + kMaxCoinBytes) + kManyHits * kMaxHitBytes) /
                      kLeastUsedBytes +
                  kManyHits / kMaxHitsPerPart + 1 <=
              kMaxParts);

bool fits(std::int32_t value, unsigned bits) {
    const std::int64_t limit = std::int64_t{1} << (bits - 1);
    return value >= -limit && value < limit;
}

void write_pair(ByteWriter& out, std::int32_t x, std::int32_t y) {
    const auto* width = std::find_if(std::begin(kPairWidths), std::end(kPairWidths),
                                     [&](const PairWidth& candidate) {
                                         return fits(x, candidate.bits) && fits(y, candidate.bits);
                                     });
    if (width->bits == 32) {
        out.u8(width->prefix);
        out.little_endian(static_cast<std::uint32_t>(x), 4);
        out.little_endian(static_cast<std::uint32_t>(y), 4);
        return;
    }
    const std::uint64_t mask = (std::uint64_t{1} << width->bits) - 1;
    const std::uint64_t packed =
        width->prefix | (static_cast<std::uint32_t>(x) & mask) << width->prefix_bits |
        (static_cast<std::uint32_t>(y) & mask) << (width->prefix_bits + width->bits);
    out.little_endian(packed, width->bytes);
}

void write_body_changes(ByteWriter& out, const BallState& before, const BallState& now) {
    const bool kind_changed = now.kind != before.kind || now.behaviour != before.behaviour;
    const bool mass_is_wide = now.mass > 0xFFFF;
    std::uint8_t mask = 0;
    if (now.radius != before.radius) mask |= kRadiusChanged;
    if (now.mass != before.mass) mask |= mass_is_wide ? kMassChanged | kMassIsWide : kMassChanged;
    if (kind_changed) mask |= kKindChanged;
    if (now.player_id != before.player_id) mask |= kPlayerChanged;
    if (now.handling != before.handling) mask |= kHandlingChanged;
    out.u8(mask);
    if (mask & kRadiusChanged) out.little_endian(now.radius, 2);
    if (mask & kMassChanged) out.little_endian(now.mass, mass_is_wide ? 4 : 2);
    if (kind_changed) out.u8(static_cast<std::uint8_t>(now.kind << 4 | now.behaviour));
    if (mask & kPlayerChanged) out.little_endian(now.player_id, 2);
    if (mask & kHandlingChanged) {
        out.varint(now.handling.acceleration);
        out.varint(now.handling.drag);
        out.varint(now.handling.braking);
        out.varint(now.handling.dash);
    }
}

void write_changes(ByteWriter& out, const BallState& before, const BallState& now,
                   std::uint32_t ticks) {
    const std::int32_t dvx = wrapping_difference(now.vx, before.vx);
    const std::int32_t dvy = wrapping_difference(now.vy, before.vy);
    const std::int32_t dx =
        wrapping_difference(now.x, predicted_position(before.x, before.vx, now.vx, ticks));
    const std::int32_t dy =
        wrapping_difference(now.y, predicted_position(before.y, before.vy, now.vy, ticks));
    std::uint8_t mask = 0;
    if (dvx != 0 || dvy != 0) mask |= kVelocityChanged;
    if (dx != 0 || dy != 0) mask |= kPositionChanged;
    if (now.thrust_x != before.thrust_x || now.thrust_y != before.thrust_y) mask |= kThrustChanged;
    if (now.brake != before.brake) mask |= kBrakeChanged;
    if (!same_body(before, now)) mask |= kBodyChanged;

    const bool barely_moved = dx >= -1 && dx <= 1 && dy >= -1 && dy <= 1;
    const bool is_added = ticks == 0;  // needs its mask: there is nothing to be nudged from
    if (mask == kPositionChanged && barely_moved && !is_added) {
        out.u8(static_cast<std::uint8_t>(kNudged + 3 * (dx + 1) + dy + 1));
        return;
    }
    out.u8(mask);
    if (mask & kVelocityChanged) write_pair(out, dvx, dvy);
    if (mask & kPositionChanged) write_pair(out, dx, dy);
    if (mask & kThrustChanged) {
        out.u8(static_cast<std::uint8_t>(now.thrust_x));
        out.u8(static_cast<std::uint8_t>(now.thrust_y));
    }
    if (mask & kBodyChanged) write_body_changes(out, before, now);
}

void write_changes(ByteWriter& out, const CoinState& before, const CoinState& now, std::uint32_t) {
    const std::int32_t dx = wrapping_difference(now.x, before.x);
    const std::int32_t dy = wrapping_difference(now.y, before.y);
    std::uint8_t mask = 0;
    if (dx != 0 || dy != 0) mask |= kCoinMoved;
    if (now.value_coins != before.value_coins) mask |= kCoinValueChanged;
    out.u8(mask);
    if (mask & kCoinMoved) write_pair(out, dx, dy);
    if (mask & kCoinValueChanged) out.little_endian(now.value_coins, 2);
}

void write_hit(ByteWriter& out, const HitState& hit, Tick tick) {
    out.varint(tick - hit.tick);
    out.varint(hit.a);
    out.varint(hit.b);
    write_pair(out, hit.x, hit.y);
    out.varint(hit.impulse);
}

// Cuts the stream of records into parts as it is written. Records come in the order of their keys.
class PartCutter {
  public:
    struct Part {
        std::uint32_t begin_key = 0, end_key = kHitsKey;
        std::vector<std::uint8_t> body;
    };

    explicit PartCutter(std::size_t max_body_bytes) : max_body_bytes_(max_body_bytes) {}

    void predicted(std::uint32_t key) { extend_run(key, kPredictedRun, kMaxPredictedRun); }
    void removed(std::uint32_t key) { extend_run(key, kRemovedRun, kMaxRemovedRun); }
    void changed(std::uint32_t key, std::span<const std::uint8_t> record) {
        make_room(key, record.size());
        append(key, record);
    }
    // Ids of added entries are written as the distance from the id that would come next, which
    // starts anew in each part.
    void added(std::uint32_t key, std::span<const std::uint8_t> record) {
        make_room(key, kMaxAddedBytes + record.size());
        ByteWriter whole;
        whole.u8(kAdded);
        whole.varint(key - next_key_);
        whole.append(record);
        append(key, whole.bytes());
    }
    void end_list(std::uint32_t next_list_key) {
        end_list_here();
        next_key_ = next_list_key;
    }
    void hit(std::span<const std::uint8_t> record) {
        if (hit_count_ == kMaxHitsPerPart) close(kHitsKey);
        make_room(kHitsKey, record.size());
        hits_.append(record);
        ++hit_count_;
    }
    std::vector<Part> finish() {
        close(kHitsKey);
        parts_.pop_back();
        return std::move(parts_);
    }

  private:
    void make_room(std::uint32_t key, std::size_t bytes) {
        if (body_.size() + hits_.size() + bytes + kClosingBytes > max_body_bytes_) close(key);
    }
    void append(std::uint32_t key, std::span<const std::uint8_t> record) {
        body_.append(record);
        run_tag_ = 0;
        trailing_predicted_bytes_ = 0;
        next_key_ = key + 1;
    }
    void extend_run(std::uint32_t key, std::uint8_t tag, std::uint8_t longest) {
        if (run_tag_ != tag || run_ == longest) {
            make_room(key, 1);
            trailing_predicted_bytes_ = tag == kPredictedRun ? trailing_predicted_bytes_ + 1 : 0;
            body_.u8(tag);
            run_tag_ = tag;
            run_ = 0;
        }
        body_.bytes().back() = static_cast<std::uint8_t>(tag + run_++);
        next_key_ = key + 1;
    }
    // What is as predicted up to the end of a list goes without saying.
    void end_list_here() {
        body_.bytes().resize(body_.size() - trailing_predicted_bytes_);
        body_.u8(kEndOfList);
        trailing_predicted_bytes_ = 0;
        run_tag_ = 0;
        ++lists_ended_;
    }
    void close(std::uint32_t end_key) {
        const bool amid_balls = lists_ended_ == 0;
        while (lists_ended_ < 2) end_list_here();
        body_.u8(static_cast<std::uint8_t>(hit_count_));
        body_.append(hits_.take());
        parts_.back().end_key = end_key;
        parts_.back().body = body_.take();

        parts_.push_back({.begin_key = end_key, .end_key = kHitsKey, .body = {}});
        next_key_ = end_key;
        hit_count_ = 0;
        lists_ended_ = 0;
        if (!amid_balls) end_list_here();
        if (end_key == kHitsKey) end_list_here();
    }

    std::size_t max_body_bytes_;
    std::vector<Part> parts_ = std::vector<Part>(1);
    ByteWriter body_, hits_;
    std::size_t hit_count_ = 0;
    int lists_ended_ = 0;
    std::uint32_t next_key_ = 0;
    std::uint8_t run_tag_ = 0;  // 0: the last byte is not a run
    int run_ = 0;
    std::size_t trailing_predicted_bytes_ = 0;
};

// Merges two lists that are sorted by id.
template <typename Entry>
void write_list(PartCutter& out, std::uint32_t first_key, const std::vector<Entry>& before,
                const std::vector<Entry>& now, std::uint32_t ticks) {
    auto old = before.begin();
    for (const Entry& entry : now) {
        for (; old != before.end() && old->id < entry.id; ++old) out.removed(first_key + old->id);
        const std::uint32_t key = first_key + entry.id;
        ByteWriter record;
        if (old == before.end() || old->id != entry.id) {
            write_changes(record, Entry{}, entry, 0);
            out.added(key, record.bytes());
            continue;
        }
        if (predicted(*old, ticks) == entry) {
            out.predicted(key);
        } else {
            write_changes(record, *old, entry, ticks);
            out.changed(key, record.bytes());
        }
        ++old;
    }
    for (; old != before.end(); ++old) out.removed(first_key + old->id);
}

bool can_be_named(const Snapshot& baseline, const Snapshot& current) {
    return baseline.tick > 0 && baseline.tick < current.tick && baseline.arena == current.arena &&
           current.tick - baseline.tick <= kMaxBaselineAgeTicks;
}

void write_header(ByteWriter& out, const Snapshot& baseline, const Snapshot& current,
                  const PartHeader& header, const PartCutter::Part& part) {
    const bool keyframe = header.baseline_tick == 0;
    auto flags = static_cast<std::uint8_t>(current.phase);
    if (current.level != baseline.level) flags |= kLevelFollows;
    if (current.phase_end_tick != baseline.phase_end_tick) flags |= kPhaseEndFollows;
    if (header.part_count > 1) flags |= kSeveralParts;

    out.varint(header.tick);
    out.u8(static_cast<std::uint8_t>(keyframe ? 0 : header.tick - header.baseline_tick));
    out.u8(flags);
    if (flags & kSeveralParts) {
        out.varint(header.part);
        out.varint(header.part_count);
    }
    if (keyframe) {
        out.u8(current.arena);
    } else {
        out.little_endian(digest_of(baseline), 2);
    }
    if (flags & kLevelFollows) out.little_endian(current.level, 2);
    if (flags & kPhaseEndFollows) out.varint(current.phase_end_tick);
    if (flags & kSeveralParts) {
        out.varint(part.begin_key);
        out.varint(part.end_key);
    }
}

std::vector<std::vector<std::uint8_t>> with_headers(const std::vector<PartCutter::Part>& bodies,
                                                    const Snapshot& baseline,
                                                    const Snapshot& current) {
    std::vector<std::vector<std::uint8_t>> parts;
    parts.reserve(bodies.size());
    PartHeader header{.tick = current.tick,
                      .baseline_tick = baseline.tick,
                      .part = 0,
                      .part_count = static_cast<std::uint16_t>(bodies.size())};
    for (const PartCutter::Part& body : bodies) {
        ByteWriter part;
        write_header(part, baseline, current, header, body);
        part.append(body.body);
        parts.push_back(with_digest(part.take()));
        ++header.part;
    }
    return parts;
}

std::vector<std::vector<std::uint8_t>> encode(const Snapshot& baseline, const Snapshot& current,
                                              std::size_t max_part_bytes) {
    const std::uint32_t ticks = current.tick - baseline.tick;
    PartCutter cutter(max_part_bytes - kMaxHeaderBytes - kDigestBytes);
    write_list(cutter, 0, baseline.balls, current.balls, ticks);
    cutter.end_list(kFirstCoinKey);
    write_list(cutter, kFirstCoinKey, baseline.coins, current.coins, ticks);
    cutter.end_list(kHitsKey);
    for (const HitState& hit : current.hits) {
        ByteWriter record;
        write_hit(record, hit, current.tick);
        cutter.hit(record.bytes());
    }
    const std::vector<PartCutter::Part> bodies = cutter.finish();
    if (bodies.size() > kMaxParts) return {};
    return with_headers(bodies, baseline, current);
}

}  // namespace
}  // namespace delta_format

std::vector<std::vector<std::uint8_t>> encode_delta(const Snapshot& baseline,
                                                    const Snapshot& current,
                                                    std::size_t max_part_bytes) {
    assert(max_part_bytes >= kMinPartBytes);
    assert(is_canonical(baseline) && is_canonical(current));
    if (delta_format::can_be_named(baseline, current)) {
        return delta_format::encode(baseline, current, max_part_bytes);
    }
    return delta_format::encode(Snapshot{}, current, max_part_bytes);
}

}  // namespace fts::replication
