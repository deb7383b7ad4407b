// Balls by the thousand, from a few numbers: fills a scene's boundary with discs that do not
// overlap, as evenly as chance has it, and sets them moving with no momentum in total. The same
// numbers give the same scene, to the bit, on every machine.
//
// Radii are spread evenly from radius_min_m to radius_max_m. Velocities are nearly Maxwellian (each
// component a sum of twelve even ones), less the mean that momentum asks for, times what makes the
// root of the mean square exactly speed_rms_mps. A single ball keeps its momentum.
//
// Dilute discs are placed at random (random sequential addition), dense ones of one radius on a
// hexagonal lattice that is stretched to fit, with vacancies and jitter, dense ones of several by
// relaxing overlaps. What cannot be placed is refused, never thinned out in silence.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "common/physics/scene.h"

namespace fts::physics {

enum class MassRule : std::uint8_t {
    kEqual,   // 1 kg each
    kByArea,  // in proportion to radius^2, 1 kg on average
};

struct Generator {
    std::uint64_t seed = 0;
    // How many; and which part of the area all balls cover, those that the scene has already
    // included. Within a boundary one of the two is enough, and of both the one that makes fewer
    // balls counts. Without a boundary both are needed, and make it.
    std::optional<std::int64_t> count = std::nullopt;
    std::optional<double> packing_fraction = std::nullopt;
    double radius_min_m = 0.5;
    double radius_max_m = 0.5;
    MassRule mass = MassRule::kEqual;
    double speed_rms_mps = 1.0;
};

// The scene with generated balls after its own, which they keep clear of. Walls or a periodic box
// whose corners are the same stand for the square about that point that gives the packing; so does,
// about the origin and with walls, no boundary at all. On a platform whole discs are, and not only
// centres. Errors name the generator's fields without units: "generator.radius_min is -1; ...".
std::variant<Scene, SceneError> fill(Scene scene, const Generator& generator);

// No arrangement of equal discs covers more (Thue): pi / sqrt(12).
inline constexpr double kDensestPacking = 0.90689968211710892530;

}  // namespace fts::physics
