// A seeded source of numbers whose values are the same with every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "common/physics/scene.h"

namespace fts::physics {

class Dice {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}

    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    // Evenly spread over the magnitudes.
    double of_any_size(double low, double high) {
        return std::exp(between(std::log(low), std::log(high)));
    }
    std::uint64_t below(std::uint64_t limit) { return engine_() % limit; }
    Vec2d in_box(double half_width) {
        const double x = between(-half_width, half_width);
        return {x, between(-half_width, half_width)};
    }

  private:
    std::mt19937_64 engine_;
};

}  // namespace fts::physics
