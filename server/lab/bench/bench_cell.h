// One cell of the benchmark: an engine in a scene. The scenes are discs in a walled box, elastic
// and without friction, at 60 ticks a second.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/physics/scene.h"

namespace fts::lab {

inline constexpr double kBenchTickS = 1.0 / 60.0;
inline constexpr double kBenchRadiusM = 0.5;  // the mean one; what the peers like

enum class Radii : std::uint8_t {
    kEqual,
    kUnequal,  // evenly from 0.5 to 1.5 of the mean, masses in proportion to areas
};
// "equal", "unequal".
std::string to_string(Radii radii);

struct BenchScene {
    std::size_t balls = 10'000;
    double packing = 0.3;  // the part of the box that balls cover
    Radii radii = Radii::kEqual;
    double radii_per_tick = 0.05;  // root of the mean square of how far a ball moves in a tick

    bool operator==(const BenchScene&) const = default;
};

struct BenchCell {
    std::string engine;  // engine.h
    BenchScene scene;
};

// "swept-double/N:10000/packing:0.3/radii:equal/speed:0.05", and back. Empty when it is no such
// name.
std::string name_of(const BenchCell& cell);
std::optional<BenchCell> cell_from(const std::string& name);

// "10,000 balls, packing 0.3, equal radii, 0.05 r a tick".
std::string text_of(const BenchScene& scene);
// "10,000".
std::string grouped(std::size_t number);

// Why the cell is not run; empty when it is. Its engine is one of engines().
std::string reason_not_to_run(const BenchCell& cell);

// Every engine in every scene that the lists make together, one scene after the other.
struct BenchMatrix {
    std::vector<std::string> engines;
    std::vector<std::size_t> balls;
    std::vector<double> packings;
    std::vector<Radii> radii;
    std::vector<double> speeds;  // radii_per_tick
};
std::vector<BenchCell> cells_of(const BenchMatrix& matrix);

// The balls do not fit; what() says why.
struct SceneRefused : std::runtime_error {
    using std::runtime_error::runtime_error;
};
// The balls, in places and with velocities that are always the same. Throws SceneRefused.
physics::Scene balls_of(const BenchScene& scene);

}  // namespace fts::lab
