// The scenes of the accuracy study, each at a speed in radii per tick.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/physics/scene.h"
#include "server/lab/accuracy.h"

namespace fts::accuracy {

inline constexpr double kTickS = 1.0 / 60.0;
inline constexpr double kRadiusM = 0.5;

struct StudyScene {
    physics::Scene scene;
    // Ticks in which about `collisions` happen.
    lab::Run run(double collisions) const;
    double collisions_per_tick = 0.0;  // about; 0: once for all, within `ticks`
    std::size_t ticks = 0;
};

// "gas-dilute", "gas-medium", "gas-dense": 100 balls in a periodic box covering 5, 30 and 70 %.
// "heavy-light": the medium gas, every other ball 100 times heavier. "rack": 15 touching balls and
// the one that breaks them. "pairs-0.50": 64 pairs, the one ball at rest, the other passing its
// centre at 0.50 of the sum of radii. "pairs-of-mass-1e+06": the one at rest a million times
// heavier; "pairs-off-1e+06": a million radii from the origin, along both axes.
StudyScene study_scene(const std::string& name, double radii_per_tick);

// A medium gas of any size.
StudyScene medium_gas(std::size_t balls, double radii_per_tick, std::uint64_t seed);

const std::vector<std::string>& gas_names();
const std::vector<double>& impact_parameters();
std::string pairs_name(double impact_parameter);
const std::vector<double>& mass_ratios();
std::string pairs_of_mass_name(double ratio);
const std::vector<double>& offsets_radii();
std::string pairs_off_name(double radii);

}  // namespace fts::accuracy
