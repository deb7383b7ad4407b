// Paths of a crowd leave nobody out who meets, or touches; on any instruction set.
#include "common/physics/flight_paths.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/physics/time_of_impact.h"
#include "tests/physics/dice.h"

namespace fts::physics {
namespace {

struct CrowdOfFlights {
    std::uint32_t flights = 500;
    double room_m = 12.0;
    double speed_mps = 1.0;
    double largest_ratio = 1.0;  // of radii
    double heaped = 0.0;         // this part is in one place, in each other
    double far = 0.0;            // this part is far away, fast or large
    double from_m = 0.0;         // where the origin is
};

constexpr CrowdOfFlights kCrowdsOfFlights[] = {
    {},
    {.flights = 300, .room_m = 100.0},
    {.flights = 300, .room_m = 1e5, .speed_mps = 1e3},
    {.room_m = 4.0},
    {.heaped = 0.4},
    {.largest_ratio = 3.0},
    {.largest_ratio = 3.0, .heaped = 0.4},
    {.room_m = 30.0, .largest_ratio = 30.0, .far = 0.05},
    {.far = 0.1},
    {.speed_mps = 0.0},
    {.from_m = 1e3},
    {.flights = 20, .room_m = 2.0},
    {.flights = 1, .room_m = 2.0},
};

template <typename Scalar>
class SeenByPaths {
  public:
    using Vec = Vec2<Scalar>;

    SeenByPaths(const CrowdOfFlights& crowd, double now_s, Dice& dice)
        : equal_radii_(crowd.largest_ratio == 1.0), now_s_(now_s) {
        for (std::uint32_t i = 0; i < crowd.flights; ++i) {
            Vec2d place = Vec2d::Constant(crowd.from_m) + dice.in_box(crowd.room_m);
            double speed = crowd.speed_mps;
            double radius = 0.25 * std::pow(crowd.largest_ratio, dice.between(0.0, 1.0));
            const double lot = dice.between(0.0, 1.0);
            if (lot < crowd.heaped) place = Vec2d::Constant(crowd.from_m) + dice.in_box(0.7);
            if (lot > 1.0 - crowd.far) {
                if (i % 3 == 0) place += dice.in_box(1e4);
                if (i % 3 == 1) speed *= 50.0;
                if (i % 3 == 2 && !equal_radii_) radius *= 10.0;
            }
            physics::Flight<Scalar> flight;
            flight.since_s = now_s - dice.between(0.0, 0.1);
            flight.velocity_mps = dice.in_box(speed).cast<Scalar>();
            flight.position_m = place.cast<Scalar>();
            flight.radius_m = static_cast<Scalar>(radius);
            flights_.push_back(flight);
        }
        living_.resize(flights_.size());
        std::iota(living_.begin(), living_.end(), 0U);
        std::erase_if(living_, [&](std::uint32_t i) { return living_.size() > 9 && i % 11 == 3; });
        paths_.fit(flights_, living_, now_s, std::nullopt, equal_radii_);
        begin_window();
    }

    void begin_window() {
        paths_.begin(flights_, living_, now_s_);
        until_s_ = now_s_ + paths_.window_s();
    }
    FlightPaths<Scalar>& paths() { return paths_; }
    std::span<const std::uint32_t> living() const { return living_; }
    double now_s() const { return now_s_; }
    double until_s() const { return until_s_; }
    void go_on(double part) { now_s_ = std::min(until_s_, now_s_ + part * paths_.window_s()); }
    void remove(std::uint32_t body) {
        paths_.remove(body);
        std::erase(living_, body);
    }
    bool turn(std::uint32_t body, const Vec2d& velocity_mps) {
        physics::Flight<Scalar>& flight = flights_[body];
        flight.position_m = flight.position_at(now_s_);
        flight.since_s = now_s_;
        flight.velocity_mps = velocity_mps.cast<Scalar>();
        return paths_.follow(body, flight, now_s_);
    }

