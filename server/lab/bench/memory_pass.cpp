#include "server/lab/bench/memory_pass.h"

#include <algorithm>

namespace fts::lab {
namespace {

// Balls at a time, so that a velocity is still in the nearest cache when it is written.
constexpr Eigen::Index kBlock = 256;

template <typename Scalar>
class MemoryPass : public Engine {
  public:
    MemoryPass(const physics::Scene& scene, double tick_s) : tick_s_(static_cast<Scalar>(tick_s)) {
        const auto count = static_cast<Eigen::Index>(scene.bodies.size());
        for (Values* const values : {&x_, &y_, &vx_, &vy_}) values->resize(count);
        for (Eigen::Index i = 0; i < count; ++i) {
            const physics::BodyDef& body = scene.bodies[static_cast<std::size_t>(i)];
            x_[i] = static_cast<Scalar>(body.position_m.x());
            y_[i] = static_cast<Scalar>(body.position_m.y());
            vx_[i] = static_cast<Scalar>(body.velocity_mps.x());
            vy_[i] = static_cast<Scalar>(body.velocity_mps.y());
        }
    }

    void step() override {
        pass(x_, vx_);
        pass(y_, vy_);
    }

    BallState ball(std::size_t i) const override {
        const auto k = static_cast<Eigen::Index>(i);
        return {{static_cast<double>(x_[k]), static_cast<double>(y_[k])},
                {static_cast<double>(vx_[k]), static_cast<double>(vy_[k])}};
    }

  private:
    using Values = Eigen::Array<Scalar, Eigen::Dynamic, 1>;

    // Velocities turn round each tick, so that they are written and places stay where they are.
    void pass(Values& places, Values& velocities) const {
        for (Eigen::Index first = 0; first < places.size(); first += kBlock) {
            const Eigen::Index count = std::min(kBlock, places.size() - first);
            places.segment(first, count) += tick_s_ * velocities.segment(first, count);
            velocities.segment(first, count) = -velocities.segment(first, count);
        }
    }

    Values x_, y_, vx_, vy_;
    Scalar tick_s_;
};

}  // namespace

template <typename Scalar>
std::unique_ptr<Engine> make_memory_pass(const physics::Scene& scene, double tick_s) {
    return std::make_unique<MemoryPass<Scalar>>(scene, tick_s);
}

template std::unique_ptr<Engine> make_memory_pass<float>(const physics::Scene&, double);
template std::unique_ptr<Engine> make_memory_pass<double>(const physics::Scene&, double);

}  // namespace fts::lab
