#include "common/physics/slot_scatter.h"

#include <algorithm>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace fts::physics {
namespace {

template <typename Scalar>
constexpr Scalar kUntouched = Scalar(-1);

template <typename Scalar>
struct Places {
    RoomyVector<BodyId> id;
    RoomyVector<Scalar> x, y;
};

template <typename Scalar>
Places<Scalar> scattered(std::uint32_t slots, std::uint32_t count, std::mt19937& random) {
    Places<Scalar> places;
    for (std::uint32_t slot = 0; slot < slots; ++slot) places.id.push_back({slot, 0});
    std::shuffle(places.id.begin(), places.id.end(), random);
    places.id.resize(count);
    for (const BodyId id : places.id) {
        places.x.push_back(static_cast<Scalar>(id.index));
        places.y.push_back(static_cast<Scalar>(id.index) + Scalar(0.5));
    }
    return places;
}

template <typename Scalar>
void expect_all_at_their_slots(SlotScatter<Scalar>& scatter, const Places<Scalar>& places,
                               std::uint32_t slots) {
    RoomyVector<Vec2<Scalar>> to(slots, Vec2<Scalar>::Constant(kUntouched<Scalar>));
    scatter.write(places.id, places.x, places.y, to);
    std::size_t written = 0, wrong = 0;
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
        if (to[slot].x() == kUntouched<Scalar>) continue;
        ++written;
        const auto x = static_cast<Scalar>(slot);
        if (to[slot] != Vec2<Scalar>(x, x + Scalar(0.5))) ++wrong;
    }
    EXPECT_EQ(written, places.id.size());
    EXPECT_EQ(wrong, 0U);
}

template <typename Scalar>
class SlotScatterTest : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(SlotScatterTest, Scalars);

TYPED_TEST(SlotScatterTest, every_value_comes_to_its_slot_however_many_there_are) {
    using Scalar = TypeParam;
    constexpr std::uint32_t kSeed = 5;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    for (const std::uint32_t slots :
         {0U, 1U, 1000U, 790'001U, 1'048'576U, 1'048'577U, 2'097'152U, 2'097'153U}) {
        SCOPED_TRACE(slots);
        SlotScatter<Scalar> scatter;
        expect_all_at_their_slots(scatter, scattered<Scalar>(slots, slots, random), slots);
    }
}

TYPED_TEST(SlotScatterTest, vacant_slots_are_left_alone_and_a_new_order_is_followed) {
    using Scalar = TypeParam;
    constexpr std::uint32_t kSeed = 5;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    constexpr std::uint32_t kSlots = 1'600'000;
    SlotScatter<Scalar> scatter;
    for (const std::uint32_t count : {kSlots, kSlots - 7, kSlots}) {
        scatter.forget();
        expect_all_at_their_slots(scatter, scattered<Scalar>(kSlots, count, random), kSlots);
    }
}

}  // namespace
}  // namespace fts::physics
