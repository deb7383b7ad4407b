// What a connected pair may rely on.

#include "common/net/session.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

#include "common/net/drops.h"
#include "tests/net/pair.h"

namespace fts::net {
namespace {

std::vector<std::uint8_t> numbered(std::uint32_t number, std::size_t size = 4) {
    std::vector<std::uint8_t> bytes(std::max<std::size_t>(size, 4));
    ByteWriter(bytes).put(number);
    return bytes;
}

TEST(Session, unreliable_payloads_arrive_at_most_once_and_unaltered) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Pair pair({.loss = 0.2, .duplicate = 0.3, .delay_s = 0.05, .jitter_s = 0.05, .seed = seed});
        ASSERT_TRUE(pair.connect());
        for (std::uint32_t i = 0; i < 300; ++i) {
            ASSERT_TRUE(pair.dialer->send_unreliable(numbered(i, i)));
            ASSERT_TRUE(pair.listener->send_unreliable(pair.id(), numbered(i, kMaxPayloadBytes)));
            pair.tick();
        }
        pair.run(1.0);
        for (const Log* log : {&pair.server, &pair.client}) {
            const std::set<std::vector<std::uint8_t>> distinct(log->payloads.begin(),
                                                               log->payloads.end());
            EXPECT_EQ(distinct.size(), log->payloads.size());
            EXPECT_GT(distinct.size(), 150U);
            for (const auto& payload : distinct) {
                const auto number = ByteReader(payload).take<std::uint32_t>();
                EXPECT_EQ(payload,
                          numbered(number, log == &pair.server ? number : kMaxPayloadBytes));
            }
        }
    }
}

TEST(Session, reliable_messages_arrive_exactly_once_in_order_both_ways) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Pair pair(
            {.loss = 0.25, .duplicate = 0.2, .delay_s = 0.05, .jitter_s = 0.04, .seed = seed});
        ASSERT_TRUE(pair.connect());
        std::vector<std::vector<std::uint8_t>> sent;
        for (std::uint32_t i = 0; i < 60; ++i) {
            sent.push_back(numbered(i, (i * i * 37) % 3000));
            ASSERT_TRUE(pair.dialer->send_reliable(sent.back()));
            ASSERT_TRUE(pair.listener->send_reliable(pair.id(), sent.back()));
            pair.tick();
        }
        pair.run_until(
            [&] {
                return pair.server.messages.size() >= sent.size() &&
                       pair.client.messages.size() >= sent.size();
            },
            60.0);
        pair.run(0.5);
        EXPECT_EQ(pair.server.messages, sent);
        EXPECT_EQ(pair.client.messages, sent);
    }
}

TEST(Session, what_is_too_large_or_goes_to_nobody_is_refused) {
    Pair pair;
    EXPECT_FALSE(pair.dialer->send_unreliable(numbered(1))) << "not connected yet";
    EXPECT_FALSE(pair.dialer->send_reliable(numbered(1)));
    ASSERT_TRUE(pair.connect(1.0));
    EXPECT_TRUE(pair.dialer->send_unreliable(std::vector<std::uint8_t>(kMaxPayloadBytes)));
    EXPECT_FALSE(pair.dialer->send_unreliable(std::vector<std::uint8_t>(kMaxPayloadBytes + 1)));
    EXPECT_TRUE(pair.dialer->send_reliable(std::vector<std::uint8_t>(kMaxMessageBytes)));
    EXPECT_FALSE(pair.dialer->send_reliable(std::vector<std::uint8_t>(kMaxMessageBytes + 1)));
    EXPECT_FALSE(pair.listener->send_unreliable(pair.id() + 1, numbered(1)));
    EXPECT_FALSE(pair.listener->send_reliable(pair.id() + 1, numbered(1)));
}

