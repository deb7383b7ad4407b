#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/net/connection.h"
#include "common/net/drops.h"
#include "common/net/handshake.h"
#include "common/net/session.h"

namespace fts::net {
namespace {

// A step of the handshake is sent again after this long, then after longer and longer.
constexpr double kFirstRetryS = 0.2;
constexpr double kRetryGrowth = 1.5;
constexpr double kMaxRetryS = 0.5;

std::string seconds(double duration_s) {
    return std::to_string(static_cast<int>(std::lround(duration_s))) + " s";
}

}  // namespace

struct Dialer::Impl {
    enum class Step : std::uint8_t { kHello, kConnect, kFinish, kConnected, kDisconnected };

    Impl(const DialerConfig& dialer_config, Transport& dialer_transport)
        : config(dialer_config), transport(dialer_transport) {}
    ~Impl() { wipe(config.key.secret_key); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    bool is_connecting() const { return step < Step::kConnected; }
    void start(double now);
    void enter(Step next, Datagram datagram);
    void resend_when_due();
    void receive_handshake(Bytes datagram);
    void receive_cookie(Bytes datagram);
    void receive_response(Bytes datagram);
    void receive_refused(Bytes datagram, std::uint16_t server_version);
    void receive_sealed(const Address& from, Bytes datagram);
    void end(DisconnectReason reason, std::string_view detail, std::uint16_t peer_version = 0);
    std::string server_name() const { return to_string(config.server); }

    DialerConfig config;
    Transport& transport;
    DropCounters drops = drop::make_counters();
    Step step = Step::kHello;
    std::vector<Event> events;
    double now_s = 0.0;

    KeyPair ephemeral = generate_key_pair();
    std::optional<NoiseXX> noise;
    bool has_heard = false;
    double progress_at_s = 0.0;
    Datagram opening;
    double sent_at_s = 0.0;
    double retry_after_s = kFirstRetryS;

    ConnectionId wire_id = 0;
    std::optional<Session> session;
};

void Dialer::Impl::start(double now) {
    noise.emplace(NoiseXX::Role::kInitiator, config.key, ephemeral,
                  handshake_prologue(config.protocol_version));
    wipe(ephemeral.secret_key);
    now_s = now;
    noise->write({});  // message 1 is the ephemeral key itself
    enter(Step::kHello, encode(Hello{ephemeral.public_key}, config.protocol_version));
}

void Dialer::Impl::enter(Step next, Datagram datagram) {
    step = next;
    opening = std::move(datagram);
    progress_at_s = now_s;
    retry_after_s = kFirstRetryS;
    sent_at_s = now_s;
    transport.send(config.server, opening);
}

void Dialer::Impl::resend_when_due() {
    if (now_s - progress_at_s > config.timeout_s) {
        if (has_heard) {
            return end(DisconnectReason::kTimeout,
                       server_name() + " stopped answering for " + seconds(config.timeout_s));
        }
        return end(DisconnectReason::kUnreachable,
                   "no answer from " + server_name() + " within " + seconds(config.timeout_s) +
                       "; is the server running, and is its UDP port open?");
    }
    if (now_s - sent_at_s < retry_after_s) return;
    sent_at_s = now_s;
    retry_after_s = std::min(retry_after_s * kRetryGrowth, kMaxRetryS);
    transport.send(config.server, opening);
}

void Dialer::Impl::receive_handshake(Bytes datagram) {
    const std::optional<Header> header = decode_header(datagram);
    if (!header) {
        ++drops[drop::kMalformed];
    } else if (!is_connecting()) {
        ++drops[drop::kUnexpected];
    } else if (header->type == PacketType::kRefused) {
        receive_refused(datagram, header->version);
    } else if (header->version != config.protocol_version) {
        ++drops[drop::kWrongVersion];
    } else if (header->type == PacketType::kCookie) {
        receive_cookie(datagram);
    } else if (header->type == PacketType::kResponse) {
        receive_response(datagram);
    } else {
        ++drops[drop::kUnexpected];
    }
}

void Dialer::Impl::receive_cookie(Bytes datagram) {
    const std::optional<CookieReply> packet = decode_cookie(datagram);
    if (!packet || packet->echo != ephemeral.public_key) {
        ++drops[drop::kMalformed];
        return;
    }
    has_heard = true;
    Datagram connect =
        encode(Connect{ephemeral.public_key, packet->cookie}, config.protocol_version);
    if (step == Step::kHello) {
        enter(Step::kConnect, std::move(connect));
    } else if (step == Step::kConnect) {
        opening = std::move(connect);  // the earlier cookie has gone stale
    } else {
        ++drops[drop::kUnexpected];
    }
}

void Dialer::Impl::receive_response(Bytes datagram) {
    const std::optional<Response> packet = decode_response(datagram);
    if (!packet || packet->echo != ephemeral.public_key) {
        ++drops[drop::kMalformed];
        return;
    }
    if (step != Step::kConnect) {
        ++drops[drop::kUnexpected];
        return;
    }
    const auto payload = noise->read(packet->noise);
    if (!payload) {
        ++drops[drop::kBadHandshake];
        return;
    }
    const PublicKey& server_key = noise->peer_identity();
    if (config.pinned_server_key &&
        !equal_in_constant_time(server_key, *config.pinned_server_key)) {
        return end(DisconnectReason::kKeyChanged,
                   server_name() + " has the key " + short_name(server_key) + ", not " +
                       short_name(*config.pinned_server_key) + " as before");
    }
    wire_id = ByteReader(*payload).take<ConnectionId>();
    auto message = noise->write({});
    if (!message) {
        return end(DisconnectReason::kProtocolError, server_name() + " has a worthless key");
    }
    session.emplace(wire_id, noise->split(), config.server, config.timeout_s, now_s, transport,
                    drops);
    enter(Step::kFinish, encode(Finish{wire_id, std::move(*message)}, config.protocol_version));
}

void Dialer::Impl::receive_refused(Bytes datagram, std::uint16_t server_version) {
    const std::optional<Refused> packet = decode_refused(datagram);
    if (!packet || packet->echo != ephemeral.public_key) {
        ++drops[drop::kMalformed];
        return;
    }
    switch (packet->reason) {
        case RefusalReason::kWrongVersion:
            return end(DisconnectReason::kWrongVersion,
                       server_name() + " speaks protocol version " +
                           std::to_string(server_version) + ", this program version " +
                           std::to_string(config.protocol_version) + "; update the older one",
                       server_version);
        case RefusalReason::kServerFull:
            return end(DisconnectReason::kServerFull, server_name() + " is full; try again later");
        case RefusalReason::kMalformed:
            return end(
                DisconnectReason::kRefused,
                server_name() + " could not read our packets; something on the way alters them");
    }
}

void Dialer::Impl::receive_sealed(const Address& from, Bytes datagram) {
    if (!session || step == Step::kDisconnected || sealed_packet_id(datagram) != wire_id) {
        ++drops[drop::kUnknownSession];
        return;
    }
    if (events.size() >= kMaxWaitingEvents) {
        ++drops[drop::kEventsFull];
        return;
    }
    Channel::Received received;
    const Session::Outcome outcome = session->receive(from, datagram, now_s, received);
    if (outcome == Session::Outcome::kDropped) return;
    if (step == Step::kFinish && !received.goodbye) {
        step = Step::kConnected;
        events.emplace_back(Connected{0, noise->peer_identity(), config.server});
        noise.reset();
    }
    const auto goodbye = received.goodbye;
    append_events(0, std::move(received), events);
    if (outcome == Session::Outcome::kProtocolError) {
        session->say_goodbye(DisconnectReason::kProtocolError, "a packet made no sense", now_s);
        end(DisconnectReason::kProtocolError, "a packet from " + server_name() + " made no sense");
    } else if (goodbye) {
        end(goodbye->reason, goodbye->detail);
    }
}

void Dialer::Impl::end(DisconnectReason reason, std::string_view detail,
                       std::uint16_t peer_version) {
    step = Step::kDisconnected;
    events.emplace_back(Disconnected{0, reason, std::string(detail), peer_version});
    noise.reset();
}

Dialer::Dialer(const DialerConfig& config, Transport& transport)
    : impl_(std::make_unique<Impl>(config, transport)) {}
Dialer::~Dialer() = default;

void Dialer::receive(const Address& from, std::span<const std::uint8_t> datagram, double now_s) {
    impl_->now_s = now_s;
    if (sealed_packet_id(datagram)) {
        impl_->receive_sealed(from, datagram);
    } else if (from == impl_->config.server && has_magic(datagram)) {
        impl_->receive_handshake(datagram);
    } else {
        ++impl_->drops[drop::kMalformed];
    }
}

void Dialer::update(double now_s) {
    impl_->now_s = now_s;
    if (impl_->step == Impl::Step::kDisconnected) return;
    if (impl_->opening.empty()) return impl_->start(now_s);
    if (impl_->is_connecting()) return impl_->resend_when_due();
    impl_->session->update(now_s);
    if (impl_->session->has_timed_out(now_s)) {
        impl_->session->say_goodbye(DisconnectReason::kTimeout, "nothing was heard for too long",
                                    now_s);
        impl_->end(DisconnectReason::kTimeout, "nothing was heard from " + impl_->server_name() +
                                                   " for " + seconds(impl_->config.timeout_s));
    }
}

std::vector<Event> Dialer::drain_events() {
    return std::exchange(impl_->events, {});
}

bool Dialer::send_unreliable(std::span<const std::uint8_t> payload) {
    return impl_->step == Impl::Step::kConnected &&
           impl_->session->send_payload(payload, impl_->now_s);
}

bool Dialer::send_reliable(std::span<const std::uint8_t> message) {
    return impl_->step == Impl::Step::kConnected && impl_->session->queue_reliable(message);
}

void Dialer::close(std::string_view detail) {
    if (impl_->step == Impl::Step::kDisconnected) return;
    if (impl_->session) {
        impl_->session->say_goodbye(DisconnectReason::kClosed, detail, impl_->now_s);
    }
    impl_->end(DisconnectReason::kClosed, detail);
}

Dialer::State Dialer::state() const {
    if (impl_->is_connecting()) return State::kConnecting;
    return impl_->step == Impl::Step::kConnected ? State::kConnected : State::kDisconnected;
}

LinkStats Dialer::stats() const {
    return impl_->session ? impl_->session->stats() : LinkStats{};
}

const DropCounters& Dialer::drops() const {
    return impl_->drops;
}

}  // namespace fts::net
