#include "common/replication/flight_paths.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "common/replication/missed_hits.h"

namespace fts::replication {
namespace {

using physics::Vec2d;

constexpr std::uint32_t kMaxRuns = 3;

using Motion = Gap;  // from nothing

Motion motion_of(const BallState& ball, const Lattice& lattice) {
    return {
        {dequantise(ball.x, lattice.position_step_m), dequantise(ball.y, lattice.position_step_m)},
        {dequantise(ball.vx, lattice.velocity_step_mps),
         dequantise(ball.vy, lattice.velocity_step_mps)}};
}

// At rest at 0 when the `share` of the span is 0, and the gap when it is 1.
Gap cubic_at(const Gap& gap, double share, double span_s) {
    const double s = share;
    return {gap.m * (s * s * (3.0 - 2.0 * s)) + gap.mps * (span_s * s * s * (s - 1.0)),
            gap.m * (6.0 * s * (1.0 - s) / span_s) + gap.mps * (s * (3.0 * s - 2.0))};
}

}  // namespace

FlightPose FlightPaths::at(std::size_t ball, double since_s) const {
    const Way& way = ways_[ball];
    const double time_s = std::clamp(since_s, 0.0, span_s_);
    const Knot* knot = &knots_[way.first_knot];
    const Knot* const last = &knots_[way.end_knot - 1];
    if (knot == last || !(span_s_ > 0.0)) return {knot->position_m, Vec2d::Zero()};
    while (knot + 1 != last && knot[1].time_s <= time_s) ++knot;
    while (knot[1].time_s <= knot->time_s && knot != &knots_[way.first_knot]) --knot;
    const double piece_s = knot[1].time_s - knot->time_s;
    if (!(piece_s > 0.0)) return {last->position_m + way.gap.m, Vec2d::Zero()};
    const Vec2d velocity_mps = (knot[1].position_m - knot->position_m) / piece_s;
    const Gap cubic = cubic_at(way.gap, time_s / span_s_, span_s_);
    return {knot[1].position_m - velocity_mps * (knot[1].time_s - time_s) + cubic.m,
            velocity_mps + cubic.mps};
}

class PathMaker {
  public:
    PathMaker(const Course& course, std::span<const BallState> from, Tick from_tick, Tick ticks)
        : course_(course),
          from_(from),
          placed_(scene_of(course, from)),
          from_tick_(from_tick),
          ticks_(ticks) {
        paths_.span_s_ = course.tick_s * ticks;
        paths_.ways_.resize(from.size());
    }

    FlightPaths between(std::span<const BallState> to, std::span<const ControlEvent> events);

  private:
    // How the best run so far explains a ball.
    struct Account {
        double effort = 0.0;
        std::uint32_t run = 0;
        Gap gap;
    };

    void learn_reach(std::span<const BallState> to);
    void add(std::size_t ball, const BallState* to);
    void judge(const FlightRun& run);
    bool is_settled(const Gap& gap) const;
    double effort_with(std::size_t flying) const;
    bool push_on(const FlightRun& run);
    void write(std::size_t ball, std::span<const Knot> knots, const Gap& gap);
    void write_smooth(std::size_t ball, const Motion& end);
    void write_all();

