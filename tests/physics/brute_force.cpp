#include "tests/physics/brute_force.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace fts::physics {
namespace {

using Real = long double;
using Vec = Eigen::Matrix<Real, 2, 1>;
constexpr Real kNeverS = std::numeric_limits<Real>::infinity();

Real real(double value) {
    return static_cast<Real>(value);
}

struct Ball {
    Vec x, v;
    Real r, m;
    bool here = true;
};

struct Next {
    Real time_s = kNeverS;
    enum { kNothing, kPair, kWall, kFall } what = kNothing;
    std::size_t a = 0, b = 0;
};

// The smaller root of a t^2 + 2 b t + c = 0, going in; the larger one, going out.
Real entry(Real a, Real b, Real c) {
    const Real d = b * b - a * c;
    if (b >= 0 || d < 0) return kNeverS;
    return std::max<Real>(0, (-b - std::sqrt(d)) / a);
}
Real exit(Real a, Real b, Real c) {
    return a > 0 ? std::max<Real>(0, (-b + std::sqrt(std::max<Real>(0, b * b - a * c))) / a)
                 : kNeverS;
}

Real fall_time(const Platform& platform, const Ball& ball) {
    const Real a = ball.v.squaredNorm(), b = ball.x.dot(ball.v), x2 = ball.x.squaredNorm();
    if (const auto* disc = std::get_if<Disc>(&platform)) {
        const Real radius = real(disc->radius_m);
        return exit(a, b, x2 - radius * radius);
    }
    if (const auto* ring = std::get_if<Ring>(&platform)) {
        const Real inner = real(ring->inner_radius_m), outer = real(ring->outer_radius_m);
        return std::min(entry(a, b, x2 - inner * inner), exit(a, b, x2 - outer * outer));
    }
    Real first = kNeverS;
    for (int axis = 0; axis < 2; ++axis) {
        const Real half = real(std::get<Rectangle>(platform).half_extents_m[axis]);
        if (ball.v[axis] != 0) {
            first =
                std::min(first, (std::copysign(half, ball.v[axis]) - ball.x[axis]) / ball.v[axis]);
        }
    }
    return first;
}

class Oracle {
  public:
    explicit Oracle(const Scene& scene) : scene_(scene) {
        for (const BodyDef& body : scene.bodies) {
            balls_.push_back({body.position_m.cast<Real>(), body.velocity_mps.cast<Real>(),
                              real(body.radius_m), real(body.mass_kg)});
        }
    }

    Outcome run(Real span_s) {
        Outcome outcome;
        for (Next next = find(); next.time_s <= span_s; next = find()) {
            move(next.time_s);
            span_s -= next.time_s;
            happen(next, outcome);
        }
        move(span_s);
        for (const Ball& ball : balls_) {
            outcome.bodies.push_back({ball.x.cast<double>(), ball.v.cast<double>(),
                                      static_cast<double>(ball.r), static_cast<double>(ball.m)});
        }
        return outcome;
    }

  private:
    Next find() const {
        Next next;
        const auto offer = [&](Next other) {
            if (other.time_s < next.time_s) next = other;
        };
        for (std::size_t i = 0; i < balls_.size(); ++i) {
            const Ball& ball = balls_[i];
            if (!ball.here) continue;
            for (std::size_t j = i + 1; j < balls_.size(); ++j) {
                if (!balls_[j].here) continue;
                const Vec x = ball.x - balls_[j].x, v = ball.v - balls_[j].v;
                const Real reach = ball.r + balls_[j].r;
                offer({entry(v.squaredNorm(), x.dot(v), x.squaredNorm() - reach * reach),
                       Next::kPair, i, j});
            }
            for (std::size_t side = 0; scene_.walls && side < 4; ++side) {
                offer({wall_time(ball, side), Next::kWall, i, side});
            }
            if (scene_.platform) offer({fall_time(*scene_.platform, ball), Next::kFall, i, 0});
        }
        return next;
    }

    Real wall_time(const Ball& ball, std::size_t side) const {
        const Eigen::Index axis = static_cast<Eigen::Index>(side / 2);
        const Real out = side % 2 == 0 ? -1 : 1;
        const Vec2d& corner = side % 2 == 0 ? scene_.walls->min_m : scene_.walls->max_m;
        const Real speed = out * ball.v[axis];
        const Real gap = out * (real(corner[axis]) - ball.x[axis]) - ball.r;
        return speed > 0 ? std::max<Real>(0, gap / speed) : kNeverS;
    }

    void move(Real span_s) {
        for (Ball& ball : balls_) {
            if (ball.here) ball.x += ball.v * span_s;
        }
    }

    void happen(const Next& next, Outcome& outcome) {
        Ball& a = balls_[next.a];
        if (next.what == Next::kFall) {
            a.here = false;
            outcome.fallen.push_back(next.a);
        } else if (next.what == Next::kWall) {
            a.v[static_cast<Eigen::Index>(next.b / 2)] *= -1;
            ++outcome.wall_collisions;
        } else {
            Ball& b = balls_[next.b];
            const Vec n = (a.x - b.x).normalized();
            const Real j = -2 * (a.v - b.v).dot(n) * a.m * b.m / (a.m + b.m);
            a.v += j / a.m * n;
            b.v -= j / b.m * n;
            ++outcome.ball_collisions;
        }
    }

    const Scene& scene_;
    std::vector<Ball> balls_;
};

}  // namespace

Outcome coast(const Scene& scene, double span_s) {
    return Oracle(scene).run(real(span_s));
}

}  // namespace fts::physics
