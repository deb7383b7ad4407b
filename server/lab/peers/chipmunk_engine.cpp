#include "server/lab/peers/chipmunk_engine.h"

#include <algorithm>
#include <chipmunk/chipmunk.h>
#include <cstdio>
#include <fcntl.h>
#include <limits>
#include <unistd.h>
#include <vector>

namespace fts::lab {
namespace {

using physics::BodyDef;
using physics::Scene;
using physics::Vec2d;

constexpr int kIterations = 10;
constexpr double kSlopOverRadius = 1e-3;
constexpr int kCellsOfABall = 10;
constexpr double kHalfThicknessM = 10.0;  // of walls

cpVect theirs(const Vec2d& ours) {
    return {ours.x(), ours.y()};
}

// While it lives, what is printed goes nowhere.
class QuietStdout {
  public:
    QuietStdout() : kept_(dup(STDOUT_FILENO)) {
        std::fflush(stdout);
        const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (kept_ >= 0 && nowhere >= 0) dup2(nowhere, STDOUT_FILENO);
        if (nowhere >= 0) close(nowhere);
    }
    ~QuietStdout() {
        std::fflush(stdout);
        if (kept_ < 0) return;
        dup2(kept_, STDOUT_FILENO);
        close(kept_);
    }
    QuietStdout(const QuietStdout&) = delete;
    QuietStdout& operator=(const QuietStdout&) = delete;

  private:
    int kept_;
};

// A library with its assertions compiled in says so on stdout at its first space, where results may
// go.
cpSpace* new_space() {
    [[maybe_unused]] static const bool kHasSpoken = [] {
        const QuietStdout quiet;
        cpSpaceFree(cpSpaceNew());
        return true;
    }();
    return cpSpaceNew();
}

struct SpaceDeleter {
    void operator()(cpSpace* space) const { cpSpaceFree(space); }
};

class ChipmunkEngine : public Engine {
  public:
    ChipmunkEngine(const Scene& scene, double tick_s, ChipmunkIndex index)
        : space_(new_space()), tick_s_(tick_s) {
        double largest_m = 0.0, smallest_m = std::numeric_limits<double>::infinity();
        for (const BodyDef& body : scene.bodies) {
            largest_m = std::max(largest_m, body.radius_m);
            smallest_m = std::min(smallest_m, body.radius_m);
        }
        cpSpaceSetIterations(space_.get(), kIterations);
        cpSpaceSetCollisionSlop(space_.get(), kSlopOverRadius * smallest_m);
        if (index == ChipmunkIndex::kSpatialHash) {
            cpSpaceUseSpatialHash(space_.get(), 2.0 * largest_m,
                                  kCellsOfABall * static_cast<int>(scene.bodies.size()));
        }
        bodies_.reserve(scene.bodies.size());
        for (const BodyDef& body : scene.bodies) add(body);
        if (scene.walls) add_walls(*scene.walls);
    }

    ~ChipmunkEngine() override {
        for (cpShape* const shape : shapes_) {
            cpSpaceRemoveShape(space_.get(), shape);
            cpShapeFree(shape);
        }
        for (cpBody* const body : bodies_) {
            cpSpaceRemoveBody(space_.get(), body);
            cpBodyFree(body);
        }
    }

    void step() override { cpSpaceStep(space_.get(), tick_s_); }

    BallState ball(std::size_t i) const override {
        const cpVect position = cpBodyGetPosition(bodies_[i]);
        const cpVect velocity = cpBodyGetVelocity(bodies_[i]);
        return {{position.x, position.y}, {velocity.x, velocity.y}};
    }

  private:
    void add_shape(cpShape* shape) {
        cpShapeSetElasticity(shape, 1.0);
        cpShapeSetFriction(shape, 0.0);
        shapes_.push_back(cpSpaceAddShape(space_.get(), shape));
    }

    void add(const BodyDef& def) {
        constexpr double kNoRotation = std::numeric_limits<double>::infinity();
        cpBody* const body = cpSpaceAddBody(space_.get(), cpBodyNew(def.mass_kg, kNoRotation));
        cpBodySetPosition(body, theirs(def.position_m));
        cpBodySetVelocity(body, theirs(def.velocity_mps));
        bodies_.push_back(body);
        add_shape(cpCircleShapeNew(body, def.radius_m, cpvzero));
    }

    // Thick, so that who is inside one is pushed back out and not through it.
    void add_walls(const physics::Walls& walls) {
        const Vec2d low = walls.min_m - Vec2d::Constant(kHalfThicknessM);
        const Vec2d high = walls.max_m + Vec2d::Constant(kHalfThicknessM);
        const Vec2d corners[] = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
        cpBody* const ground = cpSpaceGetStaticBody(space_.get());
        for (std::size_t i = 0; i < 4; ++i) {
            add_shape(cpSegmentShapeNew(ground, theirs(corners[i]), theirs(corners[(i + 1) % 4]),
                                        kHalfThicknessM));
        }
    }

    std::unique_ptr<cpSpace, SpaceDeleter> space_;
    std::vector<cpBody*> bodies_;
    std::vector<cpShape*> shapes_;
    double tick_s_;
};

}  // namespace

std::unique_ptr<Engine> make_chipmunk(const Scene& scene, double tick_s, ChipmunkIndex index) {
    return std::make_unique<ChipmunkEngine>(scene, tick_s, index);
}

}  // namespace fts::lab
