// The swept solver's broad phase: rejects no pair that touches, on any instruction set.
#include "common/physics/swept_paths.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/physics/swept_start.h"
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

// Bodies that turn at different times of a span, as after collisions.
class TurningCrowd {
  public:
    TurningCrowd(const Crowd& crowd, Dice& dice)
        : all(crowd_of<double>(crowd, dice)), speed_mps_(1.5 * crowd.speed_mps), dice_(dice) {
        paths.begin(all, all.position_m, crowd.largest_ratio == 1.0, 1.0);
    }
    Vec2d at(std::uint32_t body) const {
        return all.position_m[body] + all.velocity_mps[body] * now_s;
    }
    SweptPaths<double>::Motion turn(std::uint32_t body) {
        const Vec2d turned = dice_.in_box(speed_mps_);
        all.position_m[body] += (all.velocity_mps[body] - turned) * now_s;
        all.velocity_mps[body] = turned;
        return {at(body), turned, all.radius_m[body], now_s};
    }
    double gap_m(std::uint32_t a, std::uint32_t b) const {
        return (at(a) - at(b)).norm() - (all.radius_m[a] + all.radius_m[b]);
    }
    bool meet(std::uint32_t a, std::uint32_t b) const {
        const double reach = all.radius_m[a] + all.radius_m[b];
        return now_s + time_until_contact<double>(
                           at(a) - at(b), all.velocity_mps[a] - all.velocity_mps[b], reach) <=
               1.0;
    }
    // visit(other) for all that are no strays.
    template <typename Visit>
    void for_each_other(std::uint32_t body, Visit&& visit) const {
        for (const BodyId id : all.ids) {
            if (id.index != body && !paths.is_stray(id.index)) visit(id.index);
        }
    }

    Bodies<double> all;
    SweptPaths<double> paths;
    double now_s = 0.0;

  private:
    double speed_mps_;
    Dice& dice_;
};

TEST(SweptPaths, find_who_meets_and_who_touches_a_body_that_turned) {
    constexpr std::uint64_t kSeed = 63;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    std::size_t meetings = 0, touches = 0;
    for (const Crowd& crowd : kCrowds) {
        SCOPED_TRACE(&crowd - kCrowds);
        TurningCrowd turning(crowd, dice);
        for (const BodyId id : turning.all.ids) {
            const std::uint32_t body = id.index;
            turning.now_s += 0.5 / static_cast<double>(crowd.balls);
            SweptPaths<double>& paths = turning.paths;
            const auto motion = turning.turn(body);
            const auto course = paths.course_of(motion);
            if (!paths.follow(body, course)) continue;
            std::set<std::uint32_t> meeting, touching;
            paths.for_each_meeting(course, [&](std::uint32_t other) { meeting.insert(other); });
            paths.for_each_touching({motion.position_m, motion.radius_m, 0.0}, {}, motion.since_s,
                                    [&](std::uint32_t other) { touching.insert(other); });
            turning.for_each_other(body, [&](std::uint32_t other) {
                if (turning.meet(body, other)) {
                    EXPECT_TRUE(meeting.contains(other));
                    ++meetings;
                }
                if (turning.gap_m(body, other) <= 0.0) {
                    EXPECT_TRUE(touching.contains(other));
                    ++touches;
                }
            });
        }
    }
    EXPECT_GT(meetings, 500U);
    EXPECT_GT(touches, 500U);
}

