#include "common/replication/residual_part.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "common/replication/range_coder.h"

namespace fts::replication::residual_part {
namespace {

constexpr std::size_t kX = 0, kY = 1;
constexpr std::uint32_t kExactPriorWeight = 6;
constexpr std::int64_t kLeverOne = 65536;
// A velocity residual along the lean beyond which the hit was not quite the one expected, and the
// residual across says so too.
constexpr std::uint32_t kFarAlong = 12;
// From here on a residual of the one axis tells the time of the other's.
constexpr std::uint32_t kTellsTime = 3;

std::int32_t wrapped(std::int64_t value) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(value));
}
std::uint32_t size_of(std::int32_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    return value < 0 ? 0U - bits : bits;
}

// value * numerator / denominator, to the nearest; the factors fit 32 bits.
std::int32_t in_proportion(std::int64_t value, std::int64_t numerator, std::int64_t denominator) {
    const std::int64_t product = value * numerator;
    const std::int64_t half = std::abs(denominator) / 2;
    return wrapped((product + (product < 0 ? -half : half)) / denominator);
}

// The doubt of a sum of two independent numbers, the second even over `width`.
Doubt widened(Doubt doubt, double width) {
    return doubt_of(variance_of(doubt) + width * width / 12.0);
}

}  // namespace

const Models& Models::priors() {
    static const Models kPriors = [] {
        Models models;
        for (std::size_t i = 0; i < kDoubts; ++i) {
            const NumberModel model = NumberModel::of_spread(static_cast<Doubt>(i));
            for (auto& bank : models.speed) bank[i] = model;
            for (auto& bank : models.place) bank[i] = model;
        }
        for (std::size_t i = 0; i < kDoubts; ++i) {
            for (std::size_t j = 0; j < kDoubts; ++j) {
                const double one = models.speed[kFree][i].chance_of_zero() *
                                   models.place[kTimed][j].chance_of_zero();
                const auto chance = static_cast<std::uint32_t>(one * one * 65536.0);
                for (auto& kind : models.exact) kind[i][j] = {chance, kExactPriorWeight};
                models.exact[kNewControl][i][j] = {chance / 8, kExactPriorWeight};
                models.exact[kPushed][i][j] = {chance / 8, kExactPriorWeight};
            }
        }
        models.thrust = ThrustModel::of_keyboards();
        return models;
    }();
    return kPriors;
}

template <typename Coder>
PartCoder<Coder>::PartCoder(Coder& coder, const Prediction& expected, std::uint8_t flags)
    : coder_(coder), flags_(flags), models_(Models::priors()), groups_(expected.balls.size()) {
    for (const Expectation& ball : expected.balls) {
        Group& group = groups_[ball.group];
        group.alone = group.to_come == 0;
        ++group.to_come;
    }
}

template <typename Coder>
void PartCoder<Coder>::expected_ball(const Expectation& expected, BallState& ball) {
    if ((flags_ & kSomeBodyChanges) != 0 &&
        coder_.bit(models_.changes_body, !same_body(expected.state, ball))) {
        body(ball);
    } else {
        take_body(expected.state, ball);
    }
    motion(expected, control(expected, ball), ball);
}

template <typename Coder>
std::uint32_t PartCoder<Coder>::new_ball(std::uint32_t id_gap, BallState& ball) {
    const std::int32_t gap = code_number(coder_, models_.id_gap, static_cast<std::int32_t>(id_gap));
    if (coder_.raw(same_body(last_new_, ball) ? 1U : 0U, 1) != 0) {
        take_body(last_new_, ball);
    } else {
        body(ball);
    }
    last_new_ = ball;
    models_.thrust.code(coder_, ball);
    ball.x = code_number(coder_, models_.x, ball.x);
    ball.y = code_number(coder_, models_.y, ball.y);
    ball.vx = code_number(coder_, models_.vx, ball.vx);
    ball.vy = code_number(coder_, models_.vy, ball.vy);
    return static_cast<std::uint32_t>(gap);
}

template <typename Coder>
void PartCoder<Coder>::body(BallState& ball) {
    ball.radius = static_cast<std::uint16_t>(coder_.raw(ball.radius, 16));
    ball.mass = static_cast<std::uint32_t>(
        code_number(coder_, models_.mass, static_cast<std::int32_t>(ball.mass)));
    ball.kind = static_cast<std::uint8_t>(coder_.raw(ball.kind, 8));
    ball.behaviour = static_cast<std::uint8_t>(coder_.raw(ball.behaviour, 8));
    ball.player_id = static_cast<std::uint16_t>(coder_.raw(ball.player_id, 16));
    for (std::uint32_t* trait : {&ball.handling.acceleration, &ball.handling.drag,
                                 &ball.handling.braking, &ball.handling.dash}) {
        *trait = static_cast<std::uint32_t>(
            code_number(coder_, models_.handling, static_cast<std::int32_t>(*trait)));
    }
}

template <typename Coder>
bool PartCoder<Coder>::control(const Expectation& expected, BallState& ball) {
    AdaptiveBit& changes = models_.changes_control[expected.state.kind != 0 ? 1 : 0];
    if ((flags_ & kSomeControlChanges) != 0 &&
        coder_.bit(changes, !same_control(expected.state, ball))) {
        models_.thrust.code(coder_, ball);
        return true;
    }
    ball.thrust_x = expected.state.thrust_x;
    ball.thrust_y = expected.state.thrust_y;
    ball.brake = expected.state.brake;
    return false;
}

