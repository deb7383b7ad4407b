// The swept solver's broad phase: rejects no pair that touches, on any instruction set.
#include "common/physics/swept_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/physics/time_of_impact.h"
#include "tests/physics/dice.h"

namespace fts::physics {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

struct Crowd {
    int balls = 400;
    double room_m = 40.0;
    double speed_mps = 1.0;
    double largest_ratio = 1.0;  // of radii
    double far_m = 0.0;          // where one in twenty is
    double from_m = 0.0;         // where the origin is
};

template <typename Scalar>
Bodies<Scalar> crowd_of(const Crowd& crowd, Dice& dice) {
    Bodies<Scalar> bodies;
    for (int i = 0; i < crowd.balls; ++i) {
        Vec2d place = dice.in_box(crowd.room_m) + Vec2d::Constant(crowd.from_m);
        if (i % 20 == 7) place += dice.in_box(crowd.far_m);
        const double radius = 0.5 * std::pow(crowd.largest_ratio, dice.between(0.0, 1.0));
        // One in thirty is much faster than the others.
        const double speed = (i % 30 == 3 ? 20.0 : 1.0) * crowd.speed_mps;
        bodies.add(place.cast<Scalar>(), dice.in_box(speed).template cast<Scalar>(),
                   static_cast<Scalar>(radius), Scalar(1));
    }
    return bodies;
}

Pair ordered(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

template <typename Scalar>
bool touch_within(const Bodies<Scalar>& all, std::uint32_t a, std::uint32_t b, Scalar span_s) {
    return time_until_contact<Scalar>(all.position_m[a] - all.position_m[b],
                                      all.velocity_mps[a] - all.velocity_mps[b],
                                      all.radius_m[a] + all.radius_m[b]) <= span_s;
}

// By looking at every pair.
template <typename Scalar>
std::set<Pair> all_touching(const Bodies<Scalar>& all, const SweptPaths<Scalar>& paths,
                            Scalar span_s) {
    std::set<Pair> found;
    for (std::uint32_t a = 0; a < all.slots(); ++a) {
        for (std::uint32_t b = a + 1; b < all.slots(); ++b) {
            if (paths.is_stray(a) || paths.is_stray(b)) continue;
            if (touch_within(all, a, b, span_s)) found.insert({a, b});
        }
    }
    return found;
}

template <typename Scalar>
void expect_all_pairs_found(const Crowd& crowd, std::uint64_t seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    Bodies<Scalar> all = crowd_of<Scalar>(crowd, dice);
    SweptPaths<Scalar> paths;
    const auto span_s = Scalar(1);
    std::size_t touching = 0;
    for (int tick = 0; tick < 5; ++tick) {
        paths.begin(all, all.position_m, crowd.largest_ratio == 1.0, span_s);
        EXPECT_LT(paths.strays().size(), all.ids.size() / 4);
        std::set<Pair> found;
        paths.for_each_pair([&](std::uint32_t a, std::uint32_t b) {
            EXPECT_TRUE(found.insert(ordered(a, b)).second) << "found twice";
        });
        const std::set<Pair> wanted = all_touching(all, paths, span_s);
        EXPECT_TRUE(std::includes(found.begin(), found.end(), wanted.begin(), wanted.end()));
        touching += wanted.size();
        for (const BodyId id : all.ids) all.position_m[id.index] += all.velocity_mps[id.index];
    }
    EXPECT_GT(touching, 20U);
}

const Crowd kCrowds[] = {
    {},
    {.balls = 3, .room_m = 1.0},
    {.room_m = 12.0},
    {.balls = 1000, .room_m = 60.0, .speed_mps = 0.02},
    {.speed_mps = 6.0},
    {.largest_ratio = 2.0},
    {.speed_mps = 3.0, .largest_ratio = 8.0},
    {.far_m = 1e7},
    {.from_m = 1e3},
};

TEST(SweptPaths, find_every_pair_that_touches_in_any_crowd) {
    for (const Crowd& crowd : kCrowds) {
        if (crowd.balls < 10) continue;
        SCOPED_TRACE(&crowd - kCrowds);
        expect_all_pairs_found<double>(crowd, 61);
        expect_all_pairs_found<float>(crowd, 62);
    }
}

// Half of the bodies turn at different times, as after collisions.
TEST(SweptPaths, find_who_meets_and_who_touches_a_body_that_turned) {
    constexpr std::uint64_t kSeed = 63;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    std::size_t meetings = 0, touches = 0, insiders = 0, outsiders = 0;
    for (const Crowd& crowd : kCrowds) {
        SCOPED_TRACE(&crowd - kCrowds);
        Bodies<double> all = crowd_of<double>(crowd, dice);
        SweptPaths<double> paths;
        paths.begin(all, all.position_m, crowd.largest_ratio == 1.0, 1.0);
        const double low_m = crowd.from_m - 0.5 * crowd.room_m,
                     high_m = crowd.from_m + crowd.room_m;
        paths.look_out(0.0, {low_m, low_m, high_m, high_m});
        const auto is_inside = [&](const Vec2d& place_m) {
            return low_m <= place_m.minCoeff() && place_m.maxCoeff() <= high_m;
        };
        double now_s = 0.0;
        const auto at = [&](std::uint32_t body) -> Vec2d {
            return all.position_m[body] + all.velocity_mps[body] * now_s;
        };
        for (const BodyId id : all.ids) {
            const std::uint32_t body = id.index;
            now_s += 0.5 / static_cast<double>(crowd.balls);
            const Vec2d turned = dice.in_box(1.5 * crowd.speed_mps);
            all.position_m[body] += (all.velocity_mps[body] - turned) * now_s;
            all.velocity_mps[body] = turned;
            const SweptPaths<double>::Motion motion = {at(body), turned, all.radius_m[body], now_s};
            const auto course = paths.course_of(motion);
            const std::uint32_t opposite = (body + 1) % all.slots();
            SweptPaths<double>::Sight sight = {std::vector<std::uint32_t>(all.slots())};
            const bool sees = paths.see(body, opposite, motion, sight);
            if (sees && body % 2 == 0) {
                paths.follow(sight);
            } else {
                ASSERT_EQ(paths.follow(body, course), sees);
            }
            if (!sees) continue;
            (sight.keeps_inside ? insiders : outsiders) += 1;
            if (sight.keeps_inside) {
                EXPECT_TRUE(is_inside(at(body)) && is_inside(at(body) + turned * (1.0 - now_s)));
            }
            std::set<std::uint32_t> meeting, touching;
            paths.for_each_meeting(course, [&](std::uint32_t other) { meeting.insert(other); });
            paths.for_each_touching({at(body), all.radius_m[body], 0.0}, {}, now_s,
                                    [&](std::uint32_t other) { touching.insert(other); });
            sight.others.resize(sight.count);
            const std::set<std::uint32_t> seen(sight.others.begin(), sight.others.end());
            EXPECT_FALSE(seen.contains(body) || seen.contains(opposite));
            std::uint32_t touching_now = 1;  // itself
            for (const BodyId other_id : all.ids) {
                const std::uint32_t other = other_id.index;
                if (other == body || paths.is_stray(other)) continue;
                const Vec2d apart = at(body) - at(other);
                const double reach = all.radius_m[body] + all.radius_m[other];
                const double wait_s =
                    time_until_contact<double>(apart, turned - all.velocity_mps[other], reach);
                if (now_s + wait_s <= 1.0) {
                    EXPECT_TRUE(meeting.contains(other));
                    EXPECT_TRUE(seen.contains(other) || other == opposite);
                    ++meetings;
                }
                if (apart.norm() <= reach) {
                    EXPECT_TRUE(touching.contains(other));
                    ++touches;
                    ++touching_now;
                }
            }
            EXPECT_GE(sight.close, touching_now);
        }
    }
    EXPECT_GT(meetings, 500U);
    EXPECT_GT(touches, 500U);
    EXPECT_GT(insiders, 300U);
    EXPECT_GT(outsiders, 300U);
}

// A place is as coarse as the stray that asks is large.
TEST(SweptPaths, find_what_touches_a_stray_that_is_far_larger_than_all) {
    constexpr std::uint64_t kSeed = 65;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    constexpr double kPebbleM = 1e-4;
    for (const double planet_m : {1.0, 10.0, 100.0, 1e4}) {
        SCOPED_TRACE(planet_m);
        Bodies<double> all;
        for (int i = 0; i < 400; ++i) {
            const double x = 1e-3 * i;
            // On its surface, or just above.
            const double gap = i % 2 == 0 ? 0.0 : dice.of_any_size(1e-16, 1e-5) * planet_m;
            const double reach = planet_m + kPebbleM + gap;
            const double y = std::sqrt(reach * reach - x * x) - planet_m;
            all.add({x, y}, {0.0, 0.0}, kPebbleM, 1.0);
        }
        const std::uint32_t planet = all.add({0.0, -planet_m}, {0.0, 0.0}, planet_m, 1e9).index;
        SweptPaths<double> paths;
        paths.begin(all, all.position_m, false, 1.0 / 60.0);
        ASSERT_TRUE(paths.is_stray(planet));
        std::set<std::uint32_t> touching;
        paths.for_each_touching({all.position_m[planet], planet_m, 0.0}, {}, 0.0,
                                [&](std::uint32_t other) { touching.insert(other); });
        std::size_t wanted = 0;
        for (std::uint32_t other = 0; other < planet; ++other) {
            if (paths.is_stray(other)) continue;
            const double distance_m = (all.position_m[planet] - all.position_m[other]).norm();
            if (distance_m > planet_m + kPebbleM) continue;
            EXPECT_TRUE(touching.contains(other)) << other;
            ++wanted;
        }
        EXPECT_GT(wanted, 50U);
    }
}

// Where nothing is equal to the others, or can be held in numbers, everybody is a stray.
TEST(SweptPaths, leave_what_they_cannot_hold_to_others) {
    Bodies<double> all;
    all.add({0.0, 0.0}, {1.0, 0.0}, 1e-300, 1.0);
    all.add({1e300, 0.0}, {-1e300, 0.0}, 1e-300, 1.0);
    all.add({-1e300, 1e300}, {1.0, 0.0}, 1e-300, 1.0);
    SweptPaths<double> paths;
    paths.begin(all, all.position_m, true, 1.0);
    paths.for_each_pair([](std::uint32_t, std::uint32_t) {});
    for (const std::uint32_t stray : paths.strays()) EXPECT_TRUE(paths.is_stray(stray));
}

struct RowOfPaths {
    std::vector<float> x, y, ahead_x, ahead_y, radius;
    std::vector<std::uint32_t> body, first;
    PathLanes lanes = {};
};

// In rows of ten cells, of which paths start in the inner eight.
RowOfPaths rows_of_paths(std::uint32_t rows, bool equal_radii, Dice& dice) {
    constexpr std::uint32_t kWidth = 10;
    RowOfPaths all;
    for (std::uint32_t cell = 0; cell < kWidth * (rows + 1); ++cell) {
        all.first.push_back(static_cast<std::uint32_t>(all.x.size()));
        const std::uint32_t column = cell % kWidth, row = cell / kWidth;
        if (column == 0 || column == kWidth - 1 || row == rows) continue;
        const auto count = static_cast<int>(std::pow(dice.between(0.0, 3.3), 3.0));
        for (int i = 0; i < count; ++i) {
            const Vec2d place(column + dice.between(0.0, 0.999), row + dice.between(0.0, 0.999));
            const Vec2d ahead = place + dice.in_box(0.3);
            all.x.push_back(static_cast<float>(place.x()));
            all.y.push_back(static_cast<float>(place.y()));
            all.ahead_x.push_back(static_cast<float>(ahead.x()));
            all.ahead_y.push_back(static_cast<float>(ahead.y()));
            all.radius.push_back(static_cast<float>(dice.between(0.05, 0.2)));
        }
    }
    const auto paths = static_cast<std::uint32_t>(all.x.size());
    all.first.resize(all.first.size() + 2, paths);
    for (std::vector<float>* lane : {&all.x, &all.y, &all.ahead_x, &all.ahead_y, &all.radius}) {
        lane->resize(paths + kMostLanes, std::numeric_limits<float>::quiet_NaN());
    }
    all.lanes = {all.x.data(),      all.y.data(), all.ahead_x.data(), all.ahead_y.data(),
                 all.radius.data(), nullptr,      all.first.data(),   kWidth,
                 rows + 1,          paths};
    if (equal_radii) all.lanes.radius = nullptr;
    for (std::uint32_t path = 0; path < paths; ++path) all.body.push_back(3 * paths - path);
    all.lanes.body = all.body.data();
    return all;
}

using Found = std::vector<Pair>;

void find_all(const LaneKernels& kernels, const PathLanes& lanes, Found& all) {
    const PairSearch search = {0.9F, 1, lanes.radius ? 0.01F : 0.1F, most_found(lanes.paths, 1)};
    std::vector<FoundPairs> room(search.most_of_one + 3);
    for (PairCursor cursor; cursor.path < lanes.paths;) {
        const std::size_t count =
            kernels.find_pairs(lanes, search, cursor, room.data(), room.size());
        for (std::size_t i = 0; i < count; ++i) {
            for (std::uint32_t k = 0; k < kMostLanes; ++k) {
                if ((room[i].bits >> k & 1) != 0) {
                    all.push_back({room[i].path, room[i].first + k});
                }
            }
        }
    }
    std::vector<std::uint32_t> met(lanes.paths);
    const auto note = [&](std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) all.push_back({0, met[i]});
    };
    const CellWindow window = {2, 0, 6, 3}, everywhere = {0, 0, lanes.width - 1, lanes.height - 1};
    const PathSearch few = {4.4F, 1.7F, 4.5F, 1.9F, 0.1F, 0.2F, 0.5F};
    PathSearch many = few;
    many.limit = 9.0F;
    note(kernels.find_meeting(lanes, window, few, met.data()));
    note(kernels.find_meeting(lanes, everywhere, many, met.data()));
    for (const PathSearch& path_search : {few, many}) {
        constexpr float kCloseLimit = 2.0F;
        const std::size_t meeting = kernels.find_meeting(lanes, window, path_search, met.data());
        ASSERT_GT(meeting, 2U);
        const SightSearch sight_search = {path_search, kCloseLimit, met[1], met[2]};
        const Seen seen = kernels.see(lanes, window, sight_search, met.data());
        note(seen.count);
        EXPECT_EQ(seen.count, meeting - 2);
        EXPECT_EQ(lanes.body[seen.path], sight_search.self);
        const TouchSearch one = {
            {few.x, 0.0F}, {few.y, 0.0F}, {few.radius, 0.0F}, {kCloseLimit, -1.0F}, few.half_time};
        EXPECT_EQ(seen.close, kernels.find_touching(lanes, window, one, met.data()));
        EXPECT_GT(seen.close, 0U);
    }
    note(kernels.find_touching(
        lanes, window, {{4.1F, 4.6F}, {1.2F, 1.5F}, {0.1F, 0.2F}, {0.3F, 0.2F}, 0.3F}, met.data()));
    std::sort(all.begin(), all.end());
}

TEST(SweptLanes, find_the_same_on_every_instruction_set) {
    constexpr std::uint64_t kSeed = 64;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (const bool equal_radii : {true, false}) {
        for (std::uint32_t rows = 4; rows < 12; ++rows) {
            const RowOfPaths paths = rows_of_paths(rows, equal_radii, dice);
            Found plain;
            find_all(lane_kernels(SimdLevel::kPlain, equal_radii), paths.lanes, plain);
            EXPECT_GT(plain.size(), 100U);
            for (const SimdLevel level : {SimdLevel::kSse2, SimdLevel::kAvx2}) {
                if (!is_supported(level)) continue;
                Found found;
                find_all(lane_kernels(level, equal_radii), paths.lanes, found);
                EXPECT_EQ(found, plain) << "level " << static_cast<int>(level);
            }
        }
    }
}

}  // namespace
}  // namespace fts::physics
