// Real sockets on the loopback interface.

#include <gtest/gtest.h>

#include "common/net/connection.h"
#include "common/net/udp_transport.h"
#include "tests/net/pair.h"

namespace fts::net {
namespace {

std::unique_ptr<UdpTransport> open_any(UdpCalls calls = UdpCalls::kBatched) {
    std::string error;
    auto transport = UdpTransport::open("", 0, error, calls);
    EXPECT_TRUE(transport) << error;
    return transport;
}

Address loopback(std::uint16_t port) {
    return *resolve("127.0.0.1", port).address;
}

TEST(Udp, a_client_connects_and_both_ends_exchange_messages_over_loopback) {
    const auto server_socket = open_any();
    const auto client_socket = open_any();
    Listener listener({.key = generate_key_pair()}, *server_socket);
    Dialer dialer({.key = generate_key_pair(), .server = loopback(server_socket->local_port())},
                  *client_socket);
    Log server;
    Log client;
    double now_s = 0.0;
    const auto tick = [&] {
        now_s += 0.01;
        dialer.update(now_s);
        client_socket->flush();
        server_socket->wait_readable(0.02);
        server_socket->poll(now_s, [&](const Address& from, std::span<const std::uint8_t> bytes) {
            listener.receive(from, bytes, now_s);
        });
        listener.update(now_s);
        server_socket->flush();
        client_socket->wait_readable(0.02);
        client_socket->poll(now_s, [&](const Address& from, std::span<const std::uint8_t> bytes) {
            dialer.receive(from, bytes, now_s);
        });
        server.take(listener.drain_events());
        client.take(dialer.drain_events());
    };
    for (int i = 0; i < 200 && client.connected.empty(); ++i) tick();
    ASSERT_EQ(client.connected.size(), 1U);
    EXPECT_TRUE(dialer.send_reliable(bytes_of("from the client")));
    EXPECT_TRUE(listener.send_reliable(server.connected.at(0).id, bytes_of("from the server")));
    for (int i = 0; i < 200 && (server.messages.empty() || client.messages.empty()); ++i) tick();
    ASSERT_EQ(server.messages.size(), 1U);
    ASSERT_EQ(client.messages.size(), 1U);
    EXPECT_EQ(server.messages[0], bytes_of("from the client"));
    EXPECT_EQ(client.messages[0], bytes_of("from the server"));
}

TEST(Udp, datagrams_arrive_whole_with_the_address_they_came_from) {
    const auto a = open_any();
    const auto b = open_any();
    const std::vector<std::uint8_t> sent(kMaxDatagramBytes, 42);
    ASSERT_TRUE(a->send(loopback(b->local_port()), sent));
    EXPECT_FALSE(a->send(loopback(b->local_port()), std::vector<std::uint8_t>(1201)));
    EXPECT_EQ(a->drops().at("send_too_large"), 1U);
    a->flush();
    b->wait_readable(5.0);
    std::vector<std::uint8_t> got;
    Address from;
    EXPECT_EQ(b->poll(0.0,
                      [&](const Address& sender, std::span<const std::uint8_t> bytes) {
                          got.assign(bytes.begin(), bytes.end());
                          from = sender;
                      }),
              1U);
    EXPECT_EQ(got, sent);
    EXPECT_EQ(from, loopback(a->local_port()));
}

// What `socket` receives until `count` datagrams have come or nothing does for a while.
std::vector<Datagram> receive(UdpTransport& socket, std::size_t count) {
    std::vector<Datagram> received;
    while (received.size() < count) {
        socket.wait_readable(0.3);
        const std::size_t came =
            socket.poll(0.0, [&](const Address&, std::span<const std::uint8_t> bytes) {
                received.emplace_back(bytes.begin(), bytes.end());
            });
        if (came == 0) break;
    }
    return received;
}

// Its first two bytes are its number; its size is any up to the limit.
Datagram marked(std::size_t number) {
    const std::size_t size = std::max<std::size_t>(2, number * 7919 % (kMaxDatagramBytes + 1));
    Datagram datagram(size, static_cast<std::uint8_t>(number % 251));
    datagram[0] = static_cast<std::uint8_t>(number);
    datagram[1] = static_cast<std::uint8_t>(number >> 8U);
    return datagram;
}

// With many datagrams a call, and with one.
class UdpBatch : public testing::TestWithParam<UdpCalls> {};
INSTANTIATE_TEST_SUITE_P(Calls, UdpBatch, testing::Values(UdpCalls::kBatched, UdpCalls::kOneByOne),
                         [](const auto& calls) {
                             return calls.param == UdpCalls::kBatched ? "batched" : "one_by_one";
                         });

TEST_P(UdpBatch,
       thousands_of_datagrams_of_all_sizes_arrive_whole_and_in_order_at_each_of_three_peers) {
    constexpr std::size_t kRounds = 40, kInRound = 100;
    const auto sender = open_any(GetParam());
    std::vector<std::unique_ptr<UdpTransport>> peers;
    for (int i = 0; i < 3; ++i) peers.push_back(open_any(GetParam()));
    std::vector<std::size_t> arrived(peers.size(), 0);
    for (std::size_t round = 0; round < kRounds; ++round) {
        for (std::size_t i = round * kInRound; i < (round + 1) * kInRound; ++i) {
            for (const auto& peer : peers) {
                ASSERT_TRUE(sender->send(loopback(peer->local_port()), marked(i)));
            }
        }
        sender->flush();
        for (std::size_t i = 0; i < peers.size(); ++i) {
            for (const Datagram& datagram : receive(*peers[i], kInRound)) {
                ASSERT_EQ(datagram, marked(arrived[i]));
                ++arrived[i];
            }
        }
    }
    for (const std::size_t count : arrived) EXPECT_EQ(count, kRounds * kInRound);
    EXPECT_EQ(sender->stats().datagrams_sent, peers.size() * kRounds * kInRound);
    for (const auto& [reason, count] : sender->drops()) EXPECT_EQ(count, 0U) << reason;
}

TEST_P(UdpBatch, a_datagram_of_no_bytes_arrives_as_such) {
    const auto a = open_any(GetParam());
    const auto b = open_any(GetParam());
    ASSERT_TRUE(a->send(loopback(b->local_port()), {}));
    a->flush();
    EXPECT_EQ(receive(*b, 1), std::vector<Datagram>(1));
}

TEST_P(UdpBatch, a_peer_that_has_gone_keeps_nothing_from_the_others) {
    const auto sender = open_any(GetParam());
    const auto here = open_any(GetParam());
    const Address gone = loopback(open_any()->local_port());
    for (std::size_t i = 0; i < 200; ++i) {
        EXPECT_TRUE(sender->send(gone, marked(i)));
        EXPECT_TRUE(sender->send(loopback(here->local_port()), marked(i)));
    }
    sender->flush();
    const std::vector<Datagram> received = receive(*here, 200);
    ASSERT_EQ(received.size(), 200U);
    for (std::size_t i = 0; i < received.size(); ++i) EXPECT_EQ(received[i], marked(i));
    EXPECT_EQ(sender->drops().at("send_failed"), 0U);
    EXPECT_EQ(sender->poll(0.0, [](const Address&, std::span<const std::uint8_t>) {}), 0U);
}

TEST_P(UdpBatch, what_the_receiver_has_no_room_for_is_counted_there) {
    constexpr std::size_t kMany = 20'000;
    const auto sender = open_any(GetParam());
    const auto receiver = open_any(GetParam());
    for (std::size_t i = 0; i < kMany; ++i) {
        ASSERT_TRUE(sender->send(loopback(receiver->local_port()), marked(i)));
    }
    sender->flush();
    ASSERT_EQ(sender->stats().datagrams_sent, kMany);
    const std::size_t received = receive(*receiver, kMany).size();
    EXPECT_LT(received, kMany);
    EXPECT_EQ(received + receiver->drops().at("receive_buffer_full"), kMany);
}

TEST(Udp, datagrams_leave_and_arrive_in_few_calls_of_the_system) {
    const auto a = open_any();
    const auto b = open_any();
    for (std::size_t i = 0; i < 60; ++i) a->send(loopback(b->local_port()), marked(i));
    EXPECT_EQ(a->stats().send_calls, 0U);
    a->flush();
    EXPECT_EQ(a->stats().send_calls, 1U);
    EXPECT_EQ(receive(*b, 60).size(), 60U);
    EXPECT_EQ(b->stats().receive_calls, 1U);
}

TEST(Udp, what_was_sent_leaves_with_the_next_poll_and_with_the_end_of_the_socket) {
    auto a = open_any();
    const auto b = open_any();
    const auto ignore = [](const Address&, std::span<const std::uint8_t>) {};
    a->send(loopback(b->local_port()), marked(1));
    a->poll(0.0, ignore);
    EXPECT_EQ(receive(*b, 1).size(), 1U);
    a->send(loopback(b->local_port()), marked(2));
    a.reset();
    EXPECT_EQ(receive(*b, 1).size(), 1U);
}

TEST(Udp, an_ipv6_address_is_refused_and_counted_by_a_socket_that_is_bound_to_ipv4) {
    std::string error;
    const auto v4 = UdpTransport::open("127.0.0.1", 0, error);
    ASSERT_TRUE(v4) << error;
    EXPECT_FALSE(v4->send(resolve("::1", 7777).address.value(), marked(1)));
    EXPECT_EQ(v4->drops().at("send_unroutable"), 1U);
    const auto other = UdpTransport::open("127.0.0.1", 0, error);
    EXPECT_TRUE(v4->send(loopback(other->local_port()), marked(1)));
    v4->flush();
    EXPECT_EQ(receive(*other, 1), std::vector<Datagram>{marked(1)});
}

TEST(Udp, a_port_in_use_is_named_together_with_a_remedy) {
    const auto first = open_any();
    std::string error;
    EXPECT_FALSE(UdpTransport::open("", first->local_port(), error));
    EXPECT_EQ(error, "UDP port " + std::to_string(first->local_port()) +
                         " is in use; stop the other server or choose another with --port");
}

TEST(Udp, a_foreign_address_cannot_be_bound_and_the_message_names_it) {
    std::string error;
    EXPECT_FALSE(UdpTransport::open("192.0.2.77", 0, error));
    EXPECT_NE(error.find("192.0.2.77"), std::string::npos) << error;
}

TEST(Udp, polling_an_idle_socket_returns_at_once_with_nothing) {
    EXPECT_EQ(open_any()->poll(0.0, [](const Address&, std::span<const std::uint8_t>) {}), 0U);
}

TEST(Address, what_is_written_can_be_read_back) {
    for (const std::string text : {"127.0.0.1:7777", "[::1]:1", "[2001:db8::7]:65535"}) {
        const Resolved resolved = resolve(text, 5);
        ASSERT_TRUE(resolved.address) << resolved.error;
        EXPECT_EQ(to_string(*resolved.address), text);
    }
}

TEST(Address, the_default_port_is_taken_where_none_is_given) {
    EXPECT_EQ(to_string(resolve("127.0.0.1", 7777).address.value()), "127.0.0.1:7777");
    EXPECT_EQ(to_string(resolve("::1", 7777).address.value()), "[::1]:7777");
    EXPECT_EQ(to_string(resolve("[::1]", 7777).address.value()), "[::1]:7777");
    EXPECT_EQ(resolve("localhost", 7777).address.value().port, 7777);
}

TEST(Address, what_is_no_address_is_explained) {
    for (const std::string text : {"", ":7777", "host:", "[::1", "[::1]x", "[::1]:", "h:0",
                                   "h:65536", "h:http", "h:-1", "h: 7"}) {
        const Resolved resolved = resolve(text, 7777);
        EXPECT_FALSE(resolved.address) << text;
        EXPECT_FALSE(resolved.error.empty());
    }
    EXPECT_NE(resolve("h:65536", 1).error.find("65536"), std::string::npos);
}

}  // namespace
}  // namespace fts::net