TEST(Session, no_datagram_is_larger_than_the_limit_and_no_nonce_is_used_twice) {
    Pair pair({.loss = 0.2, .duplicate = 0.0, .delay_s = 0.02, .seed = 3});
    ASSERT_TRUE(pair.connect());
    for (std::uint32_t i = 0; i < 120; ++i) {
        pair.dialer->send_unreliable(numbered(i, kMaxPayloadBytes));
        pair.dialer->send_reliable(numbered(i, 900));
        pair.listener->send_reliable(pair.id(), numbered(i, 2500));
        pair.listener->send_unreliable(pair.id(), numbered(i, 40));
        pair.tick();
    }
    pair.dialer->close("bye");
    pair.run(0.5);
    std::set<std::pair<Address, Datagram>> nonces;
    std::size_t sealed = 0;
    for (const Sniffed& packet : pair.network.sent) {
        EXPECT_LE(packet.bytes.size(), kMaxDatagramBytes);
        if (!sealed_packet_id(packet.bytes)) continue;
        ++sealed;
        EXPECT_TRUE(nonces
                        .emplace(packet.from, Datagram(packet.bytes.begin() + 5,
                                                       packet.bytes.begin() + kSealedHeaderBytes))
                        .second);
    }
    EXPECT_GT(sealed, 300U);
}

TEST(Session, an_idle_pair_stays_connected_without_much_talk) {
    Pair pair({.loss = 0.2, .delay_s = 0.05});
    ASSERT_TRUE(pair.connect());
    const std::uint64_t before = pair.dialer->stats().packets_sent;
    pair.run(60.0);
    EXPECT_EQ(pair.dialer->state(), Dialer::State::kConnected);
    EXPECT_EQ(pair.listener->connection_count(), 1U);
    EXPECT_LT(pair.dialer->stats().packets_sent - before, 6U * 60U);
}

TEST(Session, an_answer_is_not_answered) {
    Pair pair;
    ASSERT_TRUE(pair.connect());
    const std::uint64_t before = pair.dialer->stats().packets_sent;
    pair.run(60.0);
    EXPECT_LT(pair.dialer->stats().packets_sent - before, 5U * 60U);
}

TEST(Session, the_link_is_measured_about_right) {
    Pair pair({.delay_s = 0.025, .jitter_s = 0.015, .seed = 4});
    ASSERT_TRUE(pair.connect());
    for (int i = 0; i < 600; ++i) {
        pair.dialer->send_unreliable(numbered(1));
        pair.listener->send_unreliable(pair.id(), numbered(1));
        pair.tick();
    }
    // Both directions of the link are slow, and each end looks once a tick.
    EXPECT_NEAR(pair.dialer->stats().rtt_s, 0.05 + 2 * kTickS, 0.025);
    EXPECT_NEAR(pair.listener->stats(pair.id())->rtt_s, 0.05 + 2 * kTickS, 0.025);
    EXPECT_LT(pair.dialer->stats().loss, 0.01);
    EXPECT_GT(pair.dialer->stats().bytes_received, 600U * kSealOverheadBytes);
    EXPECT_FALSE(pair.listener->stats(pair.id() + 1));
}

TEST(Session, silence_ends_it_at_both_ends_after_the_timeout_and_not_before) {
    Pair pair({}, {.timeout_s = 2.0}, {.timeout_s = 2.0});
    ASSERT_TRUE(pair.connect(1.0));
    pair.run(0.5);
    pair.network.is_cut = true;
    pair.run(1.4);
    EXPECT_TRUE(pair.server.disconnected.empty());
    EXPECT_TRUE(pair.client.disconnected.empty());
    pair.run(1.0);
    ASSERT_EQ(pair.server.disconnected.size(), 1U);
    ASSERT_EQ(pair.client.disconnected.size(), 1U);
    EXPECT_EQ(pair.server.disconnected[0].reason, DisconnectReason::kTimeout);
    EXPECT_EQ(pair.client.disconnected[0].reason, DisconnectReason::kTimeout);
    EXPECT_EQ(pair.listener->connection_count(), 0U);
}

TEST(Session, a_clients_goodbye_reaches_the_server_with_its_words) {
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    pair.dialer->close("going to bed");
    EXPECT_EQ(pair.dialer->state(), Dialer::State::kDisconnected);
    pair.run(0.1);
    ASSERT_EQ(pair.server.disconnected.size(), 1U);
    EXPECT_EQ(pair.server.disconnected[0].reason, DisconnectReason::kClosed);
    EXPECT_EQ(pair.server.disconnected[0].detail, "going to bed");
    EXPECT_EQ(pair.server.disconnected[0].id, pair.id());
    EXPECT_EQ(pair.client.disconnected.size(), 1U);
    EXPECT_FALSE(pair.listener->send_unreliable(pair.id(), numbered(1)));
}