    Vec2d place_of(std::uint32_t body, double time_s) const {
        const physics::Flight<Scalar>& flight = flights_[body];
        return flight.position_m.template cast<double>() +
               velocity_of(body) * (time_s - flight.since_s);
    }
    Vec2d velocity_of(std::uint32_t body) const {
        return flights_[body].velocity_mps.template cast<double>();
    }
    double radius_of(std::uint32_t body) const {
        return static_cast<double>(flights_[body].radius_m);
    }
    // From now on.
    bool meet_in_the_window(std::uint32_t a, std::uint32_t b) const {
        const double wait_s = time_until_contact<double>(place_of(a, now_s_) - place_of(b, now_s_),
                                                         velocity_of(a) - velocity_of(b),
                                                         radius_of(a) + radius_of(b));
        return now_s_ + wait_s <= until_s_;
    }
    bool are_close(std::uint32_t a, std::uint32_t b, double factor) const {
        return (place_of(a, now_s_) - place_of(b, now_s_)).norm() <
               factor * (radius_of(a) + radius_of(b));
    }
    bool comes_within(std::uint32_t body, const Vec2d& low_m, const Vec2d& high_m) const {
        constexpr int kMoments = 8;
        for (int i = 0; i <= kMoments; ++i) {
            const Vec2d place = place_of(body, now_s_ + (until_s_ - now_s_) * i / kMoments);
            const Vec2d nearest = place.cwiseMax(low_m).cwiseMin(high_m);
            if ((place - nearest).norm() <= radius_of(body)) return true;
        }
        return false;
    }

    // Returns how many of those that are expected.
    template <typename Search, typename Expected>
    std::size_t expect_all_found(std::uint32_t body, Search&& search, Expected&& expected) const {
        std::set<std::uint32_t> found;
        search([&](std::uint32_t other) {
            EXPECT_TRUE(found.insert(other).second) << other << " is found twice";
        });
        std::size_t count = 0;
        for (const std::uint32_t other : living_) {
            if (other == body || paths_.is_stray(other) || !expected(other)) continue;
            EXPECT_TRUE(found.contains(other)) << body << " and " << other;
            ++count;
        }
        for (const std::uint32_t other : found) EXPECT_FALSE(paths_.is_stray(other)) << other;
        return count;
    }

