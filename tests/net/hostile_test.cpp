// Packets that nobody honest would send.

#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "common/net/drops.h"
#include "common/net/half_open.h"
#include "common/net/handshake.h"
#include "common/net/noise.h"
#include "common/net/session.h"
#include "tests/net/pair.h"

namespace fts::net {
namespace {

const Address kStranger = address_of(200, 4444);

std::uint64_t total(const DropCounters& drops) {
    return std::accumulate(drops.begin(), drops.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const auto& entry) { return sum + entry.second; });
}

Datagram noise_bytes(std::mt19937_64& random, std::size_t size) {
    Datagram bytes(size);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    return bytes;
}

TEST(Hostile, garbage_of_every_size_is_counted_and_met_with_silence) {
    std::mt19937_64 random(1);
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    const std::size_t sent = pair.network.sent.size();
    for (std::size_t size = 0; size <= 2000; ++size) {
        Datagram bytes = noise_bytes(random, size);
        if (size > 0 && (bytes[0] == kMagic[0] || bytes[0] == kSealedMarker)) bytes[0] = 0;
        pair.listener->receive(kStranger, bytes, pair.now_s);
        pair.dialer->receive(pair.server_address, bytes, pair.now_s);
    }
    EXPECT_EQ(pair.network.sent.size(), sent);
    EXPECT_EQ(pair.listener->drops().at(drop::kMalformed), 2001U);
    EXPECT_EQ(pair.dialer->drops().at(drop::kMalformed), 2001U);
    EXPECT_EQ(pair.dialer->state(), Dialer::State::kConnected);
}

TEST(Hostile, every_dropped_packet_is_counted_once) {
    std::mt19937_64 random(2);
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    const std::uint64_t before = total(pair.listener->drops());
    for (int i = 0; i < 2000; ++i) {
        Datagram bytes = noise_bytes(random, random() % 1300);
        const auto flavour = random() % 3;
        if (flavour == 0 && bytes.size() > 7) {
            std::copy(kMagic.begin(), kMagic.end(), bytes.begin());
            bytes[4] = static_cast<std::uint8_t>(2 + 2 * (random() % 3));  // not for a server
        } else if (flavour == 1 && !bytes.empty()) {
            bytes[0] = kSealedMarker;
        }
        pair.listener->receive(kStranger, bytes, pair.now_s);
    }
    EXPECT_EQ(total(pair.listener->drops()) - before, 2000U);
}

TEST(Hostile, no_answer_is_ever_larger_than_what_a_stranger_sent) {
    std::mt19937_64 random(3);
    Pair pair;
    for (int i = 0; i < 20000; ++i) {
        Datagram bytes = noise_bytes(random, i % 3 == 0 ? kMaxDatagramBytes : random() % 1300);
        if (bytes.size() >= kHeaderBytes) {
            std::copy(kMagic.begin(), kMagic.end(), bytes.begin());
            bytes[4] = static_cast<std::uint8_t>(random() % 8);
            bytes[5] = static_cast<std::uint8_t>(random() % 2);
            bytes[6] = 0;
        }
        const std::size_t before = pair.network.sent.size();
        pair.listener->receive(kStranger, bytes, pair.now_s);
        std::size_t answered = 0;
        for (std::size_t k = before; k < pair.network.sent.size(); ++k) {
            answered += pair.network.sent[k].bytes.size();
        }
        ASSERT_LE(answered, bytes.size());
    }
    EXPECT_GT(pair.network.sent.size(), 1000U) << "nothing was tested";
    EXPECT_EQ(pair.listener->connection_count(), 0U);
}

TEST(Hostile, ours_but_malformed_is_refused_when_long_enough_and_a_refusal_never_is) {
    Pair pair;
    Datagram bytes(kRefusedBytes, 0);
    std::copy(kMagic.begin(), kMagic.end(), bytes.begin());
    bytes[4] = 77;
    pair.listener->receive(kStranger, bytes, 1.0);
    ASSERT_EQ(pair.network.sent.size(), 1U);
    const auto refused = decode_refused(pair.network.sent[0].bytes);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->reason, RefusalReason::kMalformed);
    pair.listener->receive(kStranger, pair.network.sent[0].bytes, 1.0);
    bytes.pop_back();
    pair.listener->receive(kStranger, bytes, 1.0);
    EXPECT_EQ(pair.network.sent.size(), 1U);
}

