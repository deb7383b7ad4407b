#include "common/replication/flight_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fts::replication {
namespace {

using physics::Vec2d;

constexpr int kMaxFitSteps = 12;
constexpr double kFitTolerance = 1e-4;  // of the squared gap
// A hit that only grazes passes changes on without bound; the part of the approach that is along
// the normal is taken to be at least this.
constexpr double kLeastSquareness = 0.1;
constexpr double kLeastApproachMps = 1e-9;

// Both what a ball's state is changed by and, walking back, how much a change of it is worth.
using State = Gap;

double dot(const State& a, const State& b) {
    return a.m.dot(b.m) + a.mps.dot(b.mps);
}

class Hits {
  public:
    Hits(const FlightRun& run, double restitution) : run_(run), elasticity_(1.0 + restitution) {}

    std::size_t size() const { return run_.hits.size(); }
    const RunHit& operator[](std::size_t k) const { return run_.hits[k]; }

    // How a hit passes a change of the two on.
    void pass(const RunHit& hit, State& a, State& b) const {
        const Vec2d &n = hit.normal, &w = hit.approach_mps;
        const Vec2d apart_m = a.m - b.m, faster_mps = a.mps - b.mps;
        const double later_s = -n.dot(apart_m) / squarely(hit);
        const Vec2d turn = (apart_m + w * later_s) * hit.inverse_reach;
        const double stronger_ns =
            -elasticity_ * reduced_mass(hit) * (n.dot(faster_mps) + w.dot(turn));
        const Vec2d given_ns = stronger_ns * n + hit.impulse_ns * turn;
        const Vec2d missed_ns = -hit.impulse_ns * later_s * n;  // kg m
        a.mps += given_ns * hit.inverse_mass_a;
        b.mps -= given_ns * hit.inverse_mass_b;
        a.m += missed_ns * hit.inverse_mass_a;
        b.m -= missed_ns * hit.inverse_mass_b;
    }

    // The transpose of `pass`.
    void pass_back(const RunHit& hit, State& a, State& b) const {
        const Vec2d &n = hit.normal, &w = hit.approach_mps;
        const Vec2d given = a.mps * hit.inverse_mass_a - b.mps * hit.inverse_mass_b;
        const Vec2d missed = a.m * hit.inverse_mass_a - b.m * hit.inverse_mass_b;
        const double stronger = -elasticity_ * reduced_mass(hit) * n.dot(given);
        const Vec2d turn = (hit.impulse_ns * given + stronger * w) * hit.inverse_reach;
        const double later = w.dot(turn) - hit.impulse_ns * n.dot(missed);
        const Vec2d apart = turn - n * (later / squarely(hit));
        a.mps += stronger * n;
        b.mps -= stronger * n;
        a.m += apart;
        b.m -= apart;
    }

  private:
    static double squarely(const RunHit& hit) {
        return std::min({hit.normal.dot(hit.approach_mps),
                         -kLeastSquareness * hit.approach_mps.norm(), -kLeastApproachMps});
    }
    static double reduced_mass(const RunHit& hit) {
        return 1.0 / (hit.inverse_mass_a + hit.inverse_mass_b);
    }

    const FlightRun& run_;
    double elasticity_;
};

// What a change is to be worth at the end of a free flight so that it is pushed to close `gap`.
State free_worth(const Gap& gap, double span_s) {
    const double t = span_s;
    return {12.0 / (t * t * t) * gap.m - 6.0 / (t * t) * gap.mps,
            -6.0 / (t * t) * gap.m + 4.0 / t * gap.mps};
}

class Fit {
  public:
    Fit(const FlightRun& run, double restitution, double span_s,
        const std::vector<std::uint8_t>& bound)
        : hits_(run, restitution),
          span_s_(span_s),
          bound_(bound),
          count_(run.balls.size()),
          cluster_(count_),
          first_(count_ + 1),
          after_(2 * hits_.size()),
          going_(count_ + 1),
          hit_something_(count_ + 1) {
        join_clusters();
    }

    void solve(std::span<const Gap> gaps);
    void add_to(Pushes& pushes, double tick_s, Tick ticks);