  private:
    bool equal_radii_;
    double now_s_, until_s_ = 0.0;
    RoomyVector<physics::Flight<Scalar>> flights_;
    std::vector<std::uint32_t> living_;
    FlightPaths<Scalar> paths_;
};

template <typename Scalar>
class FlightPathsOf : public testing::Test {};
using ScalarsOfPaths = testing::Types<double, float>;
TYPED_TEST_SUITE(FlightPathsOf, ScalarsOfPaths);

TYPED_TEST(FlightPathsOf, any_crowd_find_every_pair_that_meets_in_the_window_once) {
    constexpr std::uint64_t kSeed = 551;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    std::size_t meetings = 0, strays = 0;
    for (const CrowdOfFlights& crowd : kCrowdsOfFlights) {
        SCOPED_TRACE(&crowd - kCrowdsOfFlights);
        for (int trial = 0; trial < 4; ++trial) {
            SeenByPaths<TypeParam> seen(crowd, trial * 0.75, dice);
            std::set<std::pair<std::uint32_t, std::uint32_t>> found;
            seen.paths().for_each_pair([&](std::uint32_t a, std::uint32_t b) {
                EXPECT_NE(a, b);
                EXPECT_TRUE(found.insert(std::minmax(a, b)).second) << "found twice";
            });
            for (const std::uint32_t a : seen.living()) {
                if (seen.paths().is_stray(a)) ++strays;
                for (const std::uint32_t b : seen.living()) {
                    if (b <= a || seen.paths().is_stray(a) || seen.paths().is_stray(b)) continue;
                    if (!seen.meet_in_the_window(a, b)) continue;
                    EXPECT_TRUE(found.contains({a, b})) << a << " and " << b;
                    ++meetings;
                }
            }
        }
        if (this->HasFailure()) return;
    }
    EXPECT_GT(meetings, 5000U);
    EXPECT_GT(strays, 50U);
}

TYPED_TEST(FlightPathsOf, any_crowd_find_whom_one_meets_or_touches_after_any_turns) {
    constexpr std::uint64_t kSeed = 552;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    std::size_t meetings = 0, close = 0, within = 0, turned = 0;
    std::size_t seen_meetings = 0, seen_close = 0;
    for (const CrowdOfFlights& crowd : kCrowdsOfFlights) {
        SCOPED_TRACE(&crowd - kCrowdsOfFlights);
        SeenByPaths<TypeParam> seen(crowd, 2.5, dice);
        FlightPaths<TypeParam>& paths = seen.paths();
        const int turns = static_cast<int>(seen.living().size());
        for (int i = 0; i < turns; ++i) {
            seen.go_on(1.0 / turns);
            const std::uint32_t body = seen.living()[dice.below(seen.living().size())];
            if (i % 20 == 19) {
                seen.remove(body);
                continue;
            }
            const double factor = i % 2 == 0 ? 1.0 : 1.02;
            typename FlightPaths<TypeParam>::Sight sight;
            if (i % 3 != 0 && !paths.is_stray(body)) {
                const Vec2d velocity = dice.in_box((i % 7 == 0 ? 4.0 : 1.0) * crowd.speed_mps);
                const Vec2d place = seen.place_of(body, seen.now_s());
                sight = paths.see({body, place.cast<TypeParam>(), velocity.cast<TypeParam>()},
                                  seen.now_s(), static_cast<TypeParam>(factor));
                const bool stays = seen.turn(body, velocity);
                EXPECT_EQ(stays, !paths.is_stray(body));
                EXPECT_EQ(stays, sight.is_one);
                turned += stays ? 1 : 0;
            }
            const Vec2d corner = seen.place_of(body, seen.now_s()) + dice.in_box(1.0);
            const Vec2d high = corner + Vec2d(dice.between(0.0, 2.0), dice.between(0.0, 2.0));
            within += seen.expect_all_found(
                body,
                [&](auto&& visit) {
                    paths.for_each_within({corner.cast<TypeParam>(), high.cast<TypeParam>()},
                                          visit);
                },
                [&](std::uint32_t other) { return seen.comes_within(other, corner, high); });
            if (paths.is_stray(body)) continue;
            meetings += seen.expect_all_found(
                body, [&](auto&& visit) { paths.for_each_meeting(body, seen.now_s(), visit); },
                [&](std::uint32_t other) { return seen.meet_in_the_window(body, other); });
            close += seen.expect_all_found(
                body,
                [&](auto&& visit) {
                    paths.for_each_close(body, seen.now_s(), static_cast<TypeParam>(factor), visit);
                },
                [&](std::uint32_t other) { return seen.are_close(body, other, factor); });
            if (sight.is_one) {
                seen_meetings += seen.expect_all_found(
                    body, [&](auto&& visit) { paths.for_each_meeting(sight, visit); },
                    [&](std::uint32_t other) { return seen.meet_in_the_window(body, other); });
                seen_close += seen.expect_all_found(
                    body, [&](auto&& visit) { paths.for_each_close(sight, visit); },
                    [&](std::uint32_t other) { return seen.are_close(body, other, factor); });
            }
            if (this->HasFailure()) return;
        }
    }
    EXPECT_GT(turned, 500U);
    EXPECT_GT(meetings, 2000U);
    EXPECT_GT(close, 2000U);
    EXPECT_GT(within, 2000U);
    EXPECT_GT(seen_meetings, 1000U);
    EXPECT_GT(seen_close, 1000U);
}

TYPED_TEST(FlightPathsOf, the_next_windows_of_a_fit_are_as_good_as_its_first) {
    constexpr std::uint64_t kSeed = 553;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    std::size_t meetings = 0;
    SeenByPaths<TypeParam> seen({.room_m = 8.0, .largest_ratio = 2.0}, 1.0, dice);
    for (int window = 0; window < 12; ++window) {
        for (int i = 0; i < 100; ++i) {
            seen.go_on(0.01);
            const std::uint32_t body = seen.living()[dice.below(seen.living().size())];
            seen.turn(body, dice.in_box(1.0));
            if (i % 8 != 0 || seen.paths().is_stray(body)) continue;
            meetings += seen.expect_all_found(
                body,
                [&](auto&& visit) { seen.paths().for_each_meeting(body, seen.now_s(), visit); },
                [&](std::uint32_t other) { return seen.meet_in_the_window(body, other); });
        }
        seen.begin_window();
    }
    EXPECT_GT(meetings, 100U);
}

// Paths in cells at random, some rows of cells long and some empty, with what is no number among
// them.
struct PathsByCell {
    std::uint32_t width = 9, height = 8;
    std::vector<FlightPath> paths;
    std::vector<float> radii;
    std::vector<WhosePath> whose;
    std::vector<std::uint32_t> first;

