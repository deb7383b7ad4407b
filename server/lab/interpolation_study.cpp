#include "server/lab/interpolation_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <memory>
#include <span>
#include <utility>

#include "common/replication/flight_paths.h"
#include "server/lab/arena_trace.h"
#include "server/lab/true_paths.h"

namespace fts::lab {
namespace {

using physics::Vec2d;
using replication::FlightPaths;

constexpr std::size_t kFramesPerTick = static_cast<std::size_t>(kFrameRateHz) / kTraceTickRateHz;

// Errors by size: exact to a ten-thousandth of a radius up to kWidest radii.
class Errors {
  public:
    void add(double radii) {
        const double bin = std::min(radii / kStep, static_cast<double>(kBins - 1));
        ++counts_[static_cast<std::size_t>(bin)];
        ++samples_;
        sum_ += radii;
        max_ = std::max(max_, radii);
    }
    void write_to(InterpolationRow& row) const {
        row.samples = samples_;
        row.mean = sum_ / std::max(1.0, static_cast<double>(samples_));
        row.p99 = quantile(0.99);
        row.max = max_;
    }

  private:
    static constexpr double kStep = 1e-4, kWidest = 20.0;
    static constexpr auto kBins = static_cast<std::size_t>(kWidest / kStep) + 1;

    // Not below it, by at most a step.
    double quantile(double part) const {
        const auto enough = static_cast<std::uint64_t>(std::ceil(part * double(samples_)));
        std::uint64_t seen = 0;
        for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
            seen += counts_[bin];
            if (seen >= enough) return std::min(max_, kStep * static_cast<double>(bin + 1));
        }
        return max_;
    }

    std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(kBins);
    std::uint64_t samples_ = 0;
    double sum_ = 0.0, max_ = 0.0;
};

struct Way {
    std::string_view name;
    Errors errors;
    double path_us = 0.0;  // all paths together
    std::uint64_t paths = 0;
};

struct Motion {
    Vec2d m, mps;
};

Motion motion_of(const replication::BallState& ball) {
    return {{ball.x * kTraceLattice.position_step_m, ball.y * kTraceLattice.position_step_m},
            {ball.vx * kTraceLattice.velocity_step_mps, ball.vy * kTraceLattice.velocity_step_mps}};
}

Vec2d on_line(const Motion& from, const Motion& to, double share, double) {
    return from.m + share * (to.m - from.m);
}

Vec2d on_cubic(const Motion& from, const Motion& to, double share, double span_s) {
    const double s = share, left = 1.0 - share;
    return from.m * (left * left * (1.0 + 2.0 * s)) + to.m * (s * s * (3.0 - 2.0 * s)) +
           from.mps * (span_s * s * left * left) - to.mps * (span_s * s * s * left);
}

// One trace, snapshot after snapshot, and what is drawn between them.
class Drawn {
  public:
    Drawn(ArenaTrace trace, double radius_m) : trace_(std::move(trace)), radius_m_(radius_m) {
        watch_.before = [this](const physics::World<double>& world) { true_.before_tick(world); };
        watch_.after = [this](const physics::World<double>& world) {
            for (physics::Contact<double> contact : world.contacts()) {
                contact.time_s += static_cast<double>(ticks_seen_) / kTraceTickRateHz;
                contacts_.push_back(contact);
            }
            true_.after_tick(world, 1.0 / kTraceTickRateHz);
            ++ticks_seen_;
        };
    }
    Drawn(const Drawn&) = delete;
    Drawn& operator=(const Drawn&) = delete;

    void settle() { from_ = trace_.next(); }
    void next() {
        if (!to_.balls.empty()) from_ = std::move(to_);
        true_.clear();
        contacts_.clear();
        ticks_seen_ = 0;
        to_ = trace_.next(watch_);
    }

