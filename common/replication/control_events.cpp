#include "common/replication/control_events.h"

#include <algorithm>
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

// The events of one ball: whether there are any, each with its tick and control, and whether one
// more follows.
template <typename Coder>
class EventCoder {
  public:
    EventCoder(Coder& coder, Tick begin, Tick end) : coder_(coder), begin_(begin), end_(end) {}

    // Told to an encoder; a decoder puts what it finds at the end of `events`.
    void code(const BallState& ball, std::span<const ControlEvent> told,
              std::vector<ControlEvent>& events) {
        AdaptiveBit& any = any_[ball.kind != 0 ? 1 : 0];
        bool more = coder_.bit(any, !told.empty());
        for (Tick from = begin_; more && from < end_;) {
            BallState said;
            Tick tick = from;
            if (!told.empty()) {
                const ControlEvent& event = told.front();
                tick = event.tick;
                said.thrust_x = event.thrust_x;
                said.thrust_y = event.thrust_y;
                said.brake = event.brake;
                told = told.subspan(1);
            }
            tick = from + coder_.even(tick - from, end_ - from);
            thrust_.code(coder_, said);
            events.push_back({tick, ball.id, said.thrust_x, said.thrust_y, said.brake});
            from = tick + 1;
            more = from < end_ && coder_.bit(more_, !told.empty());
        }
    }

  private:
    Coder& coder_;
    Tick begin_, end_;
    std::array<AdaptiveBit, 2> any_{AdaptiveBit{0x0200, 8}, AdaptiveBit{0x4000, 8}};
    AdaptiveBit more_{0x1800, 8};
    ThrustModel thrust_ = ThrustModel::of_keyboards();
};

}  // namespace

bool is_canonical(std::span<const ControlEvent> events) {
    return std::adjacent_find(events.begin(), events.end(), [](const auto& a, const auto& b) {
               return !comes_before(a, b);
           }) == events.end();
}

std::vector<BallState> replay(const Course& course, std::span<const BallState> baseline,
                              Tick baseline_tick, Tick tick, Tick snapshot_ticks,
                              std::span<const ControlEvent> events) {
    assert(snapshot_ticks > 0);
    std::vector<ControlEvent> in_time(events.begin(), events.end());
    std::stable_sort(in_time.begin(), in_time.end(),
                     [](const auto& a, const auto& b) { return a.tick < b.tick; });
    LatticeWorld world(course, baseline);
    auto next = in_time.begin();
    for (Tick now = baseline_tick; now < tick; ++now) {
        for (; next != in_time.end() && next->tick <= now; ++next) {
            const auto ball = std::lower_bound(
                baseline.begin(), baseline.end(), next->ball,
                [](const BallState& state, std::uint16_t id) { return state.id < id; });
            if (ball == baseline.end() || ball->id != next->ball) continue;
            BallState controls = *ball;
            controls.thrust_x = next->thrust_x;
            controls.thrust_y = next->thrust_y;
            controls.brake = next->brake;
            world.steer(static_cast<std::size_t>(ball - baseline.begin()), controls);
        }
        world.advance(course.tick_s);
        if ((now + 1 - baseline_tick) % snapshot_ticks == 0) world.snap();
    }
    return world.balls();
}

std::uint32_t digest_of(std::span<const BallState> balls) {
    StateDigest digest;
    for (const BallState& ball : balls) digest.add(ball);
    return digest.value();
}

std::vector<std::uint8_t> encode_events(std::span<const BallState> baseline, Tick baseline_tick,
                                        Tick tick, std::span<const ControlEvent> events,
                                        std::span<const BallState> outcome) {
    assert(is_canonical(events));
    assert(tick > baseline_tick && tick - baseline_tick <= kMaxPredictedTicks);
    RangeEncoder encoder;
    EventCoder<RangeEncoder> coder(encoder, baseline_tick, tick);
    std::vector<ControlEvent> said;
    for (const BallState& ball : baseline) {
        const auto end = std::find_if(events.begin(), events.end(), [&](const ControlEvent& event) {
            return event.ball != ball.id;
        });
        const auto count = static_cast<std::size_t>(end - events.begin());
        coder.code(ball, events.first(count), said);
        events = events.subspan(count);
    }
    assert(events.empty());
    ByteWriter out;
    out.varint(tick);
    out.u8(static_cast<std::uint8_t>(tick - baseline_tick));
    const std::vector<std::uint8_t> bits = encoder.finish();
    const std::uint32_t telling = digest_of_telling(tick, baseline_tick, bits);
    out.little_endian(digest_of(outcome) ^ telling, StateDigest::kBytes);
    out.append(bits);
    return out.take();
}

std::optional<ControlPart> decode_events(std::span<const BallState> baseline, Tick baseline_tick,
                                         std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    ControlPart part;
    part.tick = in.varint();
    const std::uint32_t age = in.u8();
    part.outcome_digest = static_cast<std::uint32_t>(in.little_endian(StateDigest::kBytes));
    if (in.failed() || age == 0 || age >= part.tick) return std::nullopt;
    part.baseline_tick = part.tick - age;
    if (part.baseline_tick != baseline_tick) return std::nullopt;
    part.outcome_digest ^= digest_of_telling(part.tick, part.baseline_tick, in.rest());
    RangeDecoder decoder(in.rest());
    EventCoder<RangeDecoder> coder(decoder, part.baseline_tick, part.tick);
    for (const BallState& ball : baseline) {
        coder.code(ball, {}, part.events);
        if (decoder.ran_out()) return std::nullopt;
    }
    if (!decoder.complete()) return std::nullopt;
    return part;
}

}  // namespace fts::replication
