// The oracle of the discrete solver: the same substep with every pair looked at, in order, and no
// grid, no copy and no features. To the bit.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/physics/periodic.h"
#include "common/physics/solver.h"

namespace fts::physics {

class OverlapReference {
  public:
    OverlapReference(const Scene& scene, const Model<double>& model)
        : model_(model), balls_(scene.bodies) {}

    void step(double span_s) {
        contacts_.clear();
        for (BodyDef& ball : balls_) {
            ball.position_m += ball.velocity_mps * span_s;
            keep_in_box(ball);
        }
        std::vector<std::pair<std::size_t, std::size_t>> found;
        for (std::size_t a = 0; a < balls_.size(); ++a) {
            for (std::size_t b = a + 1; b < balls_.size(); ++b) {
                const double reach = balls_[a].radius_m + balls_[b].radius_m;
                if (line(a, b).squaredNorm() < reach * reach) found.emplace_back(a, b);
            }
        }
        for (const auto& [a, b] : found) resolve(a, b);
        if (!model_.walls) return;
        for (BodyDef& ball : balls_) reflect(ball);
    }

    const std::vector<BodyDef>& balls() const { return balls_; }
    const std::vector<std::pair<std::size_t, std::size_t>>& contacts() const { return contacts_; }

  private:
    Vec2d line(std::size_t a, std::size_t b) const {
        return nearest_image<double>(balls_[a].position_m - balls_[b].position_m, model_.periodic);
    }

    void keep_in_box(BodyDef& ball) const {
        if (model_.periodic) ball.position_m = wrapped<double>(ball.position_m, *model_.periodic);
    }

    void resolve(std::size_t a, std::size_t b) {
        BodyDef &one = balls_[a], &two = balls_[b];
        const double weight_a = 1.0 / one.mass_kg, weight_b = 1.0 / two.mass_kg;
        const double share_a = weight_a / (weight_a + weight_b);
        const double share_b = weight_b / (weight_a + weight_b);
        const Vec2d d = line(a, b);
        const double squared = d.squaredNorm();
        const double rate = d.dot(one.velocity_mps - two.velocity_mps);
        const double overlap = one.radius_m + two.radius_m - std::sqrt(squared);
        if (rate < 0.0) {
            const double strength = -(1.0 + model_.restitution) * (rate / squared);
            one.velocity_mps += strength * share_a * d;
            two.velocity_mps -= strength * share_b * d;
            contacts_.emplace_back(a, b);
        }
        if (!(overlap > 0.0)) return;
        const double way = overlap / std::sqrt(squared);
        one.position_m += way * share_a * d;
        two.position_m -= way * share_b * d;
        keep_in_box(one);
        keep_in_box(two);
    }

    void reflect(BodyDef& ball) const {
        for (int axis = 0; axis < 2; ++axis) {
            const double low = model_.walls->min_m[axis] + ball.radius_m;
            const double high = model_.walls->max_m[axis] - ball.radius_m;
            double& x = ball.position_m[axis];
            double& v = ball.velocity_mps[axis];
            if ((x < low && v < 0.0) || (x > high && v > 0.0)) v *= -model_.restitution;
            x = std::clamp(x, low, high);
        }
    }

    Model<double> model_;
    std::vector<BodyDef> balls_;
    std::vector<std::pair<std::size_t, std::size_t>> contacts_;
};

}  // namespace fts::physics