    const Course& course_;
    std::span<const BallState> from_;
    physics::Scene placed_;  // where the physics has them
    Tick from_tick_, ticks_;
    double reach_m_ = 0.0;  // of a flight, with hits
    FlightPaths paths_;
    // Of those that the physics runs with, by their place among them.
    std::vector<BallState> flying_;
    std::vector<std::uint32_t> origin_;  // in from_
    std::vector<Motion> ends_;
    std::vector<std::uint8_t> bound_;  // the end is known
    std::vector<Gap> gaps_;            // that the last run left and that need explaining
    std::vector<Account> accounts_;
    std::vector<FlightRun> runs_;
    Pushes pushes_;
};

void PathMaker::write(std::size_t ball, std::span<const Knot> knots, const Gap& gap) {
    const auto first = static_cast<std::uint32_t>(paths_.knots_.size());
    paths_.knots_.insert(paths_.knots_.end(), knots.begin(), knots.end());
    paths_.ways_[ball] = {first, static_cast<std::uint32_t>(paths_.knots_.size()), gap};
}

void PathMaker::write_smooth(std::size_t ball, const Motion& end) {
    const Motion start = motion_of(from_[ball], course_.lattice);
    const Vec2d coasted_m = start.m + start.mps * paths_.span_s_;
    const Knot knots[] = {{0.0, start.m}, {paths_.span_s_, coasted_m}};
    write(ball, knots, {end.m - coasted_m, end.mps - start.mps});
}

// A slow ball may have been hit by the fastest, and have hit another since.
void PathMaker::learn_reach(std::span<const BallState> to) {
    double fastest_mps = 0.0;
    for (const std::span<const BallState> balls : {from_, to}) {
        for (const BallState& ball : balls) {
            fastest_mps = std::max(fastest_mps, motion_of(ball, course_.lattice).mps.norm());
        }
    }
    reach_m_ = 2.0 * fastest_mps * paths_.span_s_ + kTeleportSlackM;
}

// `to` is where it ends, or null when nobody knows.
void PathMaker::add(std::size_t ball, const BallState* to) {
    const Motion start = motion_of(from_[ball], course_.lattice);
    const Vec2d coasted_m = start.m + start.mps * paths_.span_s_;
    const Motion end =
        to != nullptr ? motion_of(*to, course_.lattice) : Motion{coasted_m, start.mps};
    const auto& platform = course_.scene.platform;
    const Vec2d& placed_m = placed_.bodies[ball].position_m;
    if (to != nullptr && (end.m - start.m).norm() > reach_m_) {
        write(ball, {{{0.0, start.m}}}, {});
    } else if (ticks_ > kMaxFlightTicks) {
        write(ball, {{{0.0, start.m}, {paths_.span_s_, end.m}}}, {});
    } else if (platform && !(physics::distance_to_edge_m(*platform, placed_m) >= 0.0)) {
        write_smooth(ball, end);
    } else {
        flying_.push_back(from_[ball]);
        origin_.push_back(static_cast<std::uint32_t>(ball));
        ends_.push_back(end);
        bound_.push_back(to != nullptr ? 1 : 0);
    }
}

// By no more than what rounding both snapshots leaves open.
bool PathMaker::is_settled(const Gap& gap) const {
    const double speed_mps = course_.lattice.velocity_step_mps;
    const double place_m = course_.lattice.position_step_m + speed_mps * paths_.span_s_;
    return gap.m.lpNorm<Eigen::Infinity>() <= place_m &&
           gap.mps.lpNorm<Eigen::Infinity>() <= speed_mps;
}

double PathMaker::effort_with(std::size_t flying) const {
    double effort = effort_of(gaps_[flying], paths_.span_s_);
    if (pushes_.mps2.empty()) return effort;
    for (Tick tick = 0; tick < ticks_; ++tick) {
        effort += pushes_.at(tick, flying).squaredNorm() * course_.tick_s;
    }
    return effort;
}

void PathMaker::judge(const FlightRun& run) {
    const bool first = runs_.size() == 1;
    for (std::size_t i = 0; i < flying_.size(); ++i) {
        if (bound_[i] == 0) continue;
        gaps_[i] = {ends_[i].m - run.balls[i].end_m, ends_[i].mps - run.balls[i].end_mps};
        const bool settled = is_settled(gaps_[i]);
        const double effort = settled ? 0.0 : effort_with(i);
        if (first || effort < accounts_[i].effort) {
            accounts_[i] = {effort, static_cast<std::uint32_t>(runs_.size() - 1), gaps_[i]};
        }
        if (settled) gaps_[i] = {};
    }
}

// Whether another run, with what was added to the pushes, has more to tell than this one.
bool PathMaker::push_on(const FlightRun& run) {
    const double restitution = course_.scene.restitution;
    std::vector<std::uint8_t> open(flying_.size() + 1);
    for (std::size_t i = 0; i < flying_.size(); ++i) {
        open[i] = gaps_[i].m != Vec2d::Zero() || gaps_[i].mps != Vec2d::Zero() ? 1 : 0;
    }
    const auto missed = find_missed_hits(run, restitution, paths_.span_s_, gaps_);
    if (missed.empty() && std::ranges::none_of(run.hits, [&](const RunHit& hit) {
            return open[hit.a] != 0 || open[hit.b] != 0;
        })) {
        return false;
    }
    pushes_.count = flying_.size();
    pushes_.mps2.resize(ticks_ * flying_.size(), Vec2d::Zero());
    for (const MissedHit& hit : missed) {
        gaps_[hit.a] = gaps_[hit.b] = {};
        add_pushes_to_touch(hit, course_.tick_s, ticks_, pushes_);
    }
    add_least_pushes(run, restitution, course_.tick_s, ticks_, gaps_, bound_, pushes_);
    return true;
}

void PathMaker::write_all() {
    for (std::size_t i = 0; i < flying_.size(); ++i) {
        const Account& account = accounts_[i];
        const Motion start = motion_of(flying_[i], course_.lattice);
        const Gap smooth{ends_[i].m - start.m - start.mps * paths_.span_s_,
                         ends_[i].mps - start.mps};
        if (bound_[i] != 0 && effort_of(smooth, paths_.span_s_) < account.effort) {
            write_smooth(origin_[i], ends_[i]);
        } else {
            write(origin_[i], runs_[account.run].knots_of(i), account.gap);
        }
    }
}

FlightPaths PathMaker::between(std::span<const BallState> to,
                               std::span<const ControlEvent> events) {
    learn_reach(to);
    auto target = to.begin();
    for (std::size_t i = 0; i < from_.size(); ++i) {
        while (target != to.end() && target->id < from_[i].id) ++target;
        const bool in_both = target != to.end() && target->id == from_[i].id;
        add(i, in_both ? &*target : nullptr);
    }
    if (flying_.empty()) return std::move(paths_);
    accounts_.resize(flying_.size());
    gaps_.resize(flying_.size());
    for (bool more = true; more && runs_.size() < kMaxRuns;) {
        runs_.push_back(run_flight(course_, flying_, from_tick_, ticks_, events, pushes_));
        judge(runs_.back());
        more = runs_.size() < kMaxRuns && push_on(runs_.back());
    }
    write_all();
    return std::move(paths_);
}

FlightPaths paths_between(const Course& course, std::span<const BallState> from, Tick from_tick,
                          std::span<const BallState> to, Tick to_tick,
                          std::span<const ControlEvent> events) {
    assert(from_tick < to_tick);
    return PathMaker(course, from, from_tick, to_tick - from_tick).between(to, events);
}

FlightPaths paths_beyond(const Course& course, std::span<const BallState> from, Tick ticks) {
    return PathMaker(course, from, 0, std::min(ticks, kMaxFlightTicks)).between({}, {});
}

}  // namespace fts::replication
