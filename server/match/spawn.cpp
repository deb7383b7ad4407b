#include "server/match/spawn.h"

#include <algorithm>

namespace fts::server {
namespace {

constexpr int kSpawnCandidates = 24;
constexpr int kScatterTries = 64;
constexpr double kSpawnGapM = 0.25;
constexpr double kSpawnEdgeMarginM = 3.0;
// On a small platform the margin gives way: the inner 60 % of the way to the edge is always
// allowed.
constexpr double kGreatestMarginShare = 0.4;

double margin_that_fits(const physics::Platform& platform, double margin_m) {
    return std::min(margin_m, kGreatestMarginShare * inradius_m(platform));
}

// Deep inside whatever the platform: the middle, or on a ring the middle of the band.
physics::Vec2d innermost_point(const physics::Platform& platform) {
    if (const auto* ring = std::get_if<physics::Ring>(&platform))
        return {(ring->inner_radius_m + ring->outer_radius_m) / 2.0, 0.0};
    return physics::Vec2d::Zero();
}

}  // namespace

double inradius_m(const physics::Platform& platform) {
    return physics::distance_to_edge_m(platform, innermost_point(platform));
}

physics::Vec2d scatter_near(const physics::Platform& platform, const physics::Vec2d& around_m,
                            double spread_m, double margin_m, Random& random) {
    const double margin = margin_that_fits(platform, margin_m);
    for (int i = 0; i < kScatterTries; ++i) {
        const double x = random.between(-spread_m, spread_m);
        const double y = random.between(-spread_m, spread_m);
        physics::Vec2d point = around_m + physics::Vec2d{x, y};
        if (physics::distance_to_edge_m(platform, point) >= margin) return point;
    }
    return innermost_point(platform);
}

physics::Vec2d scatter(const physics::Platform& platform, double margin_m, Random& random) {
    return scatter_near(platform, physics::Vec2d::Zero(), physics::bounding_radius_m(platform),
                        margin_m, random);
}

std::optional<physics::Vec2d> find_spawn(const physics::Platform& platform, double radius_m,
                                         const Clearance& clearance, Random& random) {
    std::optional<physics::Vec2d> best;
    double best_room_m = radius_m + kSpawnGapM;
    for (int i = 0; i < kSpawnCandidates; ++i) {
        const physics::Vec2d candidate = scatter(platform, kSpawnEdgeMarginM, random);
        const double room_m = clearance(candidate);
        if (room_m <= best_room_m) continue;
        best = candidate;
        best_room_m = room_m;
    }
    return best;
}

}  // namespace fts::server
