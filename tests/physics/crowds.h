// Crowds of a few hundred balls, which the event solver foresees in windows of time.
#pragma once

#include <cstddef>
#include <vector>

#include "common/physics/scene.h"
#include "tests/physics/dice.h"

namespace fts::physics {

struct CrowdShape {
    std::size_t balls = 400;
    double min_radius_m = 0.5, max_radius_m = 0.5;
    double max_speed_mps = 5.0;
    double filled = 0.25;  // of the box, by balls
    Vec2d centre_m = Vec2d::Zero();
};
// In walls, at random places that do not overlap; a ball of radius 1 weighs 1 kg and others by
// area.
Scene random_crowd(const CrowdShape& shape, Dice& dice);

// Balls in exact contact, in rows that fill a triangle, at rest; the tip is at the origin and rows
// lie beyond it along x.
std::vector<BodyDef> rack(int rows, double radius_m);

// Takes out whoever starts beyond its edge.
void stand_on(const Platform& platform, Scene& scene);

}  // namespace fts::physics
