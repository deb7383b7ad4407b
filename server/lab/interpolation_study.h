// How far what is drawn between snapshots is from what happened: every way to draw on the arena
// that `fts-lab replication` streams, at every frame of a screen, at several rates of snapshots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/physics/scene.h"

namespace fts::lab {

inline constexpr int kStudyRatesHz[] = {10, 20, 30, 60};
inline constexpr double kFrameRateHz = 240.0;

struct InterpolationRequest {
    std::size_t count = 901;
    std::uint64_t seed = 1;
    double seconds = 60.0;
};

inline constexpr std::string_view kStraightWay = "linear";
inline constexpr std::string_view kHermiteWay = "Hermite";
inline constexpr std::string_view kBlindWay = "ours, controls unknown";
inline constexpr std::string_view kToldWay = "ours, controls known";
inline constexpr std::string_view kLatticeWay = "ours, the same on the lattice";

// Errors are distances from where the ball was, in radii.
struct InterpolationRow {
    std::string way;
    int rate_hz = 0;
    double mean = 0.0, p99 = 0.0, max = 0.0;
    std::uint64_t samples = 0;  // balls times frames
    double us_per_ball = 0.0;   // to make a path, once for two snapshots; 0 where none is made
};

// How every way draws the two balls of one hit.
struct DrawnHit {
    using Path = std::vector<physics::Vec2d>;
    struct Ball {
        Path truth, straight, smooth, blind;
        physics::Vec2d hit_m = physics::Vec2d::Zero();
    };
    double shortfall_m = 0.0;  // of a straight line, of the ball it suits better
    Ball a, b;
};
inline constexpr int kDrawnHitRateHz = 20;

struct InterpolationStudy {
    std::vector<InterpolationRow> rows;  // rate after rate
    std::optional<DrawnHit> worst_hit;   // for straight lines, at kDrawnHitRateHz
    double radius_m = 0.0;
    std::size_t done = 0, of = 0;  // snapshots
    std::string error;             // empty: none
    bool stopped() const { return done < of; }
};

InterpolationStudy study_interpolation(
    const InterpolationRequest& request, const std::function<bool()>& go_on,
    const std::function<void(std::size_t done, std::size_t of)>& progress);

std::string table_of(const InterpolationRequest& request, const InterpolationStudy& study);
std::string json_of(const InterpolationRequest& request, const InterpolationStudy& study);
std::string svg_of(const InterpolationRequest& request, const InterpolationStudy& study);
// Empty when there was no hit to show.
std::string hit_svg_of(const InterpolationRequest& request, const InterpolationStudy& study);
std::string command_of(const InterpolationRequest& request);

}  // namespace fts::lab