    template <typename Curve>
    void compare_curve(Way& way, const Curve& curve) const {
        compare(way, [&](std::size_t i, double since_s) {
            return curve(motion_of(from_.balls[i]), motion_of(to_.balls[i]), since_s / span_s(),
                         span_s());
        });
    }
    void compare_paths(Way& way, const replication::Course& course,
                       std::span<const replication::ControlEvent> events) const {
        const std::clock_t start = std::clock();
        const FlightPaths paths = replication::paths_between(course, from_.balls, from_.tick,
                                                             to_.balls, to_.tick, events);
        way.path_us += 1e6 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        way.paths += from_.balls.size();
        compare(way,
                [&](std::size_t i, double since_s) { return paths.at(i, since_s).position_m; });
    }
    const std::vector<replication::ControlEvent>& events() const { return to_.events; }
    void keep_worst_hit(std::optional<DrawnHit>& worst, const replication::Course& blind) const;

  private:
    double span_s() const { return double(to_.tick - from_.tick) / kTraceTickRateHz; }
    DrawnHit::Ball drawn_ball(std::size_t i, double hit_s, const Vec2d& hit_m,
                              const FlightPaths& paths) const;
    template <typename Place>
    void compare(Way& way, const Place& place) const {
        for (std::size_t frame = 0; frame < true_.frames(); ++frame) {
            const double since_s = true_.tick_of(frame) / kTraceTickRateHz;
            const std::vector<Vec2d>& true_m = true_.at(frame);
            for (std::size_t i = 0; i < true_m.size(); ++i) {
                way.errors.add((place(i, since_s) - true_m[i]).norm() / radius_m_);
            }
        }
    }

    ArenaTrace trace_;
    double radius_m_;
    TickWatch watch_;
    TruePaths true_{kFramesPerTick};
    std::vector<physics::Contact<double>> contacts_;
    std::size_t ticks_seen_ = 0;
    TraceSnapshot from_, to_;
};

// Neither nearly on nor nearly back: a path that can be seen apart.
bool turns(const Vec2d& before_mps, const Vec2d& after_mps) {
    const double cosine = before_mps.dot(after_mps) / (before_mps.norm() * after_mps.norm());
    return cosine > -0.87 && cosine < 0.7;
}

// Of the hits in the middle of the span that turn both balls, of balls that hit nothing else in it.
void Drawn::keep_worst_hit(std::optional<DrawnHit>& worst, const replication::Course& blind) const {
    std::vector<int> hits_of(from_.balls.size());
    for (const auto& contact : contacts_) {
        ++hits_of[contact.a.index];
        if (contact.b) ++hits_of[contact.b->index];
    }
    std::optional<FlightPaths> paths;
    for (const auto& contact : contacts_) {
        const double share = contact.time_s / span_s();
        if (!contact.b || share < 0.4 || share > 0.6) continue;
        const std::size_t a = contact.a.index, b = contact.b->index;
        if (hits_of[a] != 1 || hits_of[b] != 1) continue;
        if (!turns(contact.velocity_a_before_mps, contact.velocity_a_after_mps)) continue;
        if (!turns(contact.velocity_b_before_mps, contact.velocity_b_after_mps)) continue;
        const auto shortfall_m = [&](std::size_t i, const Vec2d& hit_m) {
            return (on_line(motion_of(from_.balls[i]), motion_of(to_.balls[i]), share, 0.0) - hit_m)
                .norm();
        };
        const double least_m =
            std::min(shortfall_m(a, contact.position_a_m), shortfall_m(b, contact.position_b_m));
        if (worst && least_m <= worst->shortfall_m) continue;
        if (!paths) {
            paths =
                replication::paths_between(blind, from_.balls, from_.tick, to_.balls, to_.tick, {});
        }
        worst = DrawnHit{least_m, drawn_ball(a, contact.time_s, contact.position_a_m, *paths),
                         drawn_ball(b, contact.time_s, contact.position_b_m, *paths)};
    }
}

DrawnHit::Ball Drawn::drawn_ball(std::size_t i, double hit_s, const Vec2d& hit_m,
                                 const FlightPaths& paths) const {
    constexpr int kPoints = 200;
    DrawnHit::Ball ball;
    ball.hit_m = hit_m;
    bool before_hit = true;
    for (std::size_t frame = 0; frame < true_.frames(); ++frame) {
        const bool now_before = true_.tick_of(frame) / kTraceTickRateHz < hit_s;
        if (before_hit && !now_before) ball.truth.push_back(hit_m);
        before_hit = now_before;
        ball.truth.push_back(true_.at(frame)[i]);
    }
    const Motion from = motion_of(from_.balls[i]), to = motion_of(to_.balls[i]);
    for (int point = 0; point <= kPoints; ++point) {
        const double share = static_cast<double>(point) / kPoints;
        ball.straight.push_back(on_line(from, to, share, span_s()));
        ball.smooth.push_back(on_cubic(from, to, share, span_s()));
        ball.blind.push_back(paths.at(i, share * span_s()).position_m);
    }
    return ball;
}

class RateStudy {
  public:
    RateStudy(ArenaTrace free, ArenaTrace snapped, double radius_m)
        : free_(std::move(free), radius_m), snapped_(std::move(snapped), radius_m) {
        blind_.control_of = nullptr;
    }

