// A residual part against what is expected of a baseline that has everything in it. The header in
// front of the input, which a fuzzer would hardly guess, is made here; whatever its bits say is
// decoded before the digest refuses it.
#include <cstdlib>
#include <span>
#include <vector>

#include "common/replication/snapshot_codec.h"
#include "tests/fuzz/target.h"

namespace {

using fts::replication::BallState;
using fts::replication::decode_balls;
using fts::replication::Doubt;
using fts::replication::encode_balls;
using fts::replication::Expectation;
using fts::replication::kDoubts;
using fts::replication::Prediction;

Prediction rich_prediction() {
    Prediction prediction{97, 100, {}};
    for (std::uint32_t i = 0; i < 60; ++i) {
        const auto n = static_cast<std::int32_t>(i);
        Expectation ball;
        ball.state.id = static_cast<std::uint16_t>(i < 30 ? i : 1000 * i);
        ball.state.x = i % 9 == 0 ? INT32_MAX - n : 300 * n;
        ball.state.vx = i % 7 == 0 ? INT32_MIN + n : 55 * (n - 20);
        ball.state.radius = 128;
        ball.state.mass = i % 5 == 0 ? 0 : 256U << i % 20;
        ball.state.kind = static_cast<std::uint8_t>(i % 2);
        ball.speed_doubt = static_cast<Doubt>(i % kDoubts);
        ball.speed_doubt_left = static_cast<Doubt>(i / 3 % kDoubts);
        ball.place_doubt = static_cast<Doubt>(5 * i % kDoubts);
        ball.lever = i % 4 == 0 ? INT32_MAX : 70'000 * n;
        ball.timed = i % 3 != 0;
        ball.lean_x = i % 2 == 0 ? 16384 : 0;
        ball.lean_y = i % 6 == 0 ? -9000 : 0;
        ball.group = i - i % 3;
        prediction.balls.push_back(ball);
    }
    return prediction;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Prediction kExpected = rich_prediction();
    std::vector<std::uint8_t> part{100, 3};  // tick, age
    part.insert(part.end(), data, data + size);
    const auto balls = decode_balls(kExpected, part);
    if (!balls) return 0;
    // Three bytes at the least make a new ball.
    if (balls->size() > kExpected.balls.size() + size) std::abort();
    const auto again = encode_balls(kExpected, *balls, 100 * size + 4000);
    if (again.size() != 1) return 0;
    const auto same = decode_balls(kExpected, again.front());
    if (!same || *same != *balls) std::abort();
    return 0;
}
