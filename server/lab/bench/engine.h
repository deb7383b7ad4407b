// Something that advances a scene of balls tick by tick: one of our solvers, another physics
// engine, or a mere pass over the memory. What is measured about it needs no more than this.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/physics/scene.h"

namespace fts::lab {

struct BallState {
    physics::Vec2d position_m, velocity_mps;
};

class Engine {
  public:
    Engine() = default;
    virtual ~Engine() = default;
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    // To the end of the tick, with all balls ready to be read, but for an engine that says it is
    // not read.
    virtual void step() = 0;
    // Of body `i` of the scene.
    virtual BallState ball(std::size_t i) const = 0;
    // Since the start, of balls and with walls; empty where nobody counts them.
    virtual std::optional<std::uint64_t> collisions() const { return std::nullopt; }
};

struct EngineInfo {
    std::string name;   // "discrete-double", "chipmunk-hash"
    std::string title;  // "discrete double", "Chipmunk, spatial hash"
    // With more a tick would take seconds; nobody waits for that.
    std::size_t max_balls = physics::kMaxBodies;
    // The same where they are fast, if that is fewer.
    std::size_t max_fast_balls = physics::kMaxBodies;
    // A floor and no physics: it lets balls through each other, and nobody minds.
    bool is_floor = false;
    // Compared with others only where it is named.
    bool is_only_by_name = false;
};

// All of this build, in the order of tables. Box2D and Chipmunk are among them when their packages
// were there at build time (./setup bench).
const std::vector<EngineInfo>& engines();
// Null when this build has no such engine.
const EngineInfo* find_engine(const std::string& name);

// The scene is valid, elastic, and has no drag or platform; it is periodic for ours only. `name` is
// one of engines().
std::unique_ptr<Engine> make_engine(const std::string& name, const physics::Scene& scene,
                                    double tick_s);

}  // namespace fts::lab
