#include "common/physics/slot_scatter.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace fts::physics {
namespace {

constexpr double kUntouched = -1.0;

struct Places {
    RoomyVector<std::uint32_t> slot;
    RoomyVector<double> x, y;
};

Places scattered(std::uint32_t slots, std::uint32_t count, std::mt19937& random) {
    Places places;
    places.slot.resize(slots);
    std::iota(places.slot.begin(), places.slot.end(), 0U);
    std::shuffle(places.slot.begin(), places.slot.end(), random);
    places.slot.resize(count);
    for (const std::uint32_t slot : places.slot) {
        places.x.push_back(slot);
        places.y.push_back(slot + 0.5);
    }
    return places;
}

void expect_all_at_their_slots(SlotScatter<double>& scatter, const Places& places,
                               std::uint32_t slots) {
    RoomyVector<Vec2<double>> to(slots, {kUntouched, kUntouched});
    scatter.write(places.slot, places.x, places.y, to);
    std::size_t written = 0, wrong = 0;
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
        if (to[slot].x() == kUntouched) continue;
        ++written;
        if (to[slot] != Vec2<double>(slot, slot + 0.5)) ++wrong;
    }
    EXPECT_EQ(written, places.slot.size());
    EXPECT_EQ(wrong, 0U);
}

TEST(SlotScatter, every_value_comes_to_its_slot_however_many_there_are) {
    constexpr std::uint32_t kSeed = 5;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    for (const std::uint32_t slots : {0U, 1U, 1000U, 790'001U, 1'048'576U, 1'048'577U}) {
        SCOPED_TRACE(slots);
        SlotScatter<double> scatter;
        expect_all_at_their_slots(scatter, scattered(slots, slots, random), slots);
    }
}

TEST(SlotScatter, vacant_slots_are_left_alone_and_a_new_order_is_followed) {
    constexpr std::uint32_t kSeed = 5;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    constexpr std::uint32_t kSlots = 800'000;
    SlotScatter<double> scatter;
    for (const std::uint32_t count : {kSlots, kSlots - 7, kSlots}) {
        scatter.forget();
        expect_all_at_their_slots(scatter, scattered(kSlots, count, random), kSlots);
    }
}

}  // namespace
}  // namespace fts::physics
