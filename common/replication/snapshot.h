// A snapshot is an immutable value: what one arena looks like at one tick, quantised, every list
// sorted by id without repeats. It is what travels; it is not the simulation, and holds no name or
// score (those are messages, messages.h).
//
// Position step kPositionStepM, velocity step kVelocityStepMps; `quantise` rounds to nearest and
// clamps to the range (+-32.7 km, +-131 km/s), which `in_range` lets a caller check first.
#pragma once

#include <cstdint>
#include <vector>

#include "common/game/input.h"
#include "common/game/level.h"
#include "common/physics/scene.h"

namespace fts::replication {

using Tick = std::uint32_t;

// A ball that slows down by k a second stops slowing, on the lattice, at a speed of half a step
// over k times the time between snapshots: about a millimetre a second here.
inline constexpr double kPositionStepM = 1.0 / 65536.0;
inline constexpr double kVelocityStepMps = 1.0 / 16384.0;
inline constexpr double kRadiusStepM = 1.0 / 4096.0;
inline constexpr double kMassStepKg = 1.0 / 65536.0;
inline constexpr double kImpulseStepNs = 1.0 / 256.0;
inline constexpr double kAccelerationStepMps2 = 1.0 / 4096.0;
inline constexpr double kDragStepPerS = 1.0 / 16384.0;
inline constexpr double kDashStepMps = 1.0 / 4096.0;

// How a ball answers to its controls (game::Handling).
struct HandlingState {
    std::uint32_t acceleration = 0;  // kAccelerationStepMps2
    std::uint32_t drag = 0;          // kDragStepPerS
    std::uint32_t braking = 0;       // kDragStepPerS
    std::uint32_t dash = 0;          // kDashStepMps
    friend bool operator==(const HandlingState&, const HandlingState&) = default;
};

struct BallState {
    std::uint16_t id = 0;  // unique within the arena for the ball's life, not reused within 10 s
    std::int32_t x = 0, y = 0;               // kPositionStepM
    std::int32_t vx = 0, vy = 0;             // kVelocityStepMps
    std::int8_t thrust_x = 0, thrust_y = 0;  // the control that acts on it (input.h)
    bool brake = false;
    std::uint16_t radius = 0;     // kRadiusStepM
    std::uint32_t mass = 0;       // kMassStepKg
    std::uint8_t kind = 0;        // BallKind
    std::uint8_t behaviour = 0;   // game::Behaviour, for an AI ball
    std::uint16_t player_id = 0;  // 0 for an AI ball
    HandlingState handling = {};
    friend bool operator==(const BallState&, const BallState&) = default;
};
enum class BallKind : std::uint8_t { kAi = 0, kPlayer = 1 };
inline constexpr game::Behaviour kLastBehaviour = game::Behaviour::kBruiser;

// Of all that is neither motion nor control.
bool same_body(const BallState& a, const BallState& b);
void take_body(const BallState& from, BallState& to);

struct CoinState {
    std::uint16_t id = 0;
    std::int32_t x = 0, y = 0;
    std::uint16_t value_coins = 1;
    friend bool operator==(const CoinState&, const CoinState&) = default;
};

// A collision since the previous snapshot, for sparks and sound. Not delta coded; one that is lost
// stays lost.
struct HitState {
    Tick tick = 0;
    std::uint16_t a = 0, b = 0;
    std::int32_t x = 0, y = 0;  // contact point, kPositionStepM
    std::uint32_t impulse = 0;  // kImpulseStepNs
    friend bool operator==(const HitState&, const HitState&) = default;
};

struct Snapshot {
    Tick tick = 0;
    std::uint8_t arena = 0;
    game::Phase phase = game::Phase::kWaiting;
    std::uint16_t level = 0;
    Tick phase_end_tick = 0;  // 0: open-ended
    std::vector<BallState> balls;
    std::vector<CoinState> coins;
    std::vector<HitState> hits;
    friend bool operator==(const Snapshot&, const Snapshot&) = default;
};

// Lists sorted by id, without repeats; hits sorted by (tick, a, b); every enum one of its values.
bool is_canonical(const Snapshot& snapshot);

// The nearest whole number of steps, halves away from zero, clamped to the 32-bit range; 0 for NaN.
// Whatever `in_range` holds for is off by at most half a step, and nothing else is.
std::int32_t quantise(double value, double step);
bool in_range(double value, double step);
double dequantise(std::int64_t steps, double step);

// In SI units.
physics::Vec2d place_m(std::int32_t x, std::int32_t y);
physics::Vec2d position_of(const BallState& ball);
physics::Vec2d velocity_of(const BallState& ball);

}  // namespace fts::replication
