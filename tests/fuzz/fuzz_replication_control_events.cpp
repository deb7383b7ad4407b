// A control part against a baseline of forty balls: what is decoded is sorted, of balls and ticks
// that there are, the same again when it is encoded, and can be replayed, whatever it says.
#include <cstdlib>
#include <span>
#include <vector>

#include "common/replication/arena_replay.h"
#include "common/replication/control_events.h"
#include "tests/fuzz/target.h"

namespace {

using namespace fts::replication;

Snapshot forty_balls() {
    Snapshot snapshot;
    snapshot.tick = 94;
    snapshot.phase = fts::game::Phase::kPlaying;
    for (std::uint16_t i = 0; i < 40; ++i) {
        BallState ball;
        ball.id = static_cast<std::uint16_t>(7 * i);
        ball.kind = static_cast<std::uint8_t>(i % 2);
        ball.x = 65536 * (i % 8);
        ball.y = 65536 * (i / 8);
        ball.radius = 1024;
        ball.mass = 65536;
        snapshot.balls.push_back(ball);
    }
    return snapshot;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Snapshot kBaseline = forty_balls();
    static const Course kCourse = course_of(fts::physics::Disc{12.0}, {});
    std::vector<std::uint8_t> bytes{100, 6};  // tick, age
    bytes.insert(bytes.end(), data, data + size);
    const auto part = decode_events(kBaseline, bytes);
    if (!part) return 0;
    if (!is_canonical(part->events)) std::abort();
    for (const auto& event : part->events.controls) {
        if (event.tick <= 94 || event.tick > 100) std::abort();
    }
    for (const auto& change : part->events.changes) {
        if (change.tick <= 94 || change.tick > 100) std::abort();
    }
    Snapshot outcome = replay(kCourse, kBaseline, part->tick, 2, part->events);
    if (!is_canonical(outcome)) std::abort();
    const auto again = encode_events(kBaseline, part->events, outcome);
    const auto same = decode_events(kBaseline, again);
    if (!same || same->events != part->events) std::abort();
    return 0;
}
