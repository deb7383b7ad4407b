// Datagrams from strangers into a Listener and a Dialer that is busy connecting to it. Neither may
// crash or grow, and the Listener may never answer with more than it was sent.
//
// The input is a list of records {flavour, size, bytes}; some flavours put a plausible beginning
// before the bytes, so that the decoders behind it are reached.

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "common/net/connection.h"
#include "common/net/handshake.h"
#include "common/net/session.h"
#include "tests/fuzz/target.h"

namespace {

using namespace fts::net;

// Keeps what was sent until it is asked for.
class Outbox final : public Transport {
  public:
    bool send(const Address& to, std::span<const std::uint8_t> datagram) override {
        sent.emplace_back(to, Datagram(datagram.begin(), datagram.end()));
        bytes += datagram.size();
        return true;
    }
    std::size_t poll(double, const Receiver&) override { return 0; }

    std::vector<std::pair<Address, Datagram>> sent;
    std::size_t bytes = 0;
};

const Address kServer{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 10, 0, 0, 1}, 7777};
const Address kClient{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 10, 0, 0, 2}, 4000};
const Address kStranger{{0x20, 0x01, 0xd, 0xb8}, 9};

enum Flavour : std::uint8_t { kRaw, kHandshake, kSealed, kLetThrough, kAlterAndLetThrough, kCount };

Datagram make_datagram(std::uint8_t flavour, Bytes bytes) {
    Datagram datagram;
    if (flavour == kHandshake) datagram.assign(kMagic.begin(), kMagic.end());
    if (flavour == kSealed) datagram = {kSealedMarker, 1, 0, 0, 0};
    datagram.insert(datagram.end(), bytes.begin(), bytes.end());
    if (flavour == kHandshake && bytes.size() % 2 == 1) datagram.resize(kClientOpeningBytes);
    return datagram;
}

void exchange(Outbox& from_client, Outbox& from_server, Listener& listener, Dialer& dialer,
              double now_s, Bytes alteration) {
    const auto alter = [&](Datagram& datagram) {
        if (alteration.size() >= 2 && !datagram.empty()) {
            const std::size_t at = alteration[0] * datagram.size() / 256;
            datagram[at] = static_cast<std::uint8_t>(datagram[at] ^ alteration[1]);
        }
    };
    for (auto& [to, datagram] : std::exchange(from_client.sent, {})) {
        alter(datagram);
        listener.receive(kClient, datagram, now_s);
    }
    for (auto& [to, datagram] : std::exchange(from_server.sent, {})) {
        alter(datagram);
        if (to == kClient) dialer.receive(kServer, datagram, now_s);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const KeyPair server_key = generate_key_pair();
    static const KeyPair client_key = generate_key_pair();
    Outbox from_server;
    Outbox from_client;
    Listener listener({.key = server_key, .max_connections = 4}, from_server);
    Dialer dialer({.key = client_key, .server = kServer}, from_client);
    double now_s = 0.0;

    ByteReader input({data, size});
    while (input.rest().size() >= 2) {
        const auto flavour = static_cast<std::uint8_t>(input.take<std::uint8_t>() % kCount);
        const std::size_t wanted = std::size_t{input.take<std::uint8_t>()} * 5;
        const Bytes bytes = input.take_bytes(std::min(wanted, input.rest().size()));
        now_s += 0.05;
        if (flavour == kLetThrough || flavour == kAlterAndLetThrough) {
            dialer.update(now_s);
            listener.update(now_s);
            exchange(from_client, from_server, listener, dialer, now_s,
                     flavour == kAlterAndLetThrough ? bytes : Bytes{});
            continue;
        }
        const Datagram datagram = make_datagram(flavour, bytes);
        const std::size_t before = from_server.bytes;
        listener.receive(kStranger, datagram, now_s);
        if (from_server.bytes - before > datagram.size()) std::abort();
        dialer.receive(kServer, datagram, now_s);
        if (listener.connection_count() > 4) std::abort();
    }
    listener.drain_events();
    dialer.drain_events();
    return 0;
}
