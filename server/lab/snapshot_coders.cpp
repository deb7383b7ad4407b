#include "server/lab/snapshot_coders.h"

#include <algorithm>
#include <utility>

#include "common/net/connection.h"
#include "common/replication/arena_replay.h"
#include "common/replication/delta.h"
#include "common/replication/predictor.h"
#include "common/replication/snapshot_codec.h"
#include "common/replication/wire.h"

namespace fts::lab {
namespace {

using replication::BallState;
using replication::ControlEvent;
using replication::Foresight;
using replication::Prediction;

std::vector<BallState> without_controls(std::vector<BallState> balls) {
    for (BallState& ball : balls) ball.thrust_x = ball.thrust_y = 0;
    return balls;
}

class ResidualCoder : public SnapshotCoder {
  public:
    ResidualCoder(std::string name, Foresight foresight, replication::Tick snapshot_ticks)
        : name_(std::move(name)), foresight_(foresight) {
        steering_.snapshot_ticks = snapshot_ticks;
        steering_.unforeseen_mps2 = knows_controls() ? 0.3 * kTraceThrustMps2 : kTraceThrustMps2;
    }

    std::string name() const override { return name_; }
    bool wants_lattice() const override { return foresight_ == Foresight::kControlsOnLattice; }
    std::vector<BallState> shown(const TraceSnapshot& snapshot) const override {
        return knows_controls() ? snapshot.balls : without_controls(snapshot.balls);
    }
    std::vector<Datagram> encode(std::span<const TraceSnapshot> history) const override {
        const TraceSnapshot* baseline = history.size() > 1 ? &history.front() : nullptr;
        return replication::encode_balls(expected(baseline, history.back().tick),
                                         shown(history.back()), kMaxDatagramBytes);
    }
    std::optional<std::vector<BallState>> decode(
        const TraceSnapshot* baseline, std::span<const Datagram> payloads) const override {
        const auto header = replication::peek_residual_part(payloads.front());
        if (!header || header->baseline_tick != (baseline == nullptr ? 0 : baseline->tick)) {
            return std::nullopt;
        }
        const Prediction prediction = expected(baseline, header->tick);
        std::vector<BallState> balls;
        for (const Datagram& part : payloads) {
            const auto more = replication::decode_balls(prediction, part);
            if (!more) return std::nullopt;
            balls.insert(balls.end(), more->begin(), more->end());
        }
        return balls;
    }

  private:
    bool knows_controls() const {
        return foresight_ == Foresight::kControls || foresight_ == Foresight::kControlsOnLattice;
    }
    Prediction expected(const TraceSnapshot* baseline, replication::Tick tick) const {
        if (baseline == nullptr) return {0, tick, {}};
        return replication::predict(course_, steering_, foresight_, shown(*baseline),
                                    baseline->tick, tick);
    }

    std::string name_;
    Foresight foresight_;
    replication::Course course_ = trace_course();
    replication::Steering steering_;
};

// What a live match sends (server/snapshot_feed.h): what has happened, in steps where it is too
// much for a datagram, and states to who holds nothing. A byte says which; the packet around it
// acknowledges inputs in at most six bytes more.
class LiveCoder : public SnapshotCoder {
  public:
    explicit LiveCoder(replication::Tick snapshot_ticks) : snapshot_ticks_(snapshot_ticks) {}

    std::string name() const override { return "ours, control events only"; }
    bool wants_lattice() const override { return true; }
    std::vector<Datagram> encode(std::span<const TraceSnapshot> history) const override {
        if (history.size() == 1) return keyframe(in_play(history.back()));
        std::vector<Datagram> payloads;
        while (history.size() > 1) {
            std::size_t steps = history.size() - 1;
            Datagram part = events_to(history.first(steps + 1));
            while (part.size() > kMaxPartBytes && steps > 1) {
                steps /= 2;
                part = events_to(history.first(steps + 1));
            }
            history = history.subspan(steps);
            payloads.push_back(
                tagged(history.size() == 1 ? Kind::kEvents : Kind::kEarlierEvents, part));
        }
        return payloads;
    }
    std::optional<std::vector<BallState>> decode(
        const TraceSnapshot* baseline, std::span<const Datagram> payloads) const override {
        if (baseline == nullptr) return decode_keyframe(payloads);
        Snapshot held = in_play(*baseline);
        for (const Datagram& payload : payloads) {
            const bool is_last = &payload == &payloads.back();
            if (!is_of(is_last ? Kind::kEvents : Kind::kEarlierEvents, payload))
                return std::nullopt;
            auto next = replayed(held, part_of(payload));
            if (!next) return std::nullopt;
            held = std::move(*next);
        }
        return std::move(held.balls);
    }