TEST(Session, a_kick_is_known_at_the_client_for_what_it_is_even_when_packets_are_lost) {
    int known = 0;
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        Pair pair({.loss = 0.2, .seed = seed});
        ASSERT_TRUE(pair.connect());
        pair.listener->disconnect(pair.id(), DisconnectReason::kKicked, "too rough");
        EXPECT_EQ(pair.listener->connection_count(), 0U);
        pair.run(1.0);
        EXPECT_EQ(pair.server.disconnected.size(), 1U);
        if (pair.client.disconnected.empty()) continue;
        EXPECT_EQ(pair.client.disconnected[0].reason, DisconnectReason::kKicked);
        EXPECT_EQ(pair.client.disconnected[0].detail, "too rough");
        ++known;
    }
    EXPECT_GE(known, 28) << "a goodbye is said more than once";
}

TEST(Session, closing_the_server_tells_everybody) {
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    pair.listener->close("maintenance");
    pair.run(0.1);
    ASSERT_EQ(pair.client.disconnected.size(), 1U);
    EXPECT_EQ(pair.client.disconnected[0].reason, DisconnectReason::kClosed);
    EXPECT_EQ(pair.client.disconnected[0].detail, "maintenance");
}

TEST(Session, goes_on_when_the_clients_address_changes) {
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    pair.client_memory->move_to(address_of(9, 5555));
    for (std::uint32_t i = 0; i < 60; ++i) {
        pair.dialer->send_unreliable(numbered(i));
        pair.dialer->send_reliable(numbered(i));
        pair.listener->send_reliable(pair.id(), numbered(i));
        pair.tick();
    }
    pair.run(1.0);
    EXPECT_EQ(pair.server.messages.size(), 60U);
    EXPECT_EQ(pair.client.messages.size(), 60U);
    EXPECT_TRUE(pair.server.disconnected.empty());
    EXPECT_EQ(pair.network.sent.back().bytes.empty(), false);
    const auto& sent = pair.network.sent;
    EXPECT_TRUE(std::any_of(sent.begin(), sent.end(), [](const Sniffed& packet) {
        return packet.to == address_of(9, 5555);
    }));
}

TEST(Session, an_address_that_cannot_answer_is_sent_little_more_than_came_from_it) {
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    // Somebody on the way sends the client's next packets on from a victim's address.
    const Address victim = address_of(77);
    std::size_t from_victim = 0;
    std::size_t to_victim = 0;
    for (std::uint32_t i = 0; i < 60; ++i) {
        const std::size_t before = pair.network.sent.size();
        pair.dialer->send_unreliable(numbered(i));
        pair.now_s += kTickS;
        pair.client_link->poll(pair.now_s, [](const Address&, std::span<const std::uint8_t>) {});
        pair.network.inbox(pair.server_address).clear();
        const std::vector<Sniffed> caught(pair.network.sent.begin() + static_cast<long>(before),
                                          pair.network.sent.end());
        for (const Sniffed& packet : caught) {
            from_victim += packet.bytes.size();
            pair.listener->receive(victim, packet.bytes, pair.now_s);
        }
        pair.listener->send_unreliable(pair.id(), numbered(i, kMaxPayloadBytes));
        pair.listener->update(pair.now_s);
    }
    for (const Sniffed& packet : pair.network.sent) {
        if (packet.to == victim) to_victim += packet.bytes.size();
    }
    EXPECT_GT(to_victim, 0U);
    EXPECT_LE(to_victim, kUnprovenFactor * from_victim);
    EXPECT_GT(pair.listener->drops().at(drop::kUnprovenAddress), 0U);
}

TEST(Session, an_older_packet_from_elsewhere_does_not_move_it) {
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    pair.dialer->send_unreliable(numbered(1));
    pair.client_link->poll(pair.now_s, [](const Address&, std::span<const std::uint8_t>) {});
    const Datagram held = pair.network.inbox(pair.server_address).back().second;
    pair.network.inbox(pair.server_address).clear();
    pair.dialer->send_unreliable(numbered(2));
    pair.tick_client();
    pair.tick();
    const std::size_t before = pair.network.sent.size();
    pair.listener->receive(address_of(66), held, pair.now_s);
    pair.listener->send_unreliable(pair.id(), numbered(3));
    ASSERT_GT(pair.network.sent.size(), before);
    EXPECT_EQ(pair.network.sent.back().to, pair.client_address);
}

}  // namespace
}  // namespace fts::net
