#include "common/replication/arena_sketch.h"

#include <algorithm>
#include <utility>

#include "common/replication/arena_replay.h"
#include "common/replication/delta.h"

namespace fts::replication {
namespace {

std::int32_t flown(std::int32_t place, std::int32_t velocity, double span_s) {
    const double moved_m = velocity * kVelocityStepMps * span_s;
    return quantise(place * kPositionStepM + moved_m, kPositionStepM);
}

bool has(const std::vector<BallState>& balls, std::uint16_t id) {
    return std::ranges::binary_search(balls, id, {}, &BallState::id);
}

template <typename Entry>
void put(std::vector<Entry>& list, const Entry& entry) {
    const auto place = std::ranges::lower_bound(list, entry.id, {}, &Entry::id);
    if (place != list.end() && place->id == entry.id) {
        *place = entry;
    } else {
        list.insert(place, entry);
    }
}

}  // namespace

void ArenaSketch::begin(const Snapshot& whole) {
    now_ = whole;
    now_.hits.clear();
    told_.clear();
    for (const BallState& ball : whole.balls) told_[ball.id] = whole.tick;
}

void ArenaSketch::tell(const Snapshot& part, const Course& course, Tick snapshot_ticks) {
    const bool is_older = part.tick < now_.tick;
    const bool of_this = part.arena == now_.arena && part.level == now_.level;
    if (is_older && !of_this) return;
    if (!is_older) move_on(part, course, snapshot_ticks);
    const double span_s = (now_.tick - part.tick) * course.tick_s;
    for (BallState ball : part.balls) {
        if (is_older && has(now_.balls, ball.id)) continue;
        ball.x = flown(ball.x, ball.vx, span_s);
        ball.y = flown(ball.y, ball.vy, span_s);
        put(now_.balls, ball);
        told_[ball.id] = part.tick;
    }
    for (const CoinState& coin : part.coins) put(now_.coins, coin);
    forget_old_ones();
}

void ArenaSketch::move_on(const Snapshot& part, const Course& course, Tick snapshot_ticks) {
    const bool goes_on = part.arena == now_.arena && part.level == now_.level && now_.tick != 0 &&
                         part.tick - now_.tick <= kMaxBaselineAgeTicks;
    if (goes_on) {
        now_ = replay(course, now_, part.tick, snapshot_ticks, {});
        now_.hits.clear();
    } else {
        Snapshot nothing_yet;
        nothing_yet.tick = part.tick;
        nothing_yet.arena = part.arena;
        nothing_yet.level = part.level;
        begin(nothing_yet);
    }
    now_.phase = part.phase;
    now_.phase_end_tick = part.phase_end_tick;
}

void ArenaSketch::forget_old_ones() {
    std::erase_if(told_, [&](const auto& entry) {
        return now_.tick > entry.second && now_.tick - entry.second > kForgottenAfterTicks;
    });
    std::erase_if(now_.balls, [&](const BallState& ball) { return !told_.contains(ball.id); });
}

}  // namespace fts::replication
