// An input packet is any bytes: at most so many inputs, the same when sent on, or nothing.
#include <cstdlib>
#include <span>

#include "common/replication/wire.h"
#include "tests/fuzz/target.h"

using fts::replication::decode_input_packet;
using fts::replication::encode;
using fts::replication::kMaxInputPacketBytes;
using fts::replication::kMaxInputsPerPacket;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto packet = decode_input_packet(std::span(data, size));
    if (!packet) return 0;
    if (packet->inputs.size() > kMaxInputsPerPacket) std::abort();
    const auto bytes = encode(*packet);
    const auto again = decode_input_packet(bytes);
    if (bytes.size() > kMaxInputPacketBytes || !again || again->inputs != packet->inputs) {
        std::abort();
    }
    return 0;
}
