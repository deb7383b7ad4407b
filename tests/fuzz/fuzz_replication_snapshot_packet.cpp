// A snapshot packet is any bytes: it carries a part that says what it is part of, or is nothing.
#include <algorithm>
#include <cstdlib>
#include <span>

#include "common/replication/control_events.h"
#include "common/replication/delta.h"
#include "common/replication/wire.h"
#include "tests/fuzz/target.h"

using fts::replication::decode_snapshot_packet;
using fts::replication::encode;
using fts::replication::peek_control_part;
using fts::replication::peek_part;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::uint8_t> bytes(data, size);
    const auto packet = decode_snapshot_packet(bytes);
    if (!packet) return 0;
    const bool of_states = fts::replication::tells_states(packet->kind);
    if (of_states && !peek_part(packet->part)) std::abort();
    if (!of_states && !peek_control_part(packet->part)) std::abort();
    const auto again = encode(*packet);
    if (!std::equal(again.begin(), again.end(), bytes.begin(), bytes.end())) std::abort();
    return 0;
}
