#include "common/replication/control_events.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <tuple>

#include "common/replication/byte_stream.h"
#include "common/replication/range_coder.h"
#include "common/replication/snapshot_codec.h"
#include "common/replication/state_digest.h"
#include "common/replication/thrust_model.h"

namespace fts::replication {
namespace {

// Of what the outcome does not tell: ticks in which nothing moves lead to the same one.
std::uint32_t digest_of_telling(Tick tick, Tick baseline_tick, std::span<const std::uint8_t> bits) {
    StateDigest digest;
    digest.add(tick);
    digest.add(baseline_tick);
    digest.add(bits);
    return digest.value();
}

bool comes_before(const ControlEvent& a, const ControlEvent& b) {
    return std::tie(a.ball, a.tick) < std::tie(b.ball, b.tick);
}

// The controls of one ball: whether there are any, each with its tick, and whether one more
// follows.
template <typename Coder>
class ControlCoder {
  public:
    // Of ticks in (begin, end].
    ControlCoder(Coder& coder, Tick begin, Tick end) : coder_(coder), begin_(begin), end_(end) {}

    // Told to an encoder; a decoder puts what it finds at the end of `events`.
    void code(std::uint16_t ball, bool is_player, std::span<const ControlEvent> told,
              std::vector<ControlEvent>& events) {
        bool more = coder_.bit(any_[is_player ? 1 : 0], !told.empty());
        for (Tick after = begin_; more && after < end_;) {
            ControlEvent event = told.empty() ? ControlEvent{.tick = after + 1} : told.front();
            if (!told.empty()) told = told.subspan(1);
            event.ball = ball;
            event.tick = after + 1 + coder_.even(event.tick - after - 1, end_ - after);
            thrust_.code(coder_, event);
            event.dash = coder_.bit(dash_, event.dash);
            events.push_back(event);
            after = event.tick;
            more = after < end_ && coder_.bit(more_, !told.empty());
        }
    }

  private:
    Coder& coder_;
    Tick begin_, end_;
    std::array<AdaptiveBit, 2> any_{AdaptiveBit{0x0200, 8}, AdaptiveBit{0x4000, 8}};
    AdaptiveBit more_{0x1800, 8}, dash_{0x0200, 8};
    ThrustModel thrust_ = ThrustModel::of_keyboards();
};

// Everything else that happens. Every change takes some plain bits, so that what a part says is
// never much longer than the part.
template <typename Coder>
class ChangeCoder {
  public:
    ChangeCoder(Coder& coder, Tick begin, Tick end) : coder_(coder), after_(begin), end_(end) {}

    bool another(bool more) { return coder_.bit(another_, more); }
    void code(ArenaChange& change) {
        constexpr auto kKinds = static_cast<std::uint32_t>(kLastChange) + 1;
        change.tick = after_ + coder_.even(change.tick - after_, end_ - after_ + 1);
        change.kind = static_cast<ArenaChange::Kind>(
            coder_.even(static_cast<std::uint32_t>(change.kind), kKinds));
        switch (change.kind) {
            case ArenaChange::Kind::kBallPut:
                return put(change.ball);
            case ArenaChange::Kind::kBallGone:
                change.ball.id = id(change.ball.id);
                return;
            case ArenaChange::Kind::kPhase:
                change.phase = static_cast<game::Phase>(
                    coder_.raw(static_cast<std::uint32_t>(change.phase), 2));
                change.phase_end_tick = wide(change.phase_end_tick);
                return;
            case ArenaChange::Kind::kCoinPut:
                change.coin.id = id(change.coin.id);
                change.coin.value_coins = id(change.coin.value_coins);
                change.coin.x = number(change.coin.x);
                change.coin.y = number(change.coin.y);
                return;
            case ArenaChange::Kind::kCoinGone:
                change.coin.id = id(change.coin.id);
                return;
        }
    }
    void reached(Tick tick) { after_ = tick; }