    explicit PathsByCell(Dice& dice) {
        const auto number = [&](double low, double high) {
            return static_cast<float>(dice.between(low, high));
        };
        for (std::uint32_t cell = 0; cell < width * height; ++cell) {
            first.push_back(static_cast<std::uint32_t>(paths.size()));
            const std::uint32_t x = cell % width, y = cell / width;
            if (x == 0 || y == 0 || x + 1 == width || y + 1 == height) continue;
            std::uint64_t count = dice.below(5);
            if (dice.below(9) == 0) count += 15;
            for (; count > 0; --count) {
                FlightPath path{static_cast<float>(x) + number(0.0, 1.0),
                                static_cast<float>(y) + number(0.0, 1.0), number(-0.4, 0.4),
                                number(-0.4, 0.4)};
                if (dice.below(12) == 0) path.x = std::numeric_limits<float>::quiet_NaN();
                if (dice.below(40) == 0) path.way_y = std::numeric_limits<float>::quiet_NaN();
                if (dice.below(40) == 0) path.y = std::numeric_limits<float>::infinity();
                whose.push_back({static_cast<std::uint32_t>(paths.size()), cell});
                paths.push_back(path);
                radii.push_back(number(0.05, 0.4));
            }
        }
        first.resize(first.size() + 2, static_cast<std::uint32_t>(paths.size()));
        paths.resize(paths.size() + kPathsAtOnce,
                     FlightPath{std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 0.0F});
        radii.resize(radii.size() + kPathsAtOnce, 0.0F);
    }
    AllPaths seen(bool equal_radii) const {
        return {paths.data(), equal_radii ? nullptr : radii.data(),     whose.data(),
                first.data(), static_cast<std::uint32_t>(whose.size()), width};
    }
};

PathTest test_of(const FlightPath& self, float from, float to, float limit, float radius) {
    PathTest test{};
    test.self = self;
    test.from = from;
    test.to = to;
    test.limit = limit;
    test.radius = radius;
    test.close_limit = 1.5F * limit;
    return test;
}

TEST(PathKernels, find_the_same_on_every_level) {
    constexpr std::uint64_t kSeed = 554;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    std::size_t found_in_all = 0, close_in_all = 0, long_rows = 0;
    for (int trial = 0; trial < 60; ++trial) {
        SCOPED_TRACE(trial);
        const PathsByCell cells(dice);
        const bool equal_radii = trial % 2 == 0;
        const AllPaths all = cells.seen(equal_radii);
        const PathKernels& plain = path_kernels(SimdLevel::kPlain, equal_radii);
        const float limit = equal_radii ? 0.2F : 0.01F;
        std::vector<PathPartners> expected(all.count), seen(all.count);
        const PathTest of_pairs = test_of({}, 0.0F, 2.0F, limit, 0.0F);
        const std::size_t pairs = plain.find_pairs(all, of_pairs, expected.data());
        EXPECT_GT(pairs, 0U);
        for (const SimdLevel level : {SimdLevel::kSse2, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
            if (!is_supported(level)) continue;
            const PathKernels& kernels = path_kernels(level, equal_radii);
            ASSERT_EQ(kernels.find_pairs(all, of_pairs, seen.data()), pairs);
            for (std::size_t i = 0; i < pairs; ++i) {
                ASSERT_EQ(seen[i].path, expected[i].path);
                ASSERT_EQ(seen[i].bits, expected[i].bits);
            }
            for (std::uint32_t i = 0; i < all.count; ++i) {
                const auto part = static_cast<float>(dice.between(0.0, 1.0));
                const PathTest test = test_of(all.path[i], part, i % 3 == 0 ? part : 2.0F - part,
                                              limit, equal_radii ? 0.0F : all.radius[i]);
                const std::uint32_t cell = all.whose[i].cell;
                const std::uint32_t bits = plain.find_about(all, cell, test);
                ASSERT_EQ(kernels.find_about(all, cell, test), bits);
                const PathSight expected_sight = plain.see_about(all, cell, test);
                ASSERT_EQ(expected_sight.meeting, bits);
                PathTest of_close = test;
                of_close.to = test.from;
                of_close.limit = test.close_limit;
                ASSERT_EQ(expected_sight.close, plain.find_about(all, cell, of_close));
                const PathSight sight = kernels.see_about(all, cell, test);
                ASSERT_EQ(sight.meeting, expected_sight.meeting);
                ASSERT_EQ(sight.close, expected_sight.close);
                close_in_all += static_cast<std::size_t>(std::popcount(sight.close & ~kHasLongRow));
                found_in_all += static_cast<std::size_t>(std::popcount(bits & ~kHasLongRow));
                long_rows += bits >> 31;
                for (PathRow row : all.rows_about(cell)) {
                    for (; row.first < row.end; ++row.first) {
                        ASSERT_EQ(kernels.find(all, row, test), plain.find(all, row, test));
                    }
                }
            }
        }
    }
    if (is_supported(SimdLevel::kSse2)) {
        EXPECT_GT(found_in_all, 1000U);
        EXPECT_GT(close_in_all, 1000U);
        EXPECT_GT(long_rows, 1000U);
    }
}

TEST(PathKernels, find_just_those_whose_product_of_distances_is_small_enough) {
    constexpr std::uint64_t kSeed = 555;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const PathsByCell cells(dice);
    const AllPaths all = cells.seen(false);
    const PathKernels& kernels = path_kernels(best_simd_level(), false);
    std::size_t found = 0;
    for (std::uint32_t i = 0; i < all.count; ++i) {
        const PathTest test = test_of(all.path[i], 0.25F, 1.75F, 0.02F, all.radius[i]);
        for (PathRow row : all.rows_about(all.whose[i].cell)) {
            for (; row.first < row.end; ++row.first) {
                const FlightPath& other = all.path[row.first];
                const double x = static_cast<double>(other.x) - static_cast<double>(test.self.x);
                const double y = static_cast<double>(other.y) - static_cast<double>(test.self.y);
                const double way_x =
                    static_cast<double>(other.way_x) - static_cast<double>(test.self.way_x);
                const double way_y =
                    static_cast<double>(other.way_y) - static_cast<double>(test.self.way_y);
                const double reach = static_cast<double>(all.radius[row.first] + test.radius);
                const double more = (x + 0.25 * way_x) * (x + 1.75 * way_x) +
                                    (y + 0.25 * way_y) * (y + 1.75 * way_y) - 0.02 - reach * reach;
                if (std::abs(more) < 1e-5) continue;
                const bool is_found = (kernels.find(all, row, test) & 1U) != 0;
                ASSERT_EQ(is_found, more < 0.0);
                found += is_found ? 1 : 0;
            }
        }
    }
    EXPECT_GT(found, 100U);
}

}  // namespace
}  // namespace fts::physics
