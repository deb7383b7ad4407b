// What the discrete solver finds fast is what looking at every pair finds, at every width of vector
// instructions that this processor has.
#include "common/physics/near_list.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/physics/hit_order.h"
#include "common/physics/periodic.h"
#include "common/physics/solver_discrete.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

std::vector<SimdLevel> levels_of_this_processor() {
    std::vector<SimdLevel> levels;
    for (const SimdLevel level :
         {SimdLevel::kPlain, SimdLevel::kSse2, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
        if (is_supported(level)) levels.push_back(level);
    }
    return levels;
}

struct Kind {
    bool periodic, equal_radii, equal_masses;
};
constexpr Kind kKinds[] = {{false, true, true}, {false, false, false}, {false, true, false},
                           {true, true, true},  {true, false, true},   {true, false, false}};

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

template <typename Scalar>
struct Crowd {
    std::vector<Scalar> x_m, y_m, radius_m;
    Scalar largest_radius_m = Scalar(0);

    Discs<Scalar> discs() const { return {x_m, y_m, radius_m, largest_radius_m}; }
};

template <typename Scalar>
Crowd<Scalar> crowd_of(Dice& dice, std::size_t count, double half_width_m, bool equal_radii) {
    Crowd<Scalar> crowd;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2<Scalar> place_m = dice.in_box(half_width_m).cast<Scalar>();
        crowd.x_m.push_back(place_m.x());
        crowd.y_m.push_back(place_m.y());
        if (!equal_radii) crowd.radius_m.push_back(static_cast<Scalar>(dice.between(0.1, 0.5)));
    }
    crowd.largest_radius_m =
        equal_radii ? Scalar(0.5) : *std::max_element(crowd.radius_m.begin(), crowd.radius_m.end());
    return crowd;
}

template <typename Scalar>
Pairs pairs_by_looking_at_all(const Crowd<Scalar>& crowd,
                              const std::optional<typename Model<Scalar>::Box>& box) {
    Pairs pairs;
    const auto radius_of = [&](std::uint32_t i) {
        return crowd.radius_m.empty() ? crowd.largest_radius_m : crowd.radius_m[i];
    };
    const auto count = static_cast<std::uint32_t>(crowd.x_m.size());
    for (std::uint32_t a = 0; a < count; ++a) {
        for (std::uint32_t b = a + 1; b < count; ++b) {
            const Vec2<Scalar> line = nearest_image<Scalar>(
                {crowd.x_m[a] - crowd.x_m[b], crowd.y_m[a] - crowd.y_m[b]}, box);
            const Scalar reach = radius_of(a) + radius_of(b);
            if (line.x() * line.x() + line.y() * line.y() < reach * reach) pairs.emplace_back(a, b);
        }
    }
    return pairs;
}