template <typename Coder>
void PartCoder<Coder>::motion(const Expectation& expected, bool control_changed, BallState& ball) {
    const BallState& state = expected.state;
    Residual residual;
    residual.place = {wrapped(std::int64_t{ball.x} - state.x),
                      wrapped(std::int64_t{ball.y} - state.y)};
    residual.speed = {wrapped(std::int64_t{ball.vx} - state.vx),
                      wrapped(std::int64_t{ball.vy} - state.vy)};
    Group& group = groups_[expected.group];
    const bool settled = !group.alone && group.to_come == 1 && state.mass > 0;
    const ExactKind kind = control_changed                  ? kNewControl
                           : !settled                       ? kMoving
                           : group.gained == Group{}.gained ? kUnpushed
                                                            : kPushed;
    const bool exact = residual.place == Residual{}.place && residual.speed == Residual{}.speed;
    AdaptiveBit& is_exact = models_.exact[kind][expected.speed_doubt][expected.place_doubt];
    as_expected_ = true;
    if (coder_.bit(is_exact, exact)) {
        residual = {};
    } else {
        if (settled) {
            settled_speeds(expected, group, residual);
        } else {
            speeds(expected, group, residual);
        }
        places(expected, residual);
    }
    --group.to_come;
    ball.x = wrapped(std::int64_t{state.x} + residual.place[kX]);
    ball.y = wrapped(std::int64_t{state.y} + residual.place[kY]);
    ball.vx = wrapped(std::int64_t{state.vx} + residual.speed[kX]);
    ball.vy = wrapped(std::int64_t{state.vy} + residual.speed[kY]);
}

template <typename Coder>
void PartCoder<Coder>::speeds(const Expectation& expected, Group& group, Residual& residual) {
    const bool leans = expected.lean_x != 0 || expected.lean_y != 0;
    const std::array<std::int32_t, 2> lean{expected.lean_x, expected.lean_y};
    const std::size_t first = size_of(lean[kY]) > size_of(lean[kX]) ? kY : kX;
    const std::size_t second = 1 - first;
    std::int32_t& along = residual.speed[first];
    std::int32_t& across = residual.speed[second];
    along = number(models_.speed[kFree][expected.speed_doubt], along, 0, false);
    if (leans) {
        const SpeedBank bank = size_of(along) < kFarAlong ? kAcross : kAcrossFar;
        across = number(models_.speed[bank][expected.speed_doubt_left], across,
                        in_proportion(along, lean[second], lean[first]), false);
    } else {
        const auto width = std::min<std::size_t>(std::bit_width(size_of(along)), kDoubts - 1);
        across = number(models_.speed[kAfterFree][width], across, 0, false);
    }
    for (const std::size_t axis : {kX, kY}) {
        group.gained[axis] +=
            static_cast<std::uint64_t>(std::int64_t{expected.state.mass} * residual.speed[axis]);
    }
}

// What the others of the group have gained, the last of them has lost.
template <typename Coder>
void PartCoder<Coder>::settled_speeds(const Expectation& expected, const Group& group,
                                      Residual& residual) {
    for (const std::size_t axis : {kX, kY}) {
        const auto lost = static_cast<std::int64_t>(0U - group.gained[axis]);
        residual.speed[axis] =
            number(models_.speed[kSettled][expected.speed_doubt_left], residual.speed[axis],
                   wrapped(lost / std::int64_t{expected.state.mass}), false);
    }
}

template <typename Coder>
void PartCoder<Coder>::places(const Expectation& expected, Residual& residual) {
    const auto& [vx, vy] = residual.speed;
    const std::size_t first = size_of(vy) > size_of(vx) ? kY : kX;
    std::int64_t lever = expected.timed ? expected.lever : expected.lever / 2;
    PlaceBank bank = expected.timed ? kTimed : kUntimed;
    for (const std::size_t axis : {first, 1 - first}) {
        const std::int32_t speed = residual.speed[axis];
        Doubt doubt = expected.place_doubt;
        if (bank == kUntimed && speed != 0) {
            doubt = widened(doubt, static_cast<double>(speed) * expected.lever / kLeverOne);
        }
        std::int32_t& place = residual.place[axis];
        place = number(models_.place[bank][doubt], place, in_proportion(lever, speed, kLeverOne),
                       axis != first);
        if (bank == kUntimed && size_of(speed) >= kTellsTime) {
            lever = std::clamp<std::int64_t>(place * kLeverOne / speed, 0, expected.lever);
            bank = kTimedByOther;
        }
    }
}

// The last number of a ball that is not exactly as expected, and was so far, is not as expected.
template <typename Coder>
std::int32_t PartCoder<Coder>::number(NumberModel& model, std::int32_t value, std::int32_t mean,
                                      bool last) {
    const std::int32_t off = wrapped(std::int64_t{value} - mean);
    const std::int32_t coded = last && as_expected_ ? code_other_than_zero(coder_, model, off)
                                                    : code_number(coder_, model, off);
    const std::int32_t result = wrapped(std::int64_t{coded} + mean);
    as_expected_ = as_expected_ && result == 0;
    return result;
}

template class PartCoder<RangeEncoder>;
template class PartCoder<RangeDecoder>;

}  // namespace fts::replication::residual_part
