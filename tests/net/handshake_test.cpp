// How two ends come together, and all the ways in which they do not.

#include "common/net/handshake.h"

#include <gtest/gtest.h>

#include "common/net/drops.h"
#include "common/net/noise.h"
#include "tests/net/pair.h"

namespace fts::net {
namespace {

TEST(Handshake, both_ends_report_each_others_key_once) {
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    ASSERT_EQ(pair.server.connected.size(), 1U);
    ASSERT_EQ(pair.client.connected.size(), 1U);
    EXPECT_EQ(pair.server.connected[0].peer, pair.client_key.public_key);
    EXPECT_EQ(pair.client.connected[0].peer, pair.server_key.public_key);
    EXPECT_EQ(pair.server.connected[0].address, pair.client_address);
    EXPECT_EQ(pair.dialer->state(), Dialer::State::kConnected);
    EXPECT_EQ(pair.listener->connection_count(), 1U);
}

TEST(Handshake, is_the_five_packets_that_are_written_down_and_of_their_size) {
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    const std::vector<std::pair<PacketType, std::size_t>> expected{{PacketType::kHello, 1200},
                                                                   {PacketType::kCookie, 71},
                                                                   {PacketType::kConnect, 1200},
                                                                   {PacketType::kResponse, 139},
                                                                   {PacketType::kFinish, 75}};
    ASSERT_GT(pair.network.sent.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const Datagram& bytes = pair.network.sent[i].bytes;
        const Datagram start{'F', 'T', 'S', 'A', static_cast<std::uint8_t>(expected[i].first),
                             2,   0};
        EXPECT_EQ(Datagram(bytes.begin(), bytes.begin() + kHeaderBytes), start);
        EXPECT_EQ(bytes.size(), expected[i].second);
    }
    EXPECT_EQ(pair.network.sent[expected.size()].bytes[0], 'S');
    EXPECT_EQ(encode(Refused{}, 1).size(), 40U);
}

TEST(Handshake, succeeds_when_three_packets_in_ten_are_lost_each_way) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Pair pair({.loss = 0.3, .duplicate = 0.1, .delay_s = 0.04, .jitter_s = 0.04, .seed = seed});
        EXPECT_TRUE(pair.connect());
        pair.run(1.0);
        EXPECT_EQ(pair.server.connected.size(), 1U);
        EXPECT_EQ(pair.client.connected.size(), 1U);
        EXPECT_EQ(pair.listener->connection_count(), 1U);
    }
}

TEST(Handshake, every_packet_sent_twice_still_makes_one_session) {
    Pair pair({.duplicate = 1.0});
    ASSERT_TRUE(pair.connect(1.0));
    pair.run(1.0);
    EXPECT_EQ(pair.server.connected.size(), 1U);
    EXPECT_EQ(pair.client.connected.size(), 1U);
    EXPECT_TRUE(pair.client.disconnected.empty());
}

TEST(Handshake, the_server_says_less_than_it_heard_until_the_address_is_proven) {
    Pair pair;
    std::size_t heard = 0;
    std::size_t said = 0;
    for (int i = 0; i < 20 && pair.server.connected.empty(); ++i) {
        pair.tick();
        heard = said = 0;
        for (const Sniffed& packet : pair.network.sent) {
            (packet.to == pair.server_address ? heard : said) += packet.bytes.size();
            EXPECT_LE(said, heard);
        }
    }
    EXPECT_FALSE(pair.server.connected.empty());
}

// A client packet from an address that the client does not have.
void forge(Pair& pair, const Address& from, const Datagram& datagram) {
    pair.listener->receive(from, datagram, pair.now_s);
}

TEST(Handshake, a_cookie_is_worth_nothing_at_another_address) {
    Pair pair;
    pair.tick();
    pair.tick_client();
    pair.tick_server();
    const auto cookie = decode_cookie(pair.network.sent.back().bytes);
    ASSERT_TRUE(cookie);
    const Datagram connect = encode(Connect{cookie->echo, cookie->cookie}, kProtocolVersion);
    forge(pair, address_of(66, pair.client_address.port), connect);
    EXPECT_EQ(pair.listener->drops().at(drop::kBadCookie), 1U);
    Address other_port = pair.client_address;
    ++other_port.port;
    forge(pair, other_port, connect);
    EXPECT_EQ(pair.listener->drops().at(drop::kBadCookie), 2U);
}

TEST(Handshake, a_cookie_goes_stale) {
    const CookieJar jar;
    const EphemeralKey ephemeral{1, 2, 3};
    const Cookie cookie = jar.bake(address_of(5), ephemeral, 50.0);
    EXPECT_TRUE(jar.recognises(cookie, address_of(5), ephemeral, 50.0));
    EXPECT_TRUE(jar.recognises(cookie, address_of(5), ephemeral, 50.0 + CookieJar::kCookieSlotS));
    EXPECT_FALSE(
        jar.recognises(cookie, address_of(5), ephemeral, 50.0 + 2 * CookieJar::kCookieSlotS));
    EXPECT_FALSE(jar.recognises(cookie, address_of(5), EphemeralKey{1, 2, 4}, 50.0));
    EXPECT_FALSE(CookieJar().recognises(cookie, address_of(5), ephemeral, 50.0));
}

