// A reliable message from a server is any bytes: a value that can be sent on unchanged, or nothing.
#include <cstdlib>
#include <span>

#include "common/replication/wire.h"
#include "tests/fuzz/target.h"

using fts::replication::decode_server_message;
using fts::replication::encode;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto message = decode_server_message(std::span(data, size));
    if (!message) return 0;
    const auto bytes = encode(*message);
    const auto again = decode_server_message(bytes);
    if (bytes.empty() || !again || encode(*again) != bytes) std::abort();
    return 0;
}
