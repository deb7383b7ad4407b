#include "common/net/simulated_link.h"

#include <gtest/gtest.h>

#include "tests/net/memory_network.h"

namespace fts::net {
namespace {

const Address kHere = address_of(1);
const Address kThere = address_of(2);

struct Arrival {
    double at_s;
    std::size_t number;
};

// Sends `count` numbered datagrams at 0 s and notes what comes out at the other end, and when.
std::vector<Arrival> arrivals(const LinkConditions& conditions, std::size_t count) {
    MemoryNetwork network;
    SimulatedLink link(std::make_unique<MemoryTransport>(network, kHere), conditions);
    MemoryTransport far(network, kThere);
    std::vector<Arrival> result;
    for (std::size_t i = 0; i < count; ++i) {
        link.send(kThere, std::vector<std::uint8_t>{static_cast<std::uint8_t>(i % 256),
                                                    static_cast<std::uint8_t>(i / 256)});
    }
    for (double now_s = 0.0; now_s < 1.0; now_s += 0.001) {
        link.poll(now_s, [](const Address&, std::span<const std::uint8_t>) {});
        far.poll(now_s, [&](const Address&, std::span<const std::uint8_t> bytes) {
            result.push_back({now_s, bytes[0] + std::size_t{256} * bytes[1]});
        });
    }
    return result;
}

TEST(SimulatedLink, without_conditions_everything_arrives_at_once_and_in_order) {
    const auto got = arrivals({}, 1000);
    ASSERT_EQ(got.size(), 1000U);
    for (std::size_t i = 0; i < got.size(); ++i) {
        EXPECT_EQ(got[i].number, i);
        EXPECT_EQ(got[i].at_s, 0.0);
    }
}

TEST(SimulatedLink, loses_and_doubles_about_the_share_it_was_told_to) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        EXPECT_NEAR(static_cast<double>(arrivals({.loss = 0.3, .seed = seed}, 10000).size()),
                    7000.0, 250.0);
        EXPECT_NEAR(static_cast<double>(arrivals({.duplicate = 0.2, .seed = seed}, 10000).size()),
                    12000.0, 250.0);
    }
}

TEST(SimulatedLink, delays_within_its_jitter_and_lets_datagrams_overtake_each_other) {
    const auto got = arrivals({.delay_s = 0.05, .jitter_s = 0.03}, 1000);
    ASSERT_EQ(got.size(), 1000U);
    bool overtaken = false;
    for (std::size_t i = 0; i < got.size(); ++i) {
        EXPECT_GE(got[i].at_s, 0.02);
        EXPECT_LE(got[i].at_s, 0.0811);
        overtaken = overtaken || got[i].number != i;
    }
    EXPECT_TRUE(overtaken);
}

TEST(SimulatedLink, the_same_seed_does_the_same_and_another_seed_something_else) {
    const auto numbers = [](std::uint64_t seed) {
        std::vector<std::size_t> result;
        for (const auto& arrival : arrivals({.loss = 0.5, .jitter_s = 0.1, .seed = seed}, 100)) {
            result.push_back(arrival.number);
        }
        return result;
    };
    EXPECT_EQ(numbers(7), numbers(7));
    EXPECT_NE(numbers(7), numbers(8));
}

TEST(SimulatedLink, conditions_hold_for_what_arrives_as_well) {
    MemoryNetwork network;
    SimulatedLink link(std::make_unique<MemoryTransport>(network, kHere),
                       {.loss = 0.5, .delay_s = 0.1});
    MemoryTransport far(network, kThere);
    for (int i = 0; i < 1000; ++i) far.send(kHere, std::vector<std::uint8_t>{1});
    const auto ignore = [](const Address&, std::span<const std::uint8_t>) {};
    EXPECT_EQ(link.poll(0.0, ignore), 0U);
    EXPECT_EQ(link.poll(0.099, ignore), 0U);
    EXPECT_NEAR(static_cast<double>(link.poll(0.1, ignore)), 500.0, 80.0);
}

}  // namespace
}  // namespace fts::net
