// What both ends expect of a snapshot from a baseline that both hold, and how sure they are: all
// that the codec (snapshot_codec.h) is told besides the snapshot. Made of the same numbers by the
// same arithmetic, it is the same to the last bit at both ends (predictor.h); how good it is
// decides how few bits are left to send, and nothing else.
#pragma once

#include <cstdint>
#include <vector>

#include "common/replication/residual_model.h"
#include "common/replication/snapshot.h"

namespace fts::replication {

// In the units of whoever quantised: a residual is truth less expectation, in steps.
struct Expectation {
    BallState state;
    // How far the velocity may be off: before anything is known of it, and once it is known along
    // `lean` or from what the others of the group have gained.
    Doubt speed_doubt = 0;
    Doubt speed_doubt_left = 0;
    // How far the position may be off once the velocity is known.
    Doubt place_doubt = 0;
    // Position residual that a velocity residual of one step has made, of 65536: since the last
    // hit when `timed`; or, when nobody knows since when, at most.
    std::int32_t lever = 0;
    bool timed = true;
    // The direction in which a velocity residual points, either way; both 0: none is likelier.
    std::int32_t lean_x = 0, lean_y = 0;
    // Balls of one group have hit each other and nothing else: their momentum is what it was. The
    // index in the prediction of its first ball.
    std::uint32_t group = 0;
};

struct Prediction {
    Tick baseline_tick = 0;  // 0: of nothing, and `balls` is empty
    Tick tick = 0;
    std::vector<Expectation> balls;  // ascending by id
};

}  // namespace fts::replication