  private:
    struct Going {
        State state, worth;
        double since_s = 0.0;
    };
    // By ball: what is left to close, the way to go, what going it closes, and the next one.
    // By cluster: how much is left, how little is enough, and what the way closes of it.
    struct Descent {
        explicit Descent(std::size_t count)
            : left(count),
              way(count),
              closed(count),
              towards(count),
              open(count),
              still_open(count),
              settled(count),
              along(count) {}
        bool goes_on(std::uint32_t cluster) const {
            return along[cluster] > 0.0 && open[cluster] > settled[cluster];
        }

        std::vector<Gap> left;
        std::vector<State> way;
        std::vector<Gap> closed;
        std::vector<State> towards;
        std::vector<double> open, still_open, settled, along;
    };

    void join_clusters();
    std::uint32_t root(std::uint32_t ball) {
        while (cluster_[ball] != ball) ball = cluster_[ball] = cluster_[cluster_[ball]];
        return ball;
    }
    void walk_back(const std::vector<State>& worth);
    template <typename Leg>
    void walk_forth(const Leg& leg);
    void closed_by(const std::vector<State>& worth, std::vector<Gap>& gaps);
    bool stride(Descent& descent);
    void turn(Descent& descent);

    Hits hits_;
    double span_s_;
    const std::vector<std::uint8_t>& bound_;
    std::size_t count_;
    std::vector<std::uint32_t> cluster_;   // by ball: one ball of it
    std::vector<std::uint32_t> together_;  // balls that hit something
    std::vector<State> first_;             // what changes are worth at the start
    std::vector<State> after_;             // and after each hit, to its a and its b
    std::vector<State> worth_;
    std::vector<Going> going_;  // the last stands for walls, here and below
    std::vector<bool> hit_something_;
};

void Fit::join_clusters() {
    std::iota(cluster_.begin(), cluster_.end(), 0U);
    for (std::size_t k = 0; k < hits_.size(); ++k) {
        hit_something_[hits_[k].a] = hit_something_[hits_[k].b] = true;
        if (hits_[k].b < count_) cluster_[root(hits_[k].a)] = root(hits_[k].b);
    }
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (hit_something_[i]) together_.push_back(i);
    }
    for (const std::uint32_t i : together_) cluster_[i] = root(i);
}

// What a change of velocity is worth grows by the worth of place for every second before.
void Fit::walk_back(const std::vector<State>& worth) {
    for (const std::uint32_t i : together_) going_[i] = {{}, worth[i], span_s_};
    const auto back_to = [&](Going& ball, double time_s) {
        ball.worth.mps += ball.worth.m * (ball.since_s - time_s);
        ball.since_s = time_s;
    };
    for (std::size_t k = hits_.size(); k-- > 0;) {
        const RunHit& hit = hits_[k];
        Going &a = going_[hit.a], &b = going_[hit.b];
        if (hit.b == count_) b = {};
        back_to(a, hit.time_s);
        back_to(b, hit.time_s);
        after_[2 * k] = a.worth;
        after_[2 * k + 1] = b.worth;
        hits_.pass_back(hit, a.worth, b.worth);
    }
    for (const std::uint32_t i : together_) {
        back_to(going_[i], 0.0);
        first_[i] = going_[i].worth;
    }
}

// Pushed by what a change of velocity is worth at each moment.
template <typename Leg>
void Fit::walk_forth(const Leg& leg) {
    for (const std::uint32_t i : together_) going_[i] = {{}, first_[i], 0.0};
    const auto on_to = [&](std::uint32_t i, double time_s) {
        Going& ball = going_[i];
        const double t = time_s - ball.since_s;
        leg(i, ball.since_s, time_s, ball.worth);
        ball.state.m +=
            ball.state.mps * t + ball.worth.mps * (t * t / 2.0) - ball.worth.m * (t * t * t / 6.0);
        ball.state.mps += ball.worth.mps * t - ball.worth.m * (t * t / 2.0);
        ball.since_s = time_s;
    };
    for (std::size_t k = 0; k < hits_.size(); ++k) {
        const RunHit& hit = hits_[k];
        on_to(hit.a, hit.time_s);
        if (hit.b < count_) on_to(hit.b, hit.time_s);
        Going &a = going_[hit.a], &b = going_[hit.b];
        if (hit.b == count_) b = {};
        hits_.pass(hit, a.state, b.state);
        a.worth = after_[2 * k];
        b.worth = after_[2 * k + 1];
    }
    for (const std::uint32_t i : together_) on_to(i, span_s_);
}