Pairs in_order(const std::vector<DiscPair>& found) {
    Pairs pairs;
    for (const auto [a, b] : found) pairs.emplace_back(std::min(a, b), std::max(a, b));
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

template <typename Scalar>
class NearLists : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(NearLists, Scalars);

// A crowd whose discs are moved by dice.
template <typename Scalar>
struct Walk {
    Dice& dice;
    Crowd<Scalar>& crowd;
    std::optional<typename Model<Scalar>::Box> box = std::nullopt;
    std::uint32_t fast = 0;  // so many of the first go ten times as far

    Scalar displace(std::uint32_t disc, const Vec2d& by_m) {
        const Vec2<Scalar> before_m(crowd.x_m[disc], crowd.y_m[disc]);
        Vec2<Scalar> place_m = before_m + by_m.cast<Scalar>();
        const Scalar way_m = (place_m - before_m).norm();
        if (box) place_m = wrapped<Scalar>(place_m, *box);
        crowd.x_m[disc] = place_m.x();
        crowd.y_m[disc] = place_m.y();
        return way_m;
    }
    // True when the list was made anew.
    bool look(NearList<Scalar>& near, double step_m, std::vector<DiscPair>& found) {
        return near.move_and_find_overlaps(
            crowd.discs(),
            [&](std::uint32_t from, std::uint32_t to, Scalar usual_m, auto went_farther) {
                Scalar farthest_m = Scalar(0);
                for (std::uint32_t i = from; i < to; ++i) {
                    const Scalar way_m = displace(i, dice.in_box(i < fast ? 10 * step_m : step_m));
                    if (way_m > usual_m) went_farther(i, way_m);
                    farthest_m = std::max(farthest_m, way_m);
                }
                return farthest_m;
            },
            found);
    }
};

// Most looks are small steps, some are leaps, and single discs are moved by other hands.
template <typename Scalar>
void expect_what_looking_at_all_finds(SimdLevel level, const Kind& kind, std::uint64_t seed) {
    Dice dice(seed);
    const double half_width_m = dice.between(3.0, 12.0);
    Crowd<Scalar> crowd =
        crowd_of<Scalar>(dice, 20 + dice.below(120), half_width_m, kind.equal_radii);
    Walk<Scalar> walk = {dice, crowd};
    const Vec2<Scalar> corner = Vec2<Scalar>::Constant(static_cast<Scalar>(half_width_m));
    if (kind.periodic) walk.box = {-corner, corner};
    NearList<Scalar> near(level);
    near.fit(crowd.discs(), walk.box);
    std::vector<DiscPair> found;
    std::size_t overlaps = 0;
    int lists = 0;
    constexpr int kLooks = 60;
    for (int look = 0; look < kLooks; ++look) {
        const double step_m = look % 20 == 19 ? 2.0 : dice.between(0.01, 0.03);
        lists += walk.look(near, step_m, found) ? 1 : 0;
        ASSERT_EQ(in_order(found), pairs_by_looking_at_all(crowd, walk.box)) << "look " << look;
        overlaps += found.size();
        for (int k = 0; k < 3; ++k) {
            const auto disc = static_cast<std::uint32_t>(dice.below(crowd.x_m.size()));
            walk.displace(disc, dice.in_box(0.05));
            near.moved(disc, Scalar(0.08));
        }
    }
    EXPECT_GT(overlaps, 30U);
    EXPECT_LT(lists, kLooks) << "a list holds for more than a look";
}

TYPED_TEST(NearLists, find_what_looking_at_every_pair_finds) {
    for (const SimdLevel level : levels_of_this_processor()) {
        for (const Kind& kind : kKinds) {
            for (std::uint64_t seed = 1; seed <= 3; ++seed) {
                SCOPED_TRACE(testing::Message() << "level " << static_cast<int>(level) << " seed "
                                                << seed << " periodic " << kind.periodic);
                expect_what_looking_at_all_finds<TypeParam>(level, kind, seed);
                if (testing::Test::HasFailure()) return;
            }
        }
    }
}

// So many in one cell that a run is longer than any vector, and pairs more than discs.
TYPED_TEST(NearLists, find_every_pair_of_a_heap) {
    for (const SimdLevel level : levels_of_this_processor()) {
        Dice dice(5);
        auto crowd = crowd_of<TypeParam>(dice, 120, 0.2, true);
        NearList<TypeParam> near(level);
        near.fit(crowd.discs(), std::nullopt);
        std::vector<DiscPair> found;
        Walk<TypeParam>{dice, crowd}.look(near, 0.0, found);
        EXPECT_EQ(found.size(), 120U * 119U / 2U);
        EXPECT_EQ(in_order(found), pairs_by_looking_at_all(crowd, std::nullopt));
    }
}

struct FewFast {
    std::uint32_t fast;
    bool equal_radii;
    int most_lists;
};

// They hardly shorten the life of the list of all others while they are few, and are not lost when
// they are too many.
TYPED_TEST(NearLists, find_those_who_are_much_faster_than_all_others) {
    constexpr std::size_t kDiscs = 2'100;  // room for two astray
    constexpr int kLooks = 400, kLastLooks = 100;
    for (const auto& [fast, equal_radii, most_lists] :
         {FewFast{0, true, 16}, FewFast{1, true, 18}, FewFast{1, false, 18},
          FewFast{5, true, kLastLooks}}) {
        SCOPED_TRACE(testing::Message() << fast << " fast, equal radii " << equal_radii);
        Dice dice(7);
        auto crowd = crowd_of<TypeParam>(dice, kDiscs, 30.0, equal_radii);
        Walk<TypeParam> walk = {dice, crowd, std::nullopt, fast};
        NearList<TypeParam> near(best_simd_level());
        near.fit(crowd.discs(), std::nullopt);
        std::vector<DiscPair> found;
        std::size_t most_astray = 0;
        int late_lists = 0;
        for (int look = 0; look < kLooks; ++look) {
            const bool is_new = walk.look(near, 0.02, found);
            late_lists += is_new && look >= kLooks - kLastLooks ? 1 : 0;
            most_astray = std::max(most_astray, near.astray().size());
            if (look % 49 != 0) continue;
            Pairs pairs = in_order(found);
            pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
            ASSERT_EQ(pairs, pairs_by_looking_at_all(crowd, std::nullopt)) << "look " << look;
        }
        EXPECT_EQ(most_astray, 2U);
        EXPECT_LE(late_lists, most_lists);
    }
}

template <typename Scalar>
std::vector<Scalar> state_after_a_life(SimdLevel level, const Kind& kind, std::uint64_t seed) {
    Dice dice(seed);
    Bodies<Scalar> bodies;
    const std::size_t count = 60 + dice.below(240);
    const double half_width_m = dice.between(10.0, 16.0);
    for (std::size_t i = 0; i < count; ++i) {
        bodies.add(dice.in_box(half_width_m - 0.5).cast<Scalar>(),
                   dice.in_box(i == 0 ? 100.0 : 3.0).cast<Scalar>(),
                   static_cast<Scalar>(kind.equal_radii ? 0.4 : dice.between(0.1, 0.5)),
                   static_cast<Scalar>(kind.equal_masses ? 1.5 : dice.between(0.5, 2.0)));
    }
    Model<Scalar> model;
    model.equal_radii = kind.equal_radii;
    model.equal_masses = kind.equal_masses;
    const Vec2<Scalar> corner = Vec2<Scalar>::Constant(static_cast<Scalar>(half_width_m));
    (kind.periodic ? model.periodic : model.walls) = typename Model<Scalar>::Box{-corner, corner};
    const auto solver = make_discrete_solver<Scalar>(2, level);
    Record<Scalar> record;
    for (int tick = 0; tick < 200; ++tick) {
        solver->drift(bodies, model, static_cast<Scalar>(kTick), record);
    }
    solver->synchronise(bodies);
    EXPECT_GT(record.audit.ball_collisions, 100U);
    std::vector<Scalar> state;
    for (const BodyId id : bodies.ids) {
        const auto &place_m = bodies.position_m[id.index], &v_mps = bodies.velocity_mps[id.index];
        state.insert(state.end(), {place_m.x(), place_m.y(), v_mps.x(), v_mps.y()});
    }
    for (const Contact<Scalar>& contact : record.contacts) state.push_back(contact.impulse_ns);
    return state;
}

TYPED_TEST(NearLists, give_the_discrete_solver_the_same_bits_at_every_level) {
    for (const Kind& kind : kKinds) {
        for (std::uint64_t seed = 11; seed <= 13; ++seed) {
            SCOPED_TRACE(seed);
            const auto plain = state_after_a_life<TypeParam>(SimdLevel::kPlain, kind, seed);
            for (const SimdLevel level : levels_of_this_processor()) {
                ASSERT_EQ(state_after_a_life<TypeParam>(level, kind, seed), plain)
                    << "level " << static_cast<int>(level);
            }
        }
    }
}

TEST(SimdLevel, best_is_supported_and_so_is_what_is_below_it) {
    EXPECT_TRUE(is_supported(best_simd_level()));
    EXPECT_TRUE(is_supported(SimdLevel::kPlain));
    const auto levels = levels_of_this_processor();
    EXPECT_EQ(levels.back(), best_simd_level());
    EXPECT_EQ(levels.size(), static_cast<std::size_t>(levels.back()) + 1);
}

TEST(HitOrder, is_by_the_lower_slot_then_the_other_and_each_pair_once) {
    for (const std::uint32_t slots : {1U, 2U, 3U, 50U, 1000U, 4096U, 1'000'000U}) {
        for (const std::size_t pairs : {0U, 1U, 5U, 100U, 5000U}) {
            SCOPED_TRACE(testing::Message() << slots << " slots, " << pairs << " pairs");
            Dice dice(slots + pairs);
            std::vector<BodyPair> hits;
            Pairs expected;
            for (std::size_t k = 0; k < pairs; ++k) {
                const auto a = static_cast<std::uint32_t>(dice.below(slots));
                const auto b = static_cast<std::uint32_t>(dice.below(slots));
                hits.push_back({{a, a + 1}, {b, b + 2}, b + 7, a + 9});
                expected.emplace_back(a, b);
            }
            std::sort(expected.begin(), expected.end());
            expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
            HitOrder().sort(hits, slots);
            ASSERT_EQ(hits.size(), expected.size());
            for (std::size_t k = 0; k < hits.size(); ++k) {
                ASSERT_EQ(std::pair(hits[k].a.index, hits[k].b.index), expected[k]);
                ASSERT_EQ(hits[k].place_a, hits[k].b.index + 7);
                ASSERT_EQ(hits[k].place_b, hits[k].a.index + 9);
                ASSERT_EQ(hits[k].a.generation, hits[k].a.index + 1);
                ASSERT_EQ(hits[k].b.generation, hits[k].b.index + 2);
            }
        }
    }
}

// As a giant has that lands on a beach.
TEST(HitOrder, holds_where_one_body_touches_all_others) {
    constexpr std::uint32_t kGrains = 100'000;
    Dice dice(9);
    std::vector<BodyPair> hits;
    for (std::uint32_t grain = 1; grain <= kGrains; ++grain)
        hits.push_back({{0, 0}, {grain, 0}, 0, grain});
    for (std::size_t k = hits.size() - 1; k > 0; --k) std::swap(hits[k], hits[dice.below(k + 1)]);
    HitOrder().sort(hits, kGrains + 1);
    ASSERT_EQ(hits.size(), kGrains);
    for (std::uint32_t k = 0; k < kGrains; ++k) ASSERT_EQ(hits[k].b.index, k + 1);
}

}  // namespace
}  // namespace fts::physics
