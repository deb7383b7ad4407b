#include "server/lab/snapshot_coders.h"

#include <algorithm>
#include <utility>

#include "common/replication/arena_replay.h"
#include "common/replication/predictor.h"
#include "common/replication/snapshot_codec.h"

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

class ControlEventCoder : public SnapshotCoder {
  public:
    explicit ControlEventCoder(replication::Tick snapshot_ticks)
        : snapshot_ticks_(snapshot_ticks) {}

    std::string name() const override { return "ours, control events only"; }
    bool wants_lattice() const override { return true; }
    std::vector<Datagram> encode(std::span<const TraceSnapshot> history) const override {
        const TraceSnapshot& now = history.back();
        if (history.size() == 1) {
            return replication::encode_balls({0, now.tick, {}}, now.balls, kMaxDatagramBytes);
        }
        replication::ArenaEvents events;
        std::vector<ControlEvent>& controls = events.controls;
        for (const TraceSnapshot& snapshot : history.subspan(1)) {
            controls.insert(controls.end(), snapshot.events.begin(), snapshot.events.end());
        }
        std::stable_sort(controls.begin(), controls.end(), [](const auto& a, const auto& b) {
            return a.ball != b.ball ? a.ball < b.ball : a.tick < b.tick;
        });
        return {replication::encode_events(in_play(history.front()), events, in_play(now))};
    }
    std::optional<std::vector<BallState>> decode(
        const TraceSnapshot* baseline, std::span<const Datagram> payloads) const override {
        if (baseline == nullptr) return decode_keyframe(payloads);
        const replication::Snapshot start = in_play(*baseline);
        const auto part = replication::decode_events(start, payloads.front());
        if (!part) return std::nullopt;
        replication::Snapshot outcome =
            replication::replay(course_, start, part->tick, snapshot_ticks_, part->events);
        if (replication::outcome_digest_of(outcome) != part->outcome_digest) return std::nullopt;
        return std::move(outcome.balls);
    }

  private:
    static replication::Snapshot in_play(const TraceSnapshot& shown) {
        replication::Snapshot snapshot;
        snapshot.tick = shown.tick;
        snapshot.phase = game::Phase::kPlaying;
        snapshot.balls = shown.balls;
        return snapshot;
    }
    static std::optional<std::vector<BallState>> decode_keyframe(
        std::span<const Datagram> payloads) {
        std::vector<BallState> balls;
        for (const Datagram& part : payloads) {
            const auto header = replication::peek_residual_part(part);
            if (!header) return std::nullopt;
            const auto more = replication::decode_balls({0, header->tick, {}}, part);
            if (!more) return std::nullopt;
            balls.insert(balls.end(), more->begin(), more->end());
        }
        return balls;
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
    coders.push_back(std::make_unique<ControlEventCoder>(snapshot_ticks));
    return coders;
}

}  // namespace fts::lab
