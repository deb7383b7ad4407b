#include "common/replication/arena_replay.h"

#include <algorithm>
#include <cassert>

namespace fts::replication {
namespace {

using Kind = ArenaChange::Kind;

Snapshot without_balls(const Snapshot& snapshot) {
    Snapshot rest = snapshot;
    rest.balls.clear();
    rest.hits.clear();
    return rest;
}

std::vector<ControlEvent> in_time(const ArenaEvents& events) {
    std::vector<ControlEvent> controls = events.controls;
    std::ranges::stable_sort(controls, {}, &ControlEvent::tick);
    return controls;
}

template <typename Event>
std::span<const Event> of_tick(const std::vector<Event>& events, Tick tick) {
    return {std::ranges::lower_bound(events, tick, {}, &Event::tick),
            std::ranges::upper_bound(events, tick, {}, &Event::tick)};
}

}  // namespace

ArenaReplay::ArenaReplay(const Course& course, const Snapshot& start, Tick snapshot_ticks)
    : snapshot_ticks_(snapshot_ticks),
      start_tick_(start.tick),
      tick_s_(course.tick_s),
      state_(without_balls(start)),
      world_(course, start.balls) {
    assert(snapshot_ticks > 0);
}

void ArenaReplay::run_to(Tick tick, const ArenaEvents& events,
                         const std::function<void(const ArenaReplay&)>& after_tick) {
    assert(is_canonical(events));
    const std::vector<ControlEvent> controls = in_time(events);
    hits_.clear();
    while (state_.tick < tick) {
        ++state_.tick;
        step(of_tick(events.changes, state_.tick), of_tick(controls, state_.tick));
        if (after_tick) after_tick(*this);
        if ((state_.tick - start_tick_) % snapshot_ticks_ == 0) world_.snap();
    }
}

void ArenaReplay::step(std::span<const ArenaChange> changes,
                       std::span<const ControlEvent> controls) {
    const bool moving = state_.phase == game::Phase::kPlaying;
    for (const ArenaChange& change : changes) before_step(change);
    for (const ControlEvent& event : controls) {
        const auto slot = world_.slot_of(event.ball);
        if (!slot) continue;
        world_.steer(
            *slot, {.thrust_x = event.thrust_x, .thrust_y = event.thrust_y, .brake = event.brake});
        if (event.dash) world_.dash(*slot);
    }
    if (moving) {
        world_.advance(tick_s_);
        log_hits();
    }
    for (const ArenaChange& change : changes) after_step(change);
}

void ArenaReplay::before_step(const ArenaChange& change) {
    if (change.kind == Kind::kBallPut) world_.put(change.ball);
    if (change.kind == Kind::kBallGone) world_.remove(change.ball.id);
}

void ArenaReplay::after_step(const ArenaChange& change) {
    auto& coins = state_.coins;
    const auto coin = std::ranges::lower_bound(coins, change.coin.id, {}, &CoinState::id);
    const bool lies_there = coin != coins.end() && coin->id == change.coin.id;
    if (change.kind == Kind::kPhase) {
        state_.phase = change.phase;
        state_.phase_end_tick = change.phase_end_tick;
        if (change.phase != game::Phase::kPlaying) world_.halt();
    } else if (change.kind == Kind::kCoinPut && !lies_there) {
        coins.insert(coin, change.coin);
    } else if (change.kind == Kind::kCoinGone && lies_there) {
        coins.erase(coin);
    }
}

void ArenaReplay::log_hits() {
    for (const physics::Contact<double>& contact : world_.contacts()) {
        if (!contact.b) continue;
        hits_.add(hit_of(contact, state_.tick, world_.id_at(contact.a.index),
                         world_.id_at(contact.b->index)));
    }
}

Snapshot ArenaReplay::snapshot() const {
    Snapshot snapshot = state_;
    snapshot.balls = world_.balls();
    snapshot.hits = hits_.sorted();
    return snapshot;
}

Snapshot replay(const Course& course, const Snapshot& baseline, Tick tick, Tick snapshot_ticks,
                const ArenaEvents& events) {
    ArenaReplay arena(course, baseline, snapshot_ticks);
    arena.run_to(tick, events);
    return arena.snapshot();
}

}  // namespace fts::replication
