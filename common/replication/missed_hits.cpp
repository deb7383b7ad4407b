#include "common/replication/missed_hits.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace fts::replication {
namespace {

using physics::Vec2d;

// How far the momenta that both gained may be from opposite, and from that of a hit, as a part of
// them; and how far they may have passed each other, as a part of the distance of their centres.
constexpr double kMomentumSlack = 0.9;
constexpr double kMissSlack = 0.7;

// Who had less time than this before the hit is not pushed to it.
constexpr double kLeastFlightTicks = 0.25;

class Search {
  public:
    Search(const FlightRun& run, double restitution, double span_s, std::span<const Gap> gaps)
        : run_(run),
          restitution_(restitution),
          span_s_(span_s),
          gaps_(gaps),
          last_hit_s_(run.balls.size()) {
        for (const RunHit& hit : run.hits) {
            last_hit_s_[hit.a] = hit.time_s;
            if (hit.b < run.balls.size()) last_hit_s_[hit.b] = hit.time_s;
        }
    }

    std::vector<MissedHit> find();

  private:
    std::optional<MissedHit> missed(std::uint32_t a, std::uint32_t b) const;
    // How far to the left it may have been at any moment, and to the right.
    double left_m(std::uint32_t ball) const { return run_.balls[ball].end_m.x() - reach_m(ball); }
    double right_m(std::uint32_t ball) const { return run_.balls[ball].end_m.x() + reach_m(ball); }
    double reach_m(std::uint32_t index) const {
        const RunBall& ball = run_.balls[index];
        return ball.radius_m + std::abs(ball.end_mps.x()) * span_s_;
    }

    const FlightRun& run_;
    double restitution_, span_s_;
    std::span<const Gap> gaps_;
    std::vector<double> last_hit_s_;
};

std::optional<MissedHit> Search::missed(std::uint32_t a, std::uint32_t b) const {
    const RunBall &ball_a = run_.balls[a], &ball_b = run_.balls[b];
    const Vec2d gained_a_ns = ball_a.mass_kg * gaps_[a].mps;
    const Vec2d gained_b_ns = ball_b.mass_kg * gaps_[b].mps;
    const Vec2d passed_on_ns = (gained_a_ns - gained_b_ns) / 2.0;
    const double impulse_ns = passed_on_ns.norm();
    if ((gained_a_ns + gained_b_ns).norm() > kMomentumSlack * impulse_ns) return std::nullopt;
    const Vec2d normal = passed_on_ns / impulse_ns;
    const Vec2d approach_mps = ball_a.end_mps - ball_b.end_mps;
    const double mass_kg = 1.0 / (1.0 / ball_a.mass_kg + 1.0 / ball_b.mass_kg);
    const double expected_ns = -(1.0 + restitution_) * mass_kg * normal.dot(approach_mps);
    if (!(std::abs(expected_ns - impulse_ns) <= kMomentumSlack * impulse_ns)) return std::nullopt;
    const double reach_m = ball_a.radius_m + ball_b.radius_m;
    const Vec2d apart_m = ball_a.end_m - ball_b.end_m;
    const double ago_s =
        (apart_m - reach_m * normal).dot(approach_mps) / approach_mps.squaredNorm();
    MissedHit hit{a, b};
    hit.from_s = std::max(last_hit_s_[a], last_hit_s_[b]);
    hit.time_s = std::clamp(span_s_ - ago_s, hit.from_s, span_s_);
    hit.miss_m = reach_m * normal - (apart_m - approach_mps * (span_s_ - hit.time_s));
    if (!(hit.miss_m.norm() <= kMissSlack * reach_m)) return std::nullopt;
    return hit;
}

// The pair that missed by least first.
std::vector<MissedHit> Search::find() {
    std::vector<std::uint32_t> open;
    for (std::uint32_t i = 0; i < gaps_.size(); ++i) {
        if (gaps_[i].mps != Vec2d::Zero()) open.push_back(i);
    }
    std::ranges::sort(open, {}, [&](std::uint32_t i) { return left_m(i); });
    std::vector<MissedHit> found;
    for (std::size_t k = 0; k < open.size(); ++k) {
        for (std::size_t l = k + 1; l < open.size() && left_m(open[l]) <= right_m(open[k]); ++l) {
            if (const auto hit = missed(open[k], open[l])) found.push_back(*hit);
        }
    }
    std::ranges::stable_sort(found, {}, [](const MissedHit& hit) { return hit.miss_m.norm(); });
    std::vector<std::uint8_t> taken(gaps_.size());
    std::erase_if(found, [&](const MissedHit& hit) {
        if (taken[hit.a] != 0 || taken[hit.b] != 0) return true;
        taken[hit.a] = taken[hit.b] = 1;
        return false;
    });
    return found;
}

}  // namespace

std::vector<MissedHit> find_missed_hits(const FlightRun& run, double restitution, double span_s,
                                        std::span<const Gap> gaps) {
    return Search(run, restitution, span_s, gaps).find();
}

void add_pushes_to_touch(const MissedHit& hit, double tick_s, Tick ticks, Pushes& pushes) {
    const double flight_s = hit.time_s - hit.from_s;
    if (flight_s < kLeastFlightTicks * tick_s) return;
    const Vec2d each_mps2 = hit.miss_m / (flight_s * flight_s);
    for (Tick tick = 0; tick < ticks; ++tick) {
        const double start_s = std::max(tick * tick_s, hit.from_s);
        const double end_s = std::min((tick + 1) * tick_s, hit.time_s);
        if (end_s <= start_s) continue;
        const double part = (end_s - start_s) / tick_s;
        pushes.at(tick, hit.a) += part * each_mps2;
        pushes.at(tick, hit.b) -= part * each_mps2;
    }
}

}  // namespace fts::replication
