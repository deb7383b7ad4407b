#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "common/net/connection.h"
#include "common/net/drops.h"
#include "common/net/half_open.h"
#include "common/net/handshake.h"
#include "common/net/session.h"

namespace fts::net {

struct Listener::Impl {
    struct Established {
        Session session;
        EphemeralKey ephemeral;
    };

    Impl(const ListenerConfig& listener_config, Transport& listener_transport)
        : config(listener_config), transport(listener_transport) {}
    ~Impl() { wipe(config.key.secret_key); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void receive_handshake(const Address& from, Bytes datagram);
    void receive_sealed(const Address& from, ConnectionId id, Bytes datagram);
    void receive_hello(const Address& from, Bytes datagram);
    void receive_connect(const Address& from, Bytes datagram);
    void begin_handshake(const Address& from, const Connect& packet);
    void receive_finish(const Address& from, Bytes datagram);
    void refuse(const Address& to, Bytes datagram, RefusalReason reason, std::string_view drop);
    void end(ConnectionId id, DisconnectReason reason, std::string_view detail);
    ConnectionId unused_id();

    ListenerConfig config;
    Transport& transport;
    CookieJar cookies;
    DropCounters drops = drop::make_counters();
    HalfOpenTable half_open;
    std::unordered_map<ConnectionId, Established> sessions;
    std::vector<Event> events;
    std::optional<std::uint16_t> foreign_version;
    ConnectionId last_id = 0;
    double now_s = 0.0;
};

void Listener::Impl::receive_handshake(const Address& from, Bytes datagram) {
    const std::optional<Header> header = decode_header(datagram);
    if (!header) return refuse(from, datagram, RefusalReason::kMalformed, drop::kMalformed);
    const bool is_from_client = header->type == PacketType::kHello ||
                                header->type == PacketType::kConnect ||
                                header->type == PacketType::kFinish;
    if (!is_from_client) {
        ++drops[drop::kUnexpected];
        return;
    }
    if (header->version != config.protocol_version) {
        foreign_version = header->version;
        return refuse(from, datagram, RefusalReason::kWrongVersion, drop::kWrongVersion);
    }
    if (header->type == PacketType::kHello) return receive_hello(from, datagram);
    if (header->type == PacketType::kConnect) return receive_connect(from, datagram);
    receive_finish(from, datagram);
}

void Listener::Impl::receive_hello(const Address& from, Bytes datagram) {
    const std::optional<Hello> packet = decode_hello(datagram);
    if (!packet) return refuse(from, datagram, RefusalReason::kMalformed, drop::kMalformed);
    if (sessions.size() >= config.max_connections) {
        return refuse(from, datagram, RefusalReason::kServerFull, drop::kServerFull);
    }
    const Cookie cookie = cookies.bake(from, packet->ephemeral, now_s);
    transport.send(from, encode(CookieReply{packet->ephemeral, cookie}, config.protocol_version));
}

void Listener::Impl::receive_connect(const Address& from, Bytes datagram) {
    const std::optional<Connect> packet = decode_connect(datagram);
    if (!packet) return refuse(from, datagram, RefusalReason::kMalformed, drop::kMalformed);
    if (!cookies.recognises(packet->cookie, from, packet->ephemeral, now_s)) {
        ++drops[drop::kBadCookie];
        const Cookie cookie = cookies.bake(from, packet->ephemeral, now_s);
        transport.send(from,
                       encode(CookieReply{packet->ephemeral, cookie}, config.protocol_version));
        return;
    }
    if (const HalfOpen* known = half_open.find(from, packet->ephemeral)) {
        transport.send(from, known->response);
        return;
    }
    const bool is_established =
        std::any_of(sessions.begin(), sessions.end(),
                    [&](const auto& entry) { return entry.second.ephemeral == packet->ephemeral; });
    if (is_established) {
        ++drops[drop::kUnexpected];
        return;
    }
    if (sessions.size() >= config.max_connections) {
        return refuse(from, datagram, RefusalReason::kServerFull, drop::kServerFull);
    }
    if (!half_open.has_room_for(from)) {
        ++drops[drop::kHalfOpenLimit];
        return;
    }
    begin_handshake(from, *packet);
}

void Listener::Impl::begin_handshake(const Address& from, const Connect& packet) {
    NoiseXX noise(NoiseXX::Role::kResponder, config.key, generate_key_pair(),
                  handshake_prologue(config.protocol_version));
    const ConnectionId id = unused_id();
    std::array<std::uint8_t, sizeof(id)> payload{};
    ByteWriter(payload).put(id);
    if (!noise.read(packet.ephemeral)) {
        ++drops[drop::kBadHandshake];
        return;
    }
    auto message = noise.write(payload);
    if (!message) {
        ++drops[drop::kBadHandshake];
        return;
    }
    Datagram response =
        encode(Response{packet.ephemeral, std::move(*message)}, config.protocol_version);
    const HalfOpen& added =
        half_open.add({id, from, packet.ephemeral, noise, std::move(response), now_s});
    transport.send(from, added.response);
}

void Listener::Impl::receive_finish(const Address& from, Bytes datagram) {
    const std::optional<Finish> packet = decode_finish(datagram);
    if (!packet) return refuse(from, datagram, RefusalReason::kMalformed, drop::kMalformed);
    if (const auto found = sessions.find(packet->id); found != sessions.end()) {
        ++drops[drop::kUnexpected];
        if (from == found->second.session.address()) found->second.session.ping(now_s);
        return;
    }
    HalfOpen* pending = half_open.find(packet->id);
    if (pending == nullptr || pending->address != from) {
        ++drops[drop::kUnknownSession];
        return;
    }
    if (!pending->noise.read(packet->noise)) {
        ++drops[drop::kBadHandshake];
        return;
    }
    const PublicKey peer = pending->noise.peer_identity();
    Session session(packet->id, pending->noise.split(), from, config.timeout_s, now_s, transport,
                    drops);
    const EphemeralKey ephemeral = pending->ephemeral;
    half_open.remove(packet->id);
    if (sessions.size() >= config.max_connections) {
        ++drops[drop::kServerFull];
        session.say_goodbye(DisconnectReason::kServerFull, "the server is full", now_s);
        return;
    }
    events.emplace_back(Connected{packet->id, peer, from});
    const auto added =
        sessions.emplace(packet->id, Established{std::move(session), ephemeral}).first;
    added->second.session.ping(now_s);
}

void Listener::Impl::receive_sealed(const Address& from, ConnectionId id, Bytes datagram) {
    const auto found = sessions.find(id);
    if (found == sessions.end()) {
        ++drops[drop::kUnknownSession];
        return;
    }
    if (events.size() >= kMaxWaitingEvents) {
        ++drops[drop::kEventsFull];
        return;
    }
    Channel::Received received;
    Session& session = found->second.session;
    const Session::Outcome outcome = session.receive(from, datagram, now_s, received);
    if (outcome == Session::Outcome::kDropped) return;
    const auto goodbye = received.goodbye;
    append_events(id, std::move(received), events);
    if (outcome == Session::Outcome::kProtocolError) {
        session.say_goodbye(DisconnectReason::kProtocolError, "a packet made no sense", now_s);
        end(id, DisconnectReason::kProtocolError, "a packet made no sense");
    } else if (goodbye) {
        end(id, goodbye->reason, goodbye->detail);
    }
}

void Listener::Impl::refuse(const Address& to, Bytes datagram, RefusalReason reason,
                            std::string_view drop) {
    ++drops[drop];
    if (datagram.size() < kRefusedBytes) return;
    transport.send(to, encode(Refused{echo_of(datagram), reason}, config.protocol_version));
}

void Listener::Impl::end(ConnectionId id, DisconnectReason reason, std::string_view detail) {
    events.emplace_back(Disconnected{id, reason, std::string(detail), 0});
    sessions.erase(id);
}

ConnectionId Listener::Impl::unused_id() {
    do {
        ++last_id;
    } while (last_id == 0 || sessions.contains(last_id) || half_open.find(last_id) != nullptr);
    return last_id;
}

Listener::Listener(const ListenerConfig& config, Transport& transport)
    : impl_(std::make_unique<Impl>(config, transport)) {}
Listener::~Listener() = default;

void Listener::receive(const Address& from, std::span<const std::uint8_t> datagram, double now_s) {
    impl_->now_s = now_s;
    if (const auto id = sealed_packet_id(datagram)) {
        impl_->receive_sealed(from, *id, datagram);
    } else if (has_magic(datagram)) {
        impl_->receive_handshake(from, datagram);
    } else {
        ++impl_->drops[drop::kMalformed];
    }
}

void Listener::update(double now_s) {
    impl_->now_s = now_s;
    impl_->half_open.expire(now_s);
    std::vector<ConnectionId> silent;
    for (auto& [id, established] : impl_->sessions) {
        established.session.update(now_s);
        if (established.session.has_timed_out(now_s)) silent.push_back(id);
    }
    for (const ConnectionId id : silent) {
        disconnect(id, DisconnectReason::kTimeout, "nothing was heard for too long");
    }
}

std::vector<Event> Listener::drain_events() {
    return std::exchange(impl_->events, {});
}

bool Listener::send_unreliable(ConnectionId id, std::span<const std::uint8_t> payload) {
    const auto found = impl_->sessions.find(id);
    return found != impl_->sessions.end() &&
           found->second.session.send_payload(payload, impl_->now_s);
}

bool Listener::send_reliable(ConnectionId id, std::span<const std::uint8_t> message) {
    const auto found = impl_->sessions.find(id);
    return found != impl_->sessions.end() && found->second.session.queue_reliable(message);
}

void Listener::disconnect(ConnectionId id, DisconnectReason reason, std::string_view detail) {
    const auto found = impl_->sessions.find(id);
    if (found == impl_->sessions.end()) return;
    found->second.session.say_goodbye(reason, detail, impl_->now_s);
    impl_->end(id, reason, detail);
}

void Listener::close(std::string_view detail) {
    while (!impl_->sessions.empty()) {
        disconnect(impl_->sessions.begin()->first, DisconnectReason::kClosed, detail);
    }
}

std::size_t Listener::connection_count() const {
    return impl_->sessions.size();
}

std::optional<LinkStats> Listener::stats(ConnectionId id) const {
    const auto found = impl_->sessions.find(id);
    if (found == impl_->sessions.end()) return std::nullopt;
    return found->second.session.stats();
}

const DropCounters& Listener::drops() const {
    return impl_->drops;
}

std::optional<std::uint16_t> Listener::last_foreign_version() const {
    return impl_->foreign_version;
}

}  // namespace fts::net