  private:
    // Balls come in crowds, alike and at rest; so what is as it was of the one before is a bit.
    void put(BallState& ball) {
        unless(next_id_, ball.id, static_cast<std::uint16_t>(put_before_.id + 1),
               [this](auto value) { return id(value); });
        ball.x = number(ball.x);
        ball.y = number(ball.y);
        for (std::int32_t* speed : {&ball.vx, &ball.vy}) {
            unless(at_rest_, *speed, 0, [this](auto value) { return number(value); });
        }
        thrust_.code(coder_, ball);
        if (coder_.bit(same_body_, same_body(put_before_, ball))) {
            take_body(put_before_, ball);
        } else {
            body(ball);
        }
        put_before_ = ball;
    }
    void body(BallState& ball) {
        ball.radius = id(ball.radius);
        ball.mass = wide(ball.mass);
        ball.kind = static_cast<std::uint8_t>(coder_.raw(ball.kind, 8));
        ball.behaviour = static_cast<std::uint8_t>(coder_.raw(ball.behaviour, 8));
        ball.player_id = id(ball.player_id);
        for (std::uint32_t* trait : {&ball.handling.acceleration, &ball.handling.drag,
                                     &ball.handling.braking, &ball.handling.dash}) {
            *trait = wide(*trait);
        }
    }
    template <typename Value, typename Code>
    void unless(AdaptiveBit& is_so, Value& value, const Value& expected, const Code& code) {
        value = coder_.bit(is_so, value == expected) ? expected : code(value);
    }
    std::uint16_t id(std::uint16_t value) {
        return static_cast<std::uint16_t>(coder_.raw(value, 16));
    }
    std::uint32_t wide(std::uint32_t value) {
        const std::uint32_t high = coder_.raw(value >> 16, 16);
        return high << 16 | coder_.raw(value & 0xFFFFU, 16);
    }
    std::int32_t number(std::int32_t value) {
        return static_cast<std::int32_t>(wide(static_cast<std::uint32_t>(value)));
    }