TEST(Hostile, every_packet_heard_again_changes_nothing) {
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    for (int i = 0; i < 30; ++i) {
        pair.dialer->send_unreliable(bytes_of("once"));
        pair.dialer->send_reliable(bytes_of("once"));
        pair.listener->send_unreliable(pair.id(), bytes_of("once"));
        pair.tick();
    }
    pair.run(0.5);
    const std::vector<Sniffed> recorded = pair.network.sent;
    const std::uint64_t replayed = pair.listener->drops().at(drop::kReplayed);
    std::uint64_t sealed = 0;
    for (const Sniffed& packet : recorded) {
        if (packet.to == pair.server_address) {
            if (sealed_packet_id(packet.bytes)) ++sealed;
            pair.listener->receive(kStranger, packet.bytes, pair.now_s);
        } else {
            pair.dialer->receive(packet.from, packet.bytes, pair.now_s);
        }
    }
    EXPECT_EQ(pair.listener->drops().at(drop::kReplayed) - replayed, sealed);
    pair.run(0.5);
    EXPECT_EQ(pair.server.payloads.size(), 30U);
    EXPECT_EQ(pair.server.messages.size(), 30U);
    EXPECT_EQ(pair.client.payloads.size(), 30U);
    EXPECT_EQ(pair.server.connected.size(), 1U);
    EXPECT_EQ(pair.dialer->state(), Dialer::State::kConnected);
}

TEST(Hostile, a_packet_altered_in_any_byte_is_dropped_and_counted) {
    Pair pair;
    ASSERT_TRUE(pair.connect(1.0));
    pair.run(0.2);
    pair.dialer->send_unreliable(bytes_of("the truth"));
    pair.client_link->poll(pair.now_s, [](const Address&, std::span<const std::uint8_t>) {});
    const Datagram packet = pair.network.inbox(pair.server_address).back().second;
    pair.network.inbox(pair.server_address).clear();
    const std::uint64_t before = total(pair.listener->drops());
    for (std::size_t i = 0; i < packet.size(); ++i) {
        for (const unsigned flip : {0x01U, 0x80U}) {
            Datagram altered = packet;
            altered[i] = static_cast<std::uint8_t>(altered[i] ^ flip);
            pair.listener->receive(pair.client_address, altered, pair.now_s);
        }
    }
    EXPECT_EQ(total(pair.listener->drops()) - before, 2 * packet.size());
    EXPECT_GE(pair.listener->drops().at(drop::kBadSeal), 2 * (packet.size() - kSealedHeaderBytes));
    pair.server.take(pair.listener->drain_events());
    EXPECT_TRUE(pair.server.payloads.empty());
    pair.listener->receive(pair.client_address, packet, pair.now_s);
    pair.server.take(pair.listener->drain_events());
    ASSERT_EQ(pair.server.payloads.size(), 1U);
    EXPECT_EQ(pair.server.payloads[0], bytes_of("the truth"));
}

// A CONNECT with a true cookie, as a host may make as many as it likes at its own address.
void open_half(Pair& pair, const Address& from) {
    const EphemeralKey ephemeral = generate_key_pair().public_key;
    pair.listener->receive(from, encode(Hello{ephemeral}, kProtocolVersion), pair.now_s);
    const auto cookie = decode_cookie(pair.network.sent.back().bytes);
    ASSERT_TRUE(cookie);
    pair.listener->receive(from, encode(Connect{ephemeral, cookie->cookie}, kProtocolVersion),
                           pair.now_s);
}

