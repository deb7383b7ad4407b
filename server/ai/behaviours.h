// Behaviours: pure functions from a situation to an intent, one file each. They know no random
// number, no delay and no tick; the pilot (pilot.h) adds those, and keeps every one of them on the
// platform.
#pragma once

#include <vector>

#include "common/game/upgrades.h"
#include "server/ai/perception.h"

namespace fts::server::ai {

// Positions are as perceived, others' moved on along their velocities by the look-ahead.
struct Situation {
    const physics::Platform* platform = nullptr;
    game::BallStats stats;
    SeenBall own;
    std::vector<SeenBall> others;  // by id; those that matter (below), and any more
    double look_ahead_s = 0.0;
};

struct Intent {
    physics::Vec2d thrust = physics::Vec2d::Zero();  // fraction of the full one, |thrust| <= 1
    bool brake = false;
    bool dash = false;
};

Intent decide(game::Behaviour behaviour, const Situation& situation);
// Whether `decide` looks at that ball at all.
bool matters(game::Behaviour behaviour, const SeenBall& other);

// Gets behind its target, on the line from the nearest edge through it, and drives it out.
Intent chase(const Situation& situation);
// Goes to where its target will be and meets it head on.
Intent intercept(const Situation& situation);
// Keeps between the middle and its target, and strikes when the target comes near the edge.
Intent guard_edge(const Situation& situation);
// Gathers with its like, then charges with them.
Intent run_with_herd(const Situation& situation);
// Runs away.
Intent flee(const Situation& situation);
// Straight at its target with everything it has.
Intent charge(const Situation& situation);

}  // namespace fts::server::ai
