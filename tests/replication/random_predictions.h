// Predictions of every kind, good and bad, for snapshots from a seed.
#pragma once

#include <span>

#include "common/replication/prediction.h"
#include "tests/replication/random_snapshots.h"

namespace fts::replication::testing {

// That `before` stays as it is, with doubts, levers, leans and groups at random.
inline Prediction wild_prediction(Rng& rng, const Snapshot& before, Tick tick) {
    Prediction prediction{before.tick, tick, {}};
    const auto any = [&] { return static_cast<Doubt>(pick(rng, 0, kDoubts - 1)); };
    for (const BallState& ball : before.balls) {
        Expectation expected;
        expected.state = ball;
        expected.speed_doubt = any();
        expected.speed_doubt_left = any();
        expected.place_doubt = any();
        expected.lever = static_cast<std::int32_t>(pick(rng, 0, INT32_MAX));
        expected.timed = chance(rng, 50);
        if (chance(rng, 50)) {
            expected.lean_x = static_cast<std::int32_t>(pick(rng, -20'000, 20'000));
            expected.lean_y = static_cast<std::int32_t>(pick(rng, -20'000, 20'000));
        }
        const auto index = static_cast<std::uint32_t>(prediction.balls.size());
        expected.group = index;
        if (index > 0 && chance(rng, 40)) expected.group = prediction.balls.back().group;
        prediction.balls.push_back(expected);
    }
    return prediction;
}

}  // namespace fts::replication::testing
