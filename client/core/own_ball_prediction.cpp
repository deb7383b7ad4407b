#include "client/core/own_ball_prediction.h"

#include <algorithm>
#include <cmath>

#include "common/replication/snapshot_codec.h"

namespace fts::client {

using replication::BallState;

void OwnBallPrediction::push(const game::InputCommand& input, const game::BallStats& stats,
                             int tick_rate_hz, double now_s) {
    const bool dashes = game::advance_dash(dash_, stats, input, tick_rate_hz);
    waiting_.push_back({++newest_sequence_, input, dashes});
    if (waiting_.size() > replication::kMaxPredictedTicks) waiting_.pop_front();
    if (world_) advance(waiting_.back());
    pushed_s_ = now_s;
}

void OwnBallPrediction::rebase(const replication::Course& course,
                               const replication::Snapshot& snapshot, std::uint16_t player_id,
                               std::uint32_t acked) {
    while (!waiting_.empty() && waiting_.front().sequence <= acked) waiting_.pop_front();
    const std::optional<Pose> drawn = after_;
    const auto own = std::ranges::find_if(snapshot.balls, [&](const BallState& ball) {
        return ball.player_id == player_id && player_id != 0;
    });
    world_.reset();
    before_.reset();
    after_.reset();
    const bool is_new = own != snapshot.balls.end() && own->id != ball_id_;
    ball_id_ = own == snapshot.balls.end() ? std::uint16_t{0} : own->id;
    if (is_new) dash_ = {};
    if (ball_id_ == 0 || snapshot.phase != game::Phase::kPlaying) {
        error_m_.setZero();
        return;
    }
    tick_s_ = course.tick_s;
    world_.emplace(course, snapshot.balls);
    before_ = after_ = body();
    for (const Sent& sent : waiting_) advance(sent);
    if (is_new || !drawn || !after_) {
        error_m_.setZero();
        return;
    }
    error_m_ += drawn->position_m - after_->position_m;
    if (error_m_.norm() > kMaxBlendM) error_m_.setZero();
}

void OwnBallPrediction::advance(const Sent& sent) {
    const auto slot = world_->slot_of(ball_id_);
    if (slot) {
        world_->steer(*slot, {.thrust_x = sent.input.thrust_x,
                              .thrust_y = sent.input.thrust_y,
                              .brake = sent.input.brake});
        if (sent.dashes) world_->dash(*slot);
    }
    world_->advance(tick_s_);
    before_ = after_;
    after_ = body();
}

std::optional<OwnBallPrediction::Pose> OwnBallPrediction::body() const {
    if (!world_->slot_of(ball_id_)) return std::nullopt;
    const auto body = world_->body(ball_id_);
    return Pose{body.position_m, body.velocity_mps};
}

std::optional<OwnBallPrediction::Pose> OwnBallPrediction::pose(double now_s) {
    error_m_ *= std::exp(-std::max(0.0, now_s - blended_s_) / kBlendS);
    blended_s_ = now_s;
    if (!before_ || !after_) return std::nullopt;
    const double share = std::clamp((now_s - pushed_s_) / tick_s_, 0.0, 1.0);
    Pose pose;
    pose.position_m =
        before_->position_m + (after_->position_m - before_->position_m) * share + error_m_;
    pose.velocity_mps =
        before_->velocity_mps + (after_->velocity_mps - before_->velocity_mps) * share;
    return pose;
}

}  // namespace fts::client