    void settle() {
        free_.settle();
        snapped_.settle();
    }
    void next() {
        free_.next();
        snapped_.next();
        free_.compare_curve(ways_[0], on_line);
        free_.compare_curve(ways_[1], on_cubic);
        free_.compare_paths(ways_[2], blind_, {});
        free_.compare_paths(ways_[3], told_, free_.events());
        snapped_.compare_paths(ways_[4], told_, snapped_.events());
    }
    void keep_worst_hit(std::optional<DrawnHit>& worst) const {
        free_.keep_worst_hit(worst, blind_);
    }
    void write_to(std::vector<InterpolationRow>& rows, int rate_hz) const {
        for (const Way& way : ways_) {
            InterpolationRow& row = rows.emplace_back();
            row.way = way.name;
            row.rate_hz = rate_hz;
            way.errors.write_to(row);
            row.us_per_ball = way.path_us / std::max(1.0, static_cast<double>(way.paths));
        }
    }

  private:
    Drawn free_, snapped_;
    replication::Course told_ = trace_course(), blind_ = trace_course();
    std::array<Way, 5> ways_{Way{kStraightWay, {}}, Way{kHermiteWay, {}}, Way{kBlindWay, {}},
                             Way{kToldWay, {}}, Way{kLatticeWay, {}}};
};

}  // namespace

InterpolationStudy study_interpolation(
    const InterpolationRequest& request, const std::function<bool()>& go_on,
    const std::function<void(std::size_t done, std::size_t of)>& progress) {
    InterpolationStudy study;
    const auto snapshots_in = [](double span_s, int rate_hz) {
        return static_cast<std::size_t>(std::floor(span_s * rate_hz));
    };
    for (const int rate_hz : kStudyRatesHz) study.of += snapshots_in(request.seconds, rate_hz);
    study.radius_m = trace_radius_m(request.count);
    for (const int rate_hz : kStudyRatesHz) {
        const auto ticks = static_cast<replication::Tick>(kTraceTickRateHz / rate_hz);
        auto free = ArenaTrace::make(request.count, request.seed, ticks, false, study.error);
        auto snapped = ArenaTrace::make(request.count, request.seed, ticks, true, study.error);
        if (!free || !snapped) return study;
        const auto rate =
            std::make_unique<RateStudy>(std::move(*free), std::move(*snapped), study.radius_m);
        for (std::size_t i = 0; i < snapshots_in(request.seconds, rate_hz) && go_on(); ++i) {
            progress(study.done++, study.of);
            if (i < snapshots_in(kUnmeasuredS, rate_hz)) {
                rate->settle();
            } else {
                rate->next();
                if (rate_hz == kDrawnHitRateHz) rate->keep_worst_hit(study.worst_hit);
            }
        }
        rate->write_to(study.rows, rate_hz);
    }
    return study;
}

}  // namespace fts::lab
