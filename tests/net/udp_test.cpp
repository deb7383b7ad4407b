// Real sockets on the loopback interface.

#include <gtest/gtest.h>

#include "common/net/connection.h"
#include "common/net/udp_transport.h"
#include "tests/net/pair.h"

namespace fts::net {
namespace {

std::unique_ptr<UdpTransport> open_any() {
    std::string error;
    auto transport = UdpTransport::open("", 0, error);
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
        server_socket->wait_readable(0.02);
        server_socket->poll(now_s, [&](const Address& from, std::span<const std::uint8_t> bytes) {
            listener.receive(from, bytes, now_s);
        });
        listener.update(now_s);
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