TEST(Handshake, a_full_server_refuses_and_says_so) {
    Pair pair({}, {.max_connections = 1});
    ASSERT_TRUE(pair.connect(1.0));
    MemoryTransport transport(pair.network, address_of(3));
    Dialer late({.key = generate_key_pair(), .server = pair.server_address}, transport);
    Log log;
    for (int i = 0; i < 20; ++i) {
        late.update(pair.now_s);
        pair.tick();
        transport.poll(pair.now_s, [&](const Address& from, std::span<const std::uint8_t> bytes) {
            late.receive(from, bytes, pair.now_s);
        });
        log.take(late.drain_events());
    }
    ASSERT_EQ(log.disconnected.size(), 1U);
    EXPECT_EQ(log.disconnected[0].reason, DisconnectReason::kServerFull);
    EXPECT_GE(pair.listener->drops().at(drop::kServerFull), 1U);
    EXPECT_EQ(pair.listener->connection_count(), 1U);
}

TEST(Handshake, with_one_place_left_two_clients_at_once_make_one_session_and_one_refusal) {
    Pair pair({}, {.max_connections = 1});
    MemoryTransport transport(pair.network, address_of(3));
    Dialer other({.key = generate_key_pair(), .server = pair.server_address}, transport);
    Log log;
    for (int i = 0; i < 60; ++i) {
        other.update(pair.now_s);
        pair.tick();
        transport.poll(pair.now_s, [&](const Address& from, std::span<const std::uint8_t> bytes) {
            other.receive(from, bytes, pair.now_s);
        });
        log.take(other.drain_events());
    }
    EXPECT_EQ(pair.listener->connection_count(), 1U);
    const auto& losers = log.connected.empty() ? log.disconnected : pair.client.disconnected;
    ASSERT_EQ(losers.size(), 1U);
    EXPECT_EQ(losers[0].reason, DisconnectReason::kServerFull);
}

TEST(Handshake, ends_of_different_versions_part_and_both_learn_the_others) {
    Pair pair({}, {.protocol_version = 9}, {.protocol_version = 4});
    EXPECT_FALSE(pair.connect(1.0));
    ASSERT_EQ(pair.client.disconnected.size(), 1U);
    EXPECT_EQ(pair.client.disconnected[0].reason, DisconnectReason::kWrongVersion);
    EXPECT_EQ(pair.client.disconnected[0].peer_version, 9);
    EXPECT_NE(pair.client.disconnected[0].detail.find("protocol version 9"), std::string::npos);
    EXPECT_NE(pair.client.disconnected[0].detail.find("version 4"), std::string::npos);
    EXPECT_EQ(pair.listener->last_foreign_version(), 4);
    EXPECT_EQ(pair.listener->drops().at(drop::kWrongVersion), 1U);
}

// Of the version before, too: what it would make of our packets is nothing to try.
TEST(Handshake, a_client_of_the_version_before_is_refused) {
    constexpr std::uint16_t kBefore = kProtocolVersion - 1;
    Pair pair({}, {}, {.protocol_version = kBefore});
    EXPECT_FALSE(pair.connect(1.0));
    ASSERT_EQ(pair.client.disconnected.size(), 1U);
    EXPECT_EQ(pair.client.disconnected[0].reason, DisconnectReason::kWrongVersion);
    EXPECT_EQ(pair.client.disconnected[0].peer_version, kProtocolVersion);
    EXPECT_EQ(pair.listener->last_foreign_version(), kBefore);
    EXPECT_EQ(pair.listener->connection_count(), 0U);
}

TEST(Handshake, no_server_is_reported_as_unreachable_with_its_address) {
    Pair pair({}, {}, {.timeout_s = 1.0});
    pair.network.is_cut = true;
    pair.run(1.2);
    ASSERT_EQ(pair.client.disconnected.size(), 1U);
    EXPECT_EQ(pair.client.disconnected[0].reason, DisconnectReason::kUnreachable);
    EXPECT_NE(pair.client.disconnected[0].detail.find("10.0.0.1:7777"), std::string::npos);
}

TEST(Handshake, a_server_with_another_key_than_the_pinned_one_is_not_spoken_to) {
    Pair pair({}, {}, {.pinned_server_key = generate_key_pair().public_key});
    EXPECT_FALSE(pair.connect(1.0));
    ASSERT_EQ(pair.client.disconnected.size(), 1U);
    EXPECT_EQ(pair.client.disconnected[0].reason, DisconnectReason::kKeyChanged);
    EXPECT_EQ(pair.listener->connection_count(), 0U);
    for (const Sniffed& packet : pair.network.sent) {
        if (const auto header = decode_header(packet.bytes)) {
            EXPECT_NE(header->type, PacketType::kFinish) << "the client gave away who it is";
        }
    }
}

