// A trajectory as CSV: a row for each body and sample, numbers in full precision.
#pragma once

#include <cstdint>
#include <ostream>

#include "common/physics/scene.h"

namespace fts::lab {

class TrajectoryWriter {
  public:
    // Samples `sample_rate_hz` times per second of the scene, at the ticks nearest after; each tick
    // where that is the tick rate or more. Writes the header.
    TrajectoryWriter(std::ostream& out, double tick_rate_hz, double sample_rate_hz);

    // True once for each tick that is a sample; the first one, and the last, always are.
    bool is_sample(std::uint64_t tick, std::uint64_t last_tick);
    void write(double time_s, std::uint32_t body, const physics::Vec2d& position_m,
               const physics::Vec2d& velocity_mps);

  private:
    std::ostream& out_;
    double samples_per_tick_;
    double next_sample_ = 0.0;
};

}  // namespace fts::lab
