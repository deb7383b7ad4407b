#include "client/sdl/draw_effects.h"

#include <algorithm>
#include <cmath>

#include "client/sdl/draw_balls.h"

namespace fts::sdl {
namespace {

constexpr double kSparkS = 0.45;
constexpr double kFallS = 0.7;
constexpr double kTrailS = 0.28;
constexpr double kSampleEveryS = 0.018;
constexpr double kMinTrailSpeedMps = 1.5;
constexpr std::size_t kMaxSparks = 64;
constexpr double kEdgeReachM =
    1.5;  // a ball that vanishes farther inside was taken, it did not fall

// In [0, 1), the same for the same seed and number.
double scattered(std::uint32_t seed, std::uint32_t number) {
    std::uint32_t bits = seed * 747796405U + number * 2891336453U + 1U;
    bits = ((bits >> ((bits >> 28U) + 4U)) ^ bits) * 277803737U;
    return static_cast<double>((bits >> 22U) ^ (bits & 0x3ffU)) / 1024.0;
}

}  // namespace

void Effects::observe(const client::View& view, double now_s) {
    observe_hits(view, now_s);
    observe_balls(view, now_s);
}

void Effects::observe_hits(const client::View& view, double now_s) {
    std::erase_if(sparks_, [&](const Spark& spark) { return now_s - spark.born_s > kSparkS; });
    for (const client::HitView& hit : view.hits) {
        if (sparks_.size() == kMaxSparks) sparks_.erase(sparks_.begin());
        sparks_.push_back({hit.point_m, hit.impulse_ns, now_s, ++hits_seen_});
    }
}

void Effects::observe_balls(const client::View& view, double now_s) {
    std::erase_if(falling_, [&](const Falling& f) { return now_s - f.born_s > kFallS; });
    for (const client::BallView& ball : view.balls) {
        Trail& trail = trails_[ball.id];
        // An id may come back far away: its trail starts anew.
        if (trail.count > 0 && (trail.last.position_m - ball.position_m).norm() > 2.0) {
            trail.count = 0;
        }
        trail.last = ball;
        trail.seen_s = now_s;
        if (trail.count > 0 && now_s - trail.samples[trail.count - 1].time_s < kSampleEveryS) {
            continue;
        }
        if (trail.count == kTrailSamples) {
            std::shift_left(trail.samples.begin(), trail.samples.end(), 1);
            --trail.count;
        }
        trail.samples[trail.count++] = {ball.position_m, now_s};
    }
    std::erase_if(trails_, [&](const auto& entry) {
        const Trail& trail = entry.second;
        if (trail.seen_s == now_s) return false;
        const double inside_m =
            physics::distance_to_edge_m(view.level.platform, trail.last.position_m);
        if (view.phase == game::Phase::kPlaying && inside_m < kEdgeReachM) {
            falling_.push_back({trail.last, now_s});
        }
        return true;
    });
}

void Effects::draw_trail(const Canvas& canvas, const Camera& camera, const Trail& trail,
                         double now_s) const {
    if (trail.last.velocity_mps.norm() < kMinTrailSpeedMps) return;
    const float radius = camera.px(trail.last.radius_m);
    const Colour colour = ball_colour(trail.last);
    for (std::size_t i = 0; i + 1 < trail.count; ++i) {
        const double age = (now_s - trail.samples[i].time_s) / kTrailS;
        if (age > 1.0) continue;
        const ImVec2 from = camera.to_screen(trail.samples[i].position_m);
        const ImVec2 to = camera.to_screen(trail.samples[i + 1].position_m);
        canvas.line(from, to, fade(colour, 0.28 * (1.0 - age)),
                    radius * 1.5F * static_cast<float>(1.0 - 0.7 * age));
    }
}

void Effects::draw_below_balls(const Canvas& canvas, const Camera& camera) const {
    for (const Falling& fallen : falling_) {
        const double age = std::clamp((canvas.time_s - fallen.born_s) / kFallS, 0.0, 1.0);
        const physics::Vec2d at = fallen.ball.position_m +
                                  fallen.ball.velocity_mps * (age * kFallS) +
                                  physics::Vec2d(0.0, -1.2 * age * age);
        const auto shrink = static_cast<float>(1.0 - 0.75 * age);
        draw_rubber_ball(canvas, camera.to_screen(at), camera.px(fallen.ball.radius_m) * shrink,
                         {ball_colour(fallen.ball), fallen.ball.mass_kg, false, 1.0 - age});
    }
    for (const auto& [id, trail] : trails_) draw_trail(canvas, camera, trail, canvas.time_s);
}

void Effects::draw_above_balls(const Canvas& canvas, const Camera& camera) const {
    constexpr std::uint32_t kRays = 10;
    for (const Spark& spark : sparks_) {
        const double age = std::clamp((canvas.time_s - spark.born_s) / kSparkS, 0.0, 1.0);
        const double size_m =
            std::clamp(0.35 * std::sqrt(std::max(spark.impulse_ns, 0.0)), 0.12, 2.2);
        const double out = 1.0 - (1.0 - age) * (1.0 - age);
        const ImVec2 at = camera.to_screen(spark.point_m);
        const double strength = 1.0 - age;
        canvas.ring(at, camera.px(size_m * (0.15 + out)), fade(palette::kText, 0.55 * strength),
                    std::max(1.0F, canvas.px(2.5F) * static_cast<float>(strength)));
        for (std::uint32_t i = 0; i < kRays; ++i) {
            const double angle = 6.2831853 * (i + scattered(spark.seed, i)) / kRays;
            const double reach = size_m * (0.5 + 0.7 * scattered(spark.seed, i + kRays));
            const physics::Vec2d way(std::cos(angle), std::sin(angle));
            canvas.line(camera.to_screen(spark.point_m + way * (reach * out)),
                        camera.to_screen(spark.point_m + way * (reach * (0.55 * out))),
                        fade(palette::kGold, strength), std::max(1.0F, canvas.px(1.6F)));
        }
    }
}

}  // namespace fts::sdl
