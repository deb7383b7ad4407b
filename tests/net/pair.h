// A listener and one dialer with a link between them, moved forward tick by tick.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/net/connection.h"
#include "common/net/simulated_link.h"
#include "tests/net/memory_network.h"

namespace fts::net {

inline constexpr double kTickS = 1.0 / 60.0;

// Everything that one end reported.
struct Log {
    std::vector<Connected> connected;
    std::vector<Disconnected> disconnected;
    std::vector<std::vector<std::uint8_t>> messages;
    std::vector<std::vector<std::uint8_t>> payloads;

    void take(std::vector<Event> events) {
        for (Event& event : events) {
            if (auto* up = std::get_if<Connected>(&event)) connected.push_back(*up);
            if (auto* down = std::get_if<Disconnected>(&event)) disconnected.push_back(*down);
            if (auto* message = std::get_if<ReliableMessage>(&event)) {
                messages.push_back(std::move(message->bytes));
            }
            if (auto* payload = std::get_if<UnreliablePayload>(&event)) {
                payloads.push_back(std::move(payload->bytes));
            }
        }
    }
};

class Pair {
  public:
    explicit Pair(const LinkConditions& conditions = {}, ListenerConfig listener_config = {},
                  DialerConfig dialer_config = {}) {
        listener_config.key = server_key;
        auto inner = std::make_unique<MemoryTransport>(network, client_address);
        client_memory = inner.get();
        client_link = std::make_unique<SimulatedLink>(std::move(inner), conditions);
        listener = std::make_unique<Listener>(listener_config, server_link);
        dialer_config.key = client_key;
        dialer_config.server = server_address;
        dialer = std::make_unique<Dialer>(dialer_config, *client_link);
    }

    void tick() {
        now_s += kTickS;
        tick_server();
        tick_client();
    }
    void tick_server() {
        server_link.poll(now_s, [&](const Address& from, std::span<const std::uint8_t> bytes) {
            listener->receive(from, bytes, now_s);
        });
        listener->update(now_s);
        server.take(listener->drain_events());
    }
    void tick_client() {
        client_link->poll(now_s, [&](const Address& from, std::span<const std::uint8_t> bytes) {
            dialer->receive(from, bytes, now_s);
        });
        dialer->update(now_s);
        client.take(dialer->drain_events());
    }
    void run(double duration_s) {
        for (const double end_s = now_s + duration_s; now_s < end_s;) tick();
    }
    // False when it has not come about in time.
    bool run_until(const std::function<bool()>& condition, double patience_s) {
        for (const double end_s = now_s + patience_s; !condition() && now_s < end_s;) tick();
        return condition();
    }
    bool connect(double patience_s = 20.0) {
        return run_until([&] { return !client.connected.empty() && !server.connected.empty(); },
                         patience_s);
    }
    ConnectionId id() const { return server.connected.at(0).id; }

    KeyPair server_key = generate_key_pair();
    KeyPair client_key = generate_key_pair();
    Address server_address = address_of(1);
    Address client_address = address_of(2, 40000);
    MemoryNetwork network;
    MemoryTransport server_link{network, server_address};
    MemoryTransport* client_memory = nullptr;  // what is behind client_link
    std::unique_ptr<SimulatedLink> client_link;
    std::unique_ptr<Listener> listener;
    std::unique_ptr<Dialer> dialer;
    Log server, client;
    double now_s = 100.0;
};

inline std::vector<std::uint8_t> bytes_of(std::string_view text) {
    return {text.begin(), text.end()};
}

}  // namespace fts::net