  private:
    using Snapshot = replication::Snapshot;
    using Kind = replication::SnapshotPacket::Kind;
    static constexpr std::size_t kMaxPartBytes =
        net::kMaxPayloadBytes - replication::kMaxSnapshotPacketOverheadBytes;

    static Snapshot in_play(const TraceSnapshot& shown) {
        Snapshot snapshot;
        snapshot.tick = shown.tick;
        snapshot.phase = game::Phase::kPlaying;
        snapshot.balls = shown.balls;
        return snapshot;
    }
    static Datagram events_to(std::span<const TraceSnapshot> history) {
        replication::ArenaEvents events;
        for (const TraceSnapshot& snapshot : history.subspan(1)) {
            events.controls.insert(events.controls.end(), snapshot.events.begin(),
                                   snapshot.events.end());
        }
        std::ranges::stable_sort(events.controls, {}, &ControlEvent::ball);
        return replication::encode_events(in_play(history.front()), events,
                                          in_play(history.back()));
    }
    static Datagram tagged(Kind kind, std::span<const std::uint8_t> part) {
        Datagram payload{static_cast<std::uint8_t>(kind)};
        payload.insert(payload.end(), part.begin(), part.end());
        return payload;
    }
    static bool is_of(Kind kind, const Datagram& payload) {
        return !payload.empty() && payload.front() == static_cast<std::uint8_t>(kind);
    }
    static std::span<const std::uint8_t> part_of(const Datagram& payload) {
        return std::span(payload).subspan(1);
    }
    static std::vector<Datagram> keyframe(const Snapshot& now) {
        std::vector<Datagram> payloads =
            replication::encode_delta({}, now, replication::kMaxKeyframePartBytes);
        for (Datagram& part : payloads) part = tagged(Kind::kStates, part);
        return payloads;
    }
    static std::optional<std::vector<BallState>> decode_keyframe(
        std::span<const Datagram> payloads) {
        std::vector<BallState> balls;
        for (const Datagram& payload : payloads) {
            if (!is_of(Kind::kStates, payload)) return std::nullopt;
            const auto part = replication::decode_part({}, part_of(payload));
            if (!part) return std::nullopt;
            balls.insert(balls.end(), part->balls.begin(), part->balls.end());
        }
        return balls;
    }
    std::optional<Snapshot> replayed(const Snapshot& held,
                                     std::span<const std::uint8_t> bytes) const {
        const auto part = replication::decode_events(held, bytes);
        if (!part) return std::nullopt;
        Snapshot outcome =
            replication::replay(course_, held, part->tick, snapshot_ticks_, part->events);
        if (replication::outcome_digest_of(outcome) != part->outcome_digest) return std::nullopt;
        return outcome;
    }

    replication::Course course_ = trace_course();
    replication::Tick snapshot_ticks_;
};

}  // namespace

std::vector<BallState> SnapshotCoder::shown(const TraceSnapshot& snapshot) const {
    return snapshot.balls;
}

std::vector<std::unique_ptr<SnapshotCoder>> all_coders(replication::Tick snapshot_ticks) {
    std::vector<std::unique_ptr<SnapshotCoder>> coders;
    coders.push_back(make_protobuf_coder());
    coders.push_back(make_bit_packing_coder());
    coders.push_back(make_delta_coder());
    const auto add = [&](const char* name, Foresight foresight) {
        coders.push_back(std::make_unique<ResidualCoder>(name, foresight, snapshot_ticks));
    };
    add("ours, straight lines", Foresight::kStraightLines);
    add("ours, collisions", Foresight::kCollisions);
    add("ours, collisions and controls", Foresight::kControls);
    add("ours, the same on the lattice", Foresight::kControlsOnLattice);
    coders.push_back(std::make_unique<LiveCoder>(snapshot_ticks));
    return coders;
}

}  // namespace fts::lab
