// A control part against a baseline of forty balls: what is decoded is sorted, of balls and ticks
// that there are, and the same again when it is encoded.
#include <cstdlib>
#include <span>
#include <vector>

#include "common/replication/control_events.h"
#include "tests/fuzz/target.h"

namespace {

using fts::replication::BallState;
using fts::replication::decode_events;
using fts::replication::encode_events;

std::vector<BallState> forty_balls() {
    std::vector<BallState> balls(40);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        balls[i].id = static_cast<std::uint16_t>(7 * i);
        balls[i].kind = static_cast<std::uint8_t>(i % 2);
    }
    return balls;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::vector<BallState> kBaseline = forty_balls();
    std::vector<std::uint8_t> bytes{100, 6};  // tick, age
    bytes.insert(bytes.end(), data, data + size);
    const auto part = decode_events(kBaseline, 94, bytes);
    if (!part) return 0;
    if (!is_canonical(part->events)) std::abort();
    for (const auto& event : part->events) {
        if (event.tick < 94 || event.tick >= 100 || event.ball % 7 != 0) std::abort();
    }
    const auto again = encode_events(kBaseline, 94, 100, part->events, kBaseline);
    const auto same = decode_events(kBaseline, 94, again);
    if (!same || same->events != part->events) std::abort();
    return 0;
}