TEST(Handshake, the_pinned_key_is_accepted) {
    Pair pair;
    const DialerConfig config{.key = pair.client_key,
                              .server = pair.server_address,
                              .pinned_server_key = pair.server_key.public_key};
    pair.dialer = std::make_unique<Dialer>(config, *pair.client_link);
    EXPECT_TRUE(pair.connect(1.0));
}

TEST(Handshake, a_refusal_that_does_not_echo_the_attempt_is_ignored) {
    Pair pair;
    pair.tick();
    const Datagram forged =
        encode(Refused{EphemeralKey{}, RefusalReason::kServerFull}, kProtocolVersion);
    pair.dialer->receive(pair.server_address, forged, pair.now_s);
    EXPECT_TRUE(pair.connect(1.0));
}

TEST(Handshake, a_true_refusal_cannot_end_an_established_session) {
    Pair pair;
    pair.tick();
    pair.tick_client();
    const EphemeralKey ephemeral = echo_of(pair.network.sent.at(0).bytes);
    ASSERT_TRUE(pair.connect(1.0));
    const Datagram refusal =
        encode(Refused{ephemeral, RefusalReason::kServerFull}, kProtocolVersion);
    pair.dialer->receive(pair.server_address, refusal, pair.now_s);
    EXPECT_EQ(pair.dialer->state(), Dialer::State::kConnected);
    EXPECT_EQ(pair.dialer->drops().at(drop::kUnexpected), 1U);
}

TEST(Handshake, a_forged_response_does_not_spoil_the_true_one) {
    Pair pair;
    pair.tick();
    pair.tick_client();
    const EphemeralKey ephemeral = echo_of(pair.network.sent.at(0).bytes);
    const Response forged{ephemeral, std::vector<std::uint8_t>(NoiseXX::kMessage2Bytes + 4, 7)};
    for (int i = 0; i < 4; ++i) {
        pair.dialer->receive(pair.server_address, encode(forged, kProtocolVersion), pair.now_s);
        pair.tick();
    }
    EXPECT_TRUE(pair.connect(1.0));
}

TEST(Handshake, the_same_connect_gets_the_same_response_and_no_second_place) {
    Pair pair;
    pair.run_until([&] { return pair.network.sent.size() >= 4; }, 1.0);
    const Datagram connect = pair.network.sent.at(2).bytes;
    const Datagram response = pair.network.sent.at(3).bytes;
    ASSERT_EQ(decode_header(connect)->type, PacketType::kConnect);
    pair.listener->receive(pair.client_address, connect, pair.now_s);
    EXPECT_EQ(pair.network.sent.back().bytes, response);
}

TEST(Handshake, a_finish_heard_again_is_answered_until_the_client_knows_and_only_where_it_is) {
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    const Datagram finish = pair.network.sent.at(4).bytes;
    ASSERT_EQ(decode_header(finish)->type, PacketType::kFinish);
    const std::size_t before = pair.network.sent.size();
    pair.listener->receive(pair.client_address, finish, pair.now_s);
    ASSERT_EQ(pair.network.sent.size(), before + 1);
    EXPECT_EQ(pair.network.sent.back().bytes[0], 'S');
    EXPECT_LE(pair.network.sent.back().bytes.size(), finish.size());
    pair.listener->receive(address_of(66), finish, pair.now_s);
    EXPECT_EQ(pair.network.sent.size(), before + 1);
    EXPECT_EQ(pair.listener->connection_count(), 1U);
}

TEST(Handshake, a_finish_from_another_address_than_the_proven_one_opens_nothing) {
    Pair pair;
    pair.run_until([&] { return pair.network.sent.size() >= 5; }, 1.0);
    const Datagram finish = pair.network.sent.at(4).bytes;
    ASSERT_EQ(decode_header(finish)->type, PacketType::kFinish);
    ASSERT_EQ(pair.listener->connection_count(), 0U);
    pair.listener->receive(address_of(66), finish, pair.now_s);
    EXPECT_EQ(pair.listener->connection_count(), 0U);
    EXPECT_EQ(pair.listener->drops().at(drop::kUnknownSession), 1U);
    EXPECT_TRUE(pair.connect(1.0));
}

TEST(Handshake, the_client_survives_a_server_that_starts_anew_in_the_middle) {
    Pair pair;
    pair.tick();
    pair.tick_client();
    pair.tick();
    pair.listener =
        std::make_unique<Listener>(ListenerConfig{.key = pair.server_key}, pair.server_link);
    EXPECT_TRUE(pair.connect(3.0)) << "the old server's cookie must be replaced by a new one";
    EXPECT_GE(pair.listener->drops().at(drop::kBadCookie), 1U);
}

}  // namespace
}  // namespace fts::net