TEST(SweptPaths, show_two_that_hit_whom_they_meet_then_and_whether_they_are_alone) {
    constexpr std::uint64_t kSeed = 66;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    std::size_t meetings = 0, alone = 0, together = 0, inside = 0, outside = 0;
    for (const Crowd& crowd : kCrowds) {
        SCOPED_TRACE(&crowd - kCrowds);
        TurningCrowd turning(crowd, dice);
        SweptPaths<double>& paths = turning.paths;
        const double low_m = crowd.from_m - 0.5 * crowd.room_m;
        const double high_m = crowd.from_m + crowd.room_m;
        const auto is_inside = [&](const Vec2d& place_m) {
            return low_m <= place_m.minCoeff() && place_m.maxCoeff() <= high_m;
        };
        paths.begin_sights(0.0, {low_m, low_m, high_m, high_m});
        SweptPaths<double>::Sight sight = {std::vector<Meeting>(2 * turning.all.slots())};
        for (const BodyId id : turning.all.ids) {
            turning.now_s += 0.5 / static_cast<double>(crowd.balls);
            const std::uint32_t a = id.index;
            std::uint32_t b = a == 0 ? 1 : 0;  // or whoever is nearest
            turning.for_each_other(a, [&](std::uint32_t other) {
                if (turning.gap_m(a, other) < turning.gap_m(a, b)) b = other;
            });
            const SweptPaths<double>::Motion motions[2] = {turning.turn(a), turning.turn(b)};
            const bool see = paths.see({a, b}, motions, sight);
            if (see && dice.below(2) == 0) {
                paths.follow(sight);
            } else {
                const bool a_stays = paths.follow(a, paths.course_of(motions[0]));
                const bool b_stays = paths.follow(b, paths.course_of(motions[1]));
                ASSERT_EQ(see, a_stays && b_stays);
            }
            if (!see) continue;
            std::set<Pair> seen;
            for (std::size_t i = 0; i < sight.count; ++i) {
                const auto [one, other] = sight.meetings[i];
                EXPECT_TRUE(one == a || one == b);
                EXPECT_TRUE(other != a && other != b);
                EXPECT_TRUE(seen.insert({one, other}).second) << "seen twice";
            }
            bool are_touched = false;
            for (const std::uint32_t one : {a, b}) {
                turning.for_each_other(one, [&](std::uint32_t other) {
                    if (other == a || other == b) return;
                    are_touched |= turning.gap_m(one, other) <= 0.0;
                    if (!turning.meet(one, other)) return;
                    EXPECT_TRUE(seen.contains({one, other}));
                    ++meetings;
                });
                const Vec2d way_m = turning.all.velocity_mps[one] * (1.0 - turning.now_s);
                if (!sight.keep_inside) continue;
                EXPECT_TRUE(is_inside(turning.at(one)) && is_inside(turning.at(one) + way_m));
            }
            EXPECT_FALSE(sight.are_alone && are_touched);
            if (turning.gap_m(a, b) <= 0.0) ++(sight.are_alone ? alone : together);
            ++(sight.keep_inside ? inside : outside);
        }
    }
    EXPECT_GT(meetings, 500U);
    EXPECT_GT(alone, 200U);
    EXPECT_GT(together, 200U);
    EXPECT_GT(inside, 200U);
    EXPECT_GT(outside, 200U);
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

template <typename Scalar>
void expect_same_starts(std::uint64_t seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    const StartRules<Scalar> rules = {
        {Scalar(-3), Scalar(5)},    Scalar(0.7), Scalar(0.3), {2.0F, 2.0F, -1.0F, -1.0F},
        {30.0F, 20.0F, 1.0F, 1.0F}, 34};
    const Scalar odd[] = {std::numeric_limits<Scalar>::quiet_NaN(),
                          std::numeric_limits<Scalar>::infinity(), Scalar(-1e30), Scalar(-0.0),
                          std::numeric_limits<Scalar>::denorm_min()};
    const auto within = [&](double half_width) -> Vec2<Scalar> {
        Vec2<Scalar> both = dice.in_box(half_width).template cast<Scalar>();
        if (dice.below(20) == 0) both[static_cast<int>(dice.below(2))] = odd[dice.below(5)];
        return both;
    };
    std::size_t found = 0, refused = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Vec2<Scalar> place = within(40.0), velocity = within(3.5);
        PathStart plain = {}, quick = {};
        const bool is_plain = find_start_plainly(rules, place, velocity, plain);
        ASSERT_EQ(find_start(rules, place, velocity, quick), is_plain);
        ++(is_plain ? found : refused);
        if (!is_plain) continue;
        EXPECT_EQ(quick.cell, plain.cell);
        for (const auto part : {&PathStart::x, &PathStart::y, &PathStart::way_x, &PathStart::way_y})
            EXPECT_EQ(std::bit_cast<std::uint32_t>(quick.*part),
                      std::bit_cast<std::uint32_t>(plain.*part));
    }
    EXPECT_GT(found, 1000U);
    EXPECT_GT(refused, 1000U);
}

TEST(SweptPaths, start_at_the_same_bits_with_and_without_vector_instructions) {
    expect_same_starts<double>(67);
    expect_same_starts<float>(68);
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
            const double x = column + dice.between(0.0, 0.999);
            const Vec2d place(x, row + dice.between(0.0, 0.999));
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
    std::vector<Meeting> meetings(2 * lanes.paths);
    for (const PathSearch& search_a : {few, many}) {
        constexpr float kCloseLimit = 2.0F;
        PathSearch search_b = search_a;
        search_b.x += 0.2F;
        search_b.ahead_y += 0.1F;
        // Two that are found by both searches.
        std::vector<std::uint32_t> of_a(lanes.paths), of_b(lanes.paths), of_both;
        of_a.resize(kernels.find_meeting(lanes, window, search_a, of_a.data()));
        of_b.resize(kernels.find_meeting(lanes, window, search_b, of_b.data()));
        for (const std::uint32_t body : of_a) {
            if (std::find(of_b.begin(), of_b.end(), body) != of_b.end()) of_both.push_back(body);
        }
        ASSERT_GE(of_both.size(), 2U);
        const SightSearch both = {
            {of_both.front(), of_both.back()}, {search_a, search_b}, kCloseLimit};
        const Seen seen = kernels.see(lanes, window, both, meetings.data());
        std::vector<std::size_t> found(2);
        for (std::size_t i = 0; i < seen.count; ++i) {
            const auto [one, other] = meetings[i];
            all.push_back({one, other});
            ++found[one == both.bodies[0] ? 0 : 1];
        }
        for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
            const PathSearch& search_k = both.paths[k];
            EXPECT_EQ(found[k] + 2, kernels.find_meeting(lanes, window, search_k, met.data()));
            EXPECT_EQ(lanes.body[seen.paths[k]], both.bodies[k]);
            const TouchSearch one = {{search_k.x, 0.0F},
                                     {search_k.y, 0.0F},
                                     {search_k.radius, 0.0F},
                                     {kCloseLimit, -1.0F},
                                     search_k.half_time};
            EXPECT_EQ(seen.close[k], kernels.find_touching(lanes, window, one, met.data()));
            EXPECT_GT(seen.close[k], 0U);
        }
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
