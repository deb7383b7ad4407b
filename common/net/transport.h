// How datagrams leave and arrive. Knows no message. Time, where it matters, is passed in.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fts::net {

// The largest UDP payload that is sent: below the smallest path MTU met in practice (IPv6 1280 -
// 48).
inline constexpr std::size_t kMaxDatagramBytes = 1200;

// An IPv4 address is held as its v4-mapped IPv6 form.
struct Address {
    std::array<std::uint8_t, 16> ip{};
    std::uint16_t port = 0;
    friend auto operator<=>(const Address&, const Address&) = default;
};
std::string to_string(const Address& address);
// Whether it names this machine itself: 127.0.0.0/8 or ::1.
bool is_loopback(const Address& address);

// "host:port", "host" (with the default port), "[v6]:port". Resolves names; the error says what is
// wrong and what to do about it.
struct Resolved {
    std::optional<Address> address;
    std::string error;
};
Resolved resolve(std::string_view host_and_port, std::uint16_t default_port);

// Why packets were dropped, by reason; a fixed set of names ("malformed", "bad_cookie", "replayed",
// ...).
using DropCounters = std::map<std::string_view, std::uint64_t>;

class Transport {
  public:
    virtual ~Transport() = default;

    // Sends one datagram of at most kMaxDatagramBytes, or keeps it until `flush` at the latest;
    // to one address in the order of the calls. False when it was dropped here.
    virtual bool send(const Address& to, std::span<const std::uint8_t> datagram) = 0;
    // Sends what was kept. Call after the last `send` of a tick.
    virtual void flush() {}

    using Receiver =
        std::function<void(const Address& from, std::span<const std::uint8_t> datagram)>;
    // Hands over every datagram that has arrived by `now_s`; never blocks. Returns how many.
    virtual std::size_t poll(double now_s, const Receiver& receiver) = 0;

    // What was lost here, on the way out or in.
    virtual DropCounters drops() const { return {}; }
};

}  // namespace fts::net