void Fit::closed_by(const std::vector<State>& worth, std::vector<Gap>& gaps) {
    walk_back(worth);
    walk_forth([](std::uint32_t, double, double, const State&) {});
    for (const std::uint32_t i : together_) gaps[i] = bound_[i] != 0 ? going_[i].state : Gap{};
}

// Conjugate gradients, conditioned by what is right in free flight, for all clusters in step.
void Fit::solve(std::span<const Gap> gaps) {
    worth_.assign(count_, {});
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (bound_[i] != 0 && !hit_something_[i]) worth_[i] = free_worth(gaps[i], span_s_);
    }
    Descent descent(count_);
    for (const std::uint32_t i : together_) {
        if (bound_[i] != 0) descent.left[i] = gaps[i];
        descent.way[i] = free_worth(descent.left[i], span_s_);
        descent.open[cluster_[i]] += dot(descent.left[i], descent.way[i]);
    }
    descent.settled = descent.open;
    for (double& open : descent.settled) open *= kFitTolerance;
    for (int step = 0; step < kMaxFitSteps && stride(descent); ++step) turn(descent);
}

// As far along the way as closes most; whether there was anything left to close.
bool Fit::stride(Descent& descent) {
    closed_by(descent.way, descent.closed);
    for (const std::uint32_t i : together_) descent.along[cluster_[i]] = 0.0;
    for (const std::uint32_t i : together_) {
        descent.along[cluster_[i]] += dot(descent.way[i], descent.closed[i]);
    }
    bool any = false;
    for (const std::uint32_t i : together_) {
        const std::uint32_t c = cluster_[i];
        if (!descent.goes_on(c)) continue;
        any = true;
        const double length = descent.open[c] / descent.along[c];
        worth_[i].m += length * descent.way[i].m;
        worth_[i].mps += length * descent.way[i].mps;
        descent.left[i].m -= length * descent.closed[i].m;
        descent.left[i].mps -= length * descent.closed[i].mps;
    }
    return any;
}

void Fit::turn(Descent& descent) {
    for (const std::uint32_t i : together_) descent.still_open[cluster_[i]] = 0.0;
    for (const std::uint32_t i : together_) {
        if (!descent.goes_on(cluster_[i])) continue;
        descent.towards[i] = free_worth(descent.left[i], span_s_);
        descent.still_open[cluster_[i]] += dot(descent.left[i], descent.towards[i]);
    }
    for (const std::uint32_t i : together_) {
        const std::uint32_t c = cluster_[i];
        if (!descent.goes_on(c)) continue;
        const double kept = descent.still_open[c] / descent.open[c];
        descent.way[i].m = descent.towards[i].m + kept * descent.way[i].m;
        descent.way[i].mps = descent.towards[i].mps + kept * descent.way[i].mps;
    }
    for (const std::uint32_t i : together_) {
        if (cluster_[i] == i && descent.goes_on(i)) descent.open[i] = descent.still_open[i];
    }
}

void Fit::add_to(Pushes& pushes, double tick_s, Tick ticks) {
    const auto leg = [&](std::uint32_t i, double from_s, double to_s, const State& worth) {
        for (auto tick = static_cast<Tick>(std::max(0.0, std::ceil(from_s / tick_s - 0.5)));
             tick < ticks; ++tick) {
            const double middle_s = (tick + 0.5) * tick_s;
            if (middle_s >= to_s) break;
            const Vec2d more_mps2 = worth.mps - worth.m * (middle_s - from_s);
            if (more_mps2.allFinite()) pushes.at(tick, i) += more_mps2;
        }
    };
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (hit_something_[i]) continue;
        leg(i, 0.0, span_s_, {worth_[i].m, worth_[i].mps + worth_[i].m * span_s_});
    }
    walk_back(worth_);
    walk_forth(leg);
}

}  // namespace

double effort_of(const Gap& gap, double span_s) {
    const State worth = free_worth(gap, span_s);
    return gap.m.dot(worth.m) + gap.mps.dot(worth.mps);
}

void add_least_pushes(const FlightRun& run, double restitution, double tick_s, Tick ticks,
                      std::span<const Gap> gaps, const std::vector<std::uint8_t>& bound,
                      Pushes& pushes) {
    Fit fit(run, restitution, tick_s * ticks, bound);
    fit.solve(gaps);
    fit.add_to(pushes, tick_s, ticks);
}

}  // namespace fts::replication