    Coder& coder_;
    Tick after_, end_;
    AdaptiveBit another_{0x0400, 8};
    AdaptiveBit next_id_{0x8000, 8}, at_rest_{0x8000, 8}, same_body_{0x8000, 8};
    BallState put_before_;
    ThrustModel thrust_ = ThrustModel::of_keyboards();
};

struct Steered {
    std::uint16_t id = 0;
    bool is_player = false;
};
// Whoever may be steered, ascending by id.
std::vector<Steered> steered_of(const Snapshot& baseline, const std::vector<ArenaChange>& changes) {
    constexpr auto kPlayer = static_cast<std::uint8_t>(BallKind::kPlayer);
    std::vector<Steered> all;
    all.reserve(baseline.balls.size());
    for (const BallState& ball : baseline.balls) all.push_back({ball.id, ball.kind == kPlayer});
    const std::size_t held = all.size();
    for (const ArenaChange& change : changes) {
        if (change.kind != ArenaChange::Kind::kBallPut) continue;
        all.push_back({change.ball.id, change.ball.kind == kPlayer});
    }
    if (all.size() == held) return all;
    std::ranges::stable_sort(all, {}, &Steered::id);
    const auto same = [](const Steered& a, const Steered& b) { return a.id == b.id; };
    all.erase(std::unique(all.begin(), all.end(), same), all.end());
    return all;
}

bool is_known(const ArenaChange& change) {
    return change.ball.kind <= static_cast<std::uint8_t>(BallKind::kPlayer) &&
           change.ball.behaviour <= static_cast<std::uint8_t>(kLastBehaviour);
}

}  // namespace

ArenaChange ArenaChange::ball_put(Tick tick, const BallState& ball) {
    return {.kind = Kind::kBallPut, .tick = tick, .ball = ball};
}

ArenaChange ArenaChange::ball_gone(Tick tick, std::uint16_t id) {
    return {.kind = Kind::kBallGone, .tick = tick, .ball = {.id = id}};
}

ArenaChange ArenaChange::phase_begun(Tick tick, game::Phase phase, Tick phase_end_tick) {
    return {.kind = Kind::kPhase, .tick = tick, .phase = phase, .phase_end_tick = phase_end_tick};
}

ArenaChange ArenaChange::coin_put(Tick tick, const CoinState& coin) {
    return {.kind = Kind::kCoinPut, .tick = tick, .coin = coin};
}

ArenaChange ArenaChange::coin_gone(Tick tick, std::uint16_t id) {
    return {.kind = Kind::kCoinGone, .tick = tick, .coin = {.id = id}};
}

bool is_canonical(const ArenaEvents& events) {
    const auto out_of_order = [](const ControlEvent& a, const ControlEvent& b) {
        return !comes_before(a, b);
    };
    return std::ranges::adjacent_find(events.controls, out_of_order) == events.controls.end() &&
           std::ranges::is_sorted(events.changes, {}, &ArenaChange::tick);
}

std::uint32_t outcome_digest_of(const Snapshot& snapshot) {
    StateDigest digest;
    for (const BallState& ball : snapshot.balls) digest.add(ball);
    for (const CoinState& coin : snapshot.coins) {
        digest.add(coin.id | std::uint32_t{coin.value_coins} << 16);
        digest.add(coin.x);
        digest.add(coin.y);
    }
    digest.add(std::uint32_t{snapshot.arena} | static_cast<std::uint32_t>(snapshot.phase) << 8 |
               std::uint32_t{snapshot.level} << 16);
    digest.add(snapshot.phase_end_tick);
    return digest.value();
}

std::vector<std::uint8_t> encode_events(const Snapshot& baseline, const ArenaEvents& events,
                                        const Snapshot& outcome) {
    assert(is_canonical(events));
    assert(outcome.tick > baseline.tick && outcome.tick - baseline.tick <= kMaxPredictedTicks);
    assert(outcome.arena == baseline.arena && outcome.level == baseline.level);
    RangeEncoder encoder;
    ChangeCoder<RangeEncoder> changes(encoder, baseline.tick + 1, outcome.tick);
    for (ArenaChange change : events.changes) {
        changes.another(true);
        changes.code(change);
        changes.reached(change.tick);
    }
    changes.another(false);
    ControlCoder<RangeEncoder> controls(encoder, baseline.tick, outcome.tick);
    std::span<const ControlEvent> left = events.controls;
    std::vector<ControlEvent> said;
    for (const Steered& ball : steered_of(baseline, events.changes)) {
        std::size_t count = 0;
        while (count < left.size() && left[count].ball == ball.id) ++count;
        controls.code(ball.id, ball.is_player, left.first(count), said);
        left = left.subspan(count);
    }
    assert(left.empty());
    ByteWriter out;
    out.varint(outcome.tick);
    out.u8(static_cast<std::uint8_t>(outcome.tick - baseline.tick));
    const std::vector<std::uint8_t> bits = encoder.finish();
    const std::uint32_t telling = digest_of_telling(outcome.tick, baseline.tick, bits);
    out.little_endian(outcome_digest_of(outcome) ^ telling, StateDigest::kBytes);
    out.append(bits);
    return out.take();
}

namespace {

std::optional<ControlPartHeader> read_header(ByteReader& in) {
    ControlPartHeader header;
    header.tick = in.varint();
    const std::uint32_t age = in.u8();
    if (in.failed() || age == 0 || age >= header.tick) return std::nullopt;
    header.baseline_tick = header.tick - age;
    return header;
}

}  // namespace

std::optional<ControlPartHeader> peek_control_part(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    return read_header(in);
}

std::optional<ControlPart> decode_events(const Snapshot& baseline,
                                         std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    const auto header = read_header(in);
    const auto digest = static_cast<std::uint32_t>(in.little_endian(StateDigest::kBytes));
    if (in.failed() || !header || header->baseline_tick != baseline.tick) return std::nullopt;
    ControlPart part{.tick = header->tick, .outcome_digest = digest, .events = {}};
    part.outcome_digest ^= digest_of_telling(part.tick, baseline.tick, in.rest());
    RangeDecoder decoder(in.rest());
    ChangeCoder<RangeDecoder> changes(decoder, baseline.tick + 1, part.tick);
    while (changes.another(false)) {
        ArenaChange change;
        change.tick = baseline.tick + 1;
        changes.code(change);
        if (decoder.ran_out() || !is_known(change)) return std::nullopt;
        changes.reached(change.tick);
        part.events.changes.push_back(change);
    }
    ControlCoder<RangeDecoder> controls(decoder, baseline.tick, part.tick);
    for (const Steered& ball : steered_of(baseline, part.events.changes)) {
        controls.code(ball.id, ball.is_player, {}, part.events.controls);
        if (decoder.ran_out()) return std::nullopt;
    }
    if (!decoder.complete()) return std::nullopt;
    return part;
}

}  // namespace fts::replication
