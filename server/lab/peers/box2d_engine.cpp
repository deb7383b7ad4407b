#include "server/lab/peers/box2d_engine.h"

#include <algorithm>
#include <box2d/box2d.h>
#include <cmath>
#include <numbers>
#include <vector>

namespace fts::lab {
namespace {

using physics::BodyDef;
using physics::Scene;
using physics::Vec2d;

constexpr int kVelocityIterations = 8;
constexpr int kPositionIterations = 3;
// Of a gas one ball in ten million is faster than four times the root of the mean square.
constexpr double kFastestOverRms = 4.0;
constexpr double kWallThicknessM = 20.0;

double rms_speed_mps(const Scene& scene) {
    double sum = 0.0;
    for (const BodyDef& body : scene.bodies) sum += body.velocity_mps.squaredNorm();
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, scene.bodies.size())));
}

// Box2D's metres for one of ours.
double scale_for(const Scene& scene, double tick_s) {
    const double longest_m = kFastestOverRms * rms_speed_mps(scene) * tick_s;
    return std::min(1.0, static_cast<double>(b2_maxTranslation) / std::max(longest_m, 1e-9));
}

class Box2dEngine : public Engine {
  public:
    Box2dEngine(const Scene& scene, double tick_s, Bullets bullets)
        : world_(b2Vec2(0.0F, 0.0F)),
          scale_(scale_for(scene, tick_s)),
          tick_s_(static_cast<float>(tick_s)) {
        world_.SetAllowSleeping(false);
        world_.SetWarmStarting(false);
        world_.SetContinuousPhysics(bullets == Bullets::kYes);
        bodies_.reserve(scene.bodies.size());
        for (const BodyDef& body : scene.bodies) add(body, bullets == Bullets::kYes);
        if (scene.walls) add_walls(*scene.walls);
    }

    void step() override { world_.Step(tick_s_, kVelocityIterations, kPositionIterations); }

    BallState ball(std::size_t i) const override {
        return {ours(bodies_[i]->GetPosition()), ours(bodies_[i]->GetLinearVelocity())};
    }

  private:
    b2Vec2 theirs(const Vec2d& ours) const {
        return {static_cast<float>(scale_ * ours.x()), static_cast<float>(scale_ * ours.y())};
    }
    Vec2d ours(const b2Vec2& theirs) const {
        return Vec2d(static_cast<double>(theirs.x), static_cast<double>(theirs.y)) / scale_;
    }

    static b2FixtureDef elastic(const b2Shape& shape) {
        b2FixtureDef fixture;
        fixture.shape = &shape;
        fixture.friction = 0.0F;
        fixture.restitution = 1.0F;
        fixture.restitutionThreshold = 0.0F;
        return fixture;
    }

    void add(const BodyDef& body, bool is_bullet) {
        b2BodyDef def;
        def.type = b2_dynamicBody;
        def.position = theirs(body.position_m);
        def.linearVelocity = theirs(body.velocity_mps);
        def.fixedRotation = true;
        def.allowSleep = false;
        def.bullet = is_bullet;
        b2CircleShape circle;
        const double radius = scale_ * body.radius_m;
        circle.m_radius = static_cast<float>(radius);
        b2FixtureDef fixture = elastic(circle);
        fixture.density = static_cast<float>(body.mass_kg / (std::numbers::pi * radius * radius));
        bodies_.push_back(world_.CreateBody(&def));
        bodies_.back()->CreateFixture(&fixture);
    }

    // Thick, so that who is inside one is pushed back out and not through it.
    void add_walls(const physics::Walls& walls) {
        const b2BodyDef def;
        b2Body* const ground = world_.CreateBody(&def);
        const Vec2d centre = 0.5 * (walls.min_m + walls.max_m);
        const Vec2d half = 0.5 * (walls.max_m - walls.min_m);
        const Vec2d outside = half + Vec2d::Constant(0.5 * kWallThicknessM);
        const Vec2d long_half = half + Vec2d::Constant(kWallThicknessM);
        const double thin_half = 0.5 * kWallThicknessM;
        for (const double side : {-1.0, 1.0}) {
            add_wall(*ground, centre + Vec2d(side * outside.x(), 0), {thin_half, long_half.y()});
            add_wall(*ground, centre + Vec2d(0, side * outside.y()), {long_half.x(), thin_half});
        }
    }

    void add_wall(b2Body& ground, const Vec2d& centre, const Vec2d& half) const {
        b2PolygonShape box;
        const b2Vec2 extent = theirs(half);
        box.SetAsBox(extent.x, extent.y, theirs(centre), 0.0F);
        const b2FixtureDef fixture = elastic(box);
        ground.CreateFixture(&fixture);
    }

    b2World world_;
    std::vector<b2Body*> bodies_;  // the world's
    double scale_;
    float tick_s_;
};

}  // namespace

std::unique_ptr<Engine> make_box2d(const Scene& scene, double tick_s, Bullets bullets) {
    return std::make_unique<Box2dEngine>(scene, tick_s, bullets);
}

}  // namespace fts::lab
