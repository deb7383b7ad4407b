// A part against a baseline that has everything in it. The input is a body: the header in front of
// it and the digest behind it are made here, since a fuzzer would hardly guess them.
#include <cstdlib>
#include <span>
#include <vector>

#include "common/replication/delta.h"
#include "common/replication/delta_format.h"
#include "tests/fuzz/target.h"

namespace {

using fts::replication::BallState;
using fts::replication::decode_part;
using fts::replication::encode_delta;
using fts::replication::Snapshot;
using fts::replication::delta_format::with_digest;

constexpr std::size_t kHeaderBytes = 5;  // tick, age, flags, digest
constexpr std::size_t kFlags = 2;
constexpr std::uint8_t kFlagsOfASinglePart = 0x0F;

Snapshot rich_baseline() {
    Snapshot baseline;
    baseline.tick = 100;
    baseline.level = 7;
    baseline.phase_end_tick = 5000;
    for (int i = 0; i < 40; ++i) {
        BallState ball;
        ball.id = static_cast<std::uint16_t>(i < 20 ? i : 1500 * i);
        ball.x = 400 * i - 9000;
        ball.y = i % 9 == 0 ? INT32_MAX - i : 300 * i;
        ball.vx = i % 7 == 0 ? INT32_MIN + i : 55 * (i - 20);
        ball.vy = -40 * i;
        ball.thrust_x = static_cast<std::int8_t>(i - 20);
        ball.brake = i % 2 == 0;
        ball.radius = 128;
        ball.mass = i % 3 == 0 ? 100'000 : 256;
        ball.kind = static_cast<std::uint8_t>(i % 2);
        ball.behaviour = static_cast<std::uint8_t>(i % 6);
        ball.player_id = static_cast<std::uint16_t>(i % 4);
        baseline.balls.push_back(ball);
        baseline.coins.push_back({.id = static_cast<std::uint16_t>(3 * i), .x = i, .y = -i});
    }
    return baseline;
}

std::vector<std::uint8_t> header_of(const Snapshot& baseline) {
    Snapshot next = baseline;
    next.tick += 3;
    std::vector<std::uint8_t> part = encode_delta(baseline, next, 2000).front();
    part.resize(kHeaderBytes);
    return part;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Snapshot kBaseline = rich_baseline();
    static const std::vector<std::uint8_t> kHeader = header_of(kBaseline);
    if (size == 0) return 0;
    std::vector<std::uint8_t> part = kHeader;
    part[kFlags] = data[0] & kFlagsOfASinglePart;
    part.insert(part.end(), data + 1, data + size);
    const auto snapshot = decode_part(kBaseline, with_digest(part));
    if (!snapshot) return 0;
    if (!is_canonical(*snapshot)) std::abort();
    if (snapshot->balls.size() > kBaseline.balls.size() + size) std::abort();
    const auto again = encode_delta(kBaseline, *snapshot, 2 * size + 4000);
    if (again.size() != 1 || decode_part(kBaseline, again.front()) != snapshot) std::abort();
    return 0;
}
