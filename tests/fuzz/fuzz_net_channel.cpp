// Plaintext packets of a peer that has finished its handshake and lost its manners, into a Channel
// that has things of its own to send. It may not crash, nor hold more than its limits.
//
// The input is a list of records {number to skip, size, bytes}.

#include <algorithm>
#include <array>
#include <cstdlib>

#include "common/net/channel.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace fts::net;
    Channel channel;
    std::array<std::uint8_t, kMaxPlaintextBytes> plaintext{};
    channel.queue_reliable(std::vector<std::uint8_t>(5000));
    double now_s = 0.0;
    std::uint64_t number = 1;

    ByteReader input({data, size});
    while (input.rest().size() >= 2) {
        number += input.take<std::uint8_t>();
        const std::size_t wanted = std::size_t{input.take<std::uint8_t>()} * 5;
        const Bytes bytes = input.take_bytes(
            std::min({wanted, input.rest().size(), std::size_t{kMaxPlaintextBytes}}));
        now_s += 0.02;
        channel.update(now_s);
        while (channel.has_fragments_due(now_s)) channel.write(now_s, plaintext);
        if (!channel.is_fresh(number)) continue;
        Channel::Received received;
        if (!channel.read(number, bytes, now_s, received)) return 0;
        for (const auto& message : received.messages) {
            if (message.size() > kMaxMessageBytes) std::abort();
        }
        if (received.payload && received.payload->size() > kMaxPayloadBytes) std::abort();
        if (received.goodbye && received.goodbye->detail.size() > kMaxDetailBytes) std::abort();
    }
    return 0;
}
