#include "common/game/input.h"

#include <cmath>

namespace fts::game {

namespace {

constexpr double kFullThrustSteps = 127.0;

physics::Vec2d within_unit_disc(const physics::Vec2d& vector) {
    const double length = vector.norm();
    return length > 1.0 ? physics::Vec2d(vector / length) : vector;
}

double finite_or_zero(double value) {
    return std::isfinite(value) ? value : 0.0;
}

}  // namespace

physics::Vec2d thrust_of(const InputCommand& input) {
    return within_unit_disc(physics::Vec2d(input.thrust_x, input.thrust_y) / kFullThrustSteps);
}

InputCommand command_toward(const physics::Vec2d& thrust) {
    const physics::Vec2d wanted =
        within_unit_disc({finite_or_zero(thrust.x()), finite_or_zero(thrust.y())});
    InputCommand command;
    command.thrust_x = static_cast<std::int8_t>(std::lround(wanted.x() * kFullThrustSteps));
    command.thrust_y = static_cast<std::int8_t>(std::lround(wanted.y() * kFullThrustSteps));
    return command;
}

}  // namespace fts::game
