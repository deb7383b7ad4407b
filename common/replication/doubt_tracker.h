// How far off a prediction may be, followed along its collisions: variances of every ball's place
// and velocity to first order, in steps of the lattice, and who has exchanged momentum with whom.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/physics/world.h"
#include "common/replication/lattice_world.h"
#include "common/replication/prediction.h"

namespace fts::replication {

class DoubtTracker {
  public:
    // `rounded`: whether the baseline was rounded to the lattice, or is on it.
    // `unforeseen_mps2`: what may accelerate a ball that somebody steers.
    DoubtTracker(const Lattice& lattice, std::span<const BallState> baseline, bool rounded,
                 double unforeseen_mps2);

    // In the order they happened; `start_s` of the step they happened in, since the baseline.
    void follow(std::span<const physics::Contact<double>> contacts, double start_s);
    // How sure to be of each at `end_s`, written to all but their states.
    void judge(double end_s, std::span<Expectation> expectations);

  private:
    struct Track {
        double time_s = 0.0;  // of the last hit by a ball
        double place_variance = 0.0;
        double speed_variance = 0.0;
        double variance_before_hit = 0.0;  // of velocity
        bool hit = false;
        bool steered = false;
        double lean_x = 0.0, lean_y = 0.0;
        std::uint32_t group = 0;
    };

    void bring_to(Track& track, double time_s) const;
    void hit(const physics::Contact<double>& contact, double time_s);
    void hit_wall(const physics::Contact<double>& contact);
    std::uint32_t root_of(std::uint32_t index);
    double unforeseen_variance(double time_s) const;

    double lever_per_s_;  // position steps that a velocity step makes in a second
    double position_step_m_, velocity_step_mps_;
    double rounding_variance_;
    double unforeseen_steps_per_s_;  // of velocity
    std::vector<Track> tracks_;
    std::vector<bool> broken_;  // groups whose momentum a wall has changed, by root
};

}  // namespace fts::replication