TEST(Hostile, half_open_handshakes_are_few_and_one_host_cannot_keep_others_out) {
    Pair pair;
    for (std::uint16_t port = 1; port <= kMaxHalfOpenPerHost + 20; ++port) {
        open_half(pair, address_of(66, port));
    }
    EXPECT_EQ(pair.listener->drops().at(drop::kHalfOpenLimit), 20U);
    EXPECT_TRUE(pair.connect(1.0)) << "another host is let in";
}

TEST(Hostile, when_all_half_open_places_are_taken_they_are_free_again_soon) {
    Pair pair;
    for (std::size_t i = 0; i < kMaxHalfOpen + 10; ++i) {
        const auto host = static_cast<std::uint8_t>(100 + i / 32);
        open_half(pair, address_of(host, static_cast<std::uint16_t>(1000 + i)));
    }
    EXPECT_EQ(pair.listener->drops().at(drop::kHalfOpenLimit), 10U);
    EXPECT_TRUE(pair.connect(kHalfOpenTimeoutS + 1.0));
}

TEST(Hostile, finishing_a_handshake_with_nonsense_opens_no_session) {
    Pair pair;
    open_half(pair, kStranger);
    for (ConnectionId id = 0; id < 10; ++id) {
        const Finish finish{id, std::vector<std::uint8_t>(NoiseXX::kMessage3Bytes, 3)};
        pair.listener->receive(kStranger, encode(finish, kProtocolVersion), pair.now_s);
    }
    EXPECT_EQ(pair.listener->drops().at(drop::kBadHandshake), 1U);
    EXPECT_EQ(pair.listener->drops().at(drop::kUnknownSession), 9U);
    EXPECT_EQ(pair.listener->connection_count(), 0U);
}

TEST(Hostile, a_peer_that_breaks_the_protocol_after_the_handshake_is_disconnected) {
    // A client of our own making, with true keys and no manners.
    Pair pair;
    const KeyPair ephemeral = generate_key_pair();
    NoiseXX noise(NoiseXX::Role::kInitiator, generate_key_pair(), ephemeral,
                  handshake_prologue(kProtocolVersion));
    noise.write({});
    const auto tell = [&](const Datagram& datagram) {
        pair.listener->receive(kStranger, datagram, pair.now_s);
        return pair.network.sent.back().bytes;
    };
    const Datagram cookie = tell(encode(Hello{ephemeral.public_key}, kProtocolVersion));
    const Connect connect{ephemeral.public_key, decode_cookie(cookie)->cookie};
    const auto response = decode_response(tell(encode(connect, kProtocolVersion)));
    ASSERT_TRUE(response);
    const auto payload = noise.read(response->noise);
    ASSERT_TRUE(payload);
    const auto id = ByteReader(*payload).take<ConnectionId>();
    tell(encode(Finish{id, *noise.write({})}, kProtocolVersion));
    ASSERT_EQ(pair.listener->connection_count(), 1U);

    const std::array<std::uint8_t, kAckHeaderBytes + 1> nonsense{0, 0, 0, 0, 0, 0, 0, 0,
                                                                 0, 0, 0, 0, 0, 0, 99};
    Datagram sealed(kSealOverheadBytes + nonsense.size());
    ByteWriter header(sealed);
    header.put(kSealedMarker);
    header.put(id);
    header.put(std::uint64_t{1});
    seal(noise.split().send, 1, std::span(sealed).first(kSealedHeaderBytes), nonsense,
         std::span(sealed).subspan(kSealedHeaderBytes));
    tell(sealed);
    pair.server.take(pair.listener->drain_events());
    ASSERT_EQ(pair.server.disconnected.size(), 1U);
    EXPECT_EQ(pair.server.disconnected[0].reason, DisconnectReason::kProtocolError);
    EXPECT_EQ(pair.listener->connection_count(), 0U);
    EXPECT_EQ(pair.listener->drops().at(drop::kProtocolError), 1U);
}

}  // namespace
}  // namespace fts::net
