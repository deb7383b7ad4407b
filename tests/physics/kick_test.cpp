#include "common/physics/kick.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "common/physics/exponential.h"
#include "common/physics/world.h"
#include "tests/physics/dice.h"

namespace fts::physics {
namespace {

double units_in_last_place(double value, double exact) {
    const double unit = std::nextafter(exact, std::numeric_limits<double>::infinity()) - exact;
    return std::abs(value - exact) / unit;
}

TEST(Decay, agrees_with_the_c_library_to_two_units_in_the_last_place) {
    constexpr std::uint64_t kSeed = 3;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (int i = 0; i < 200000; ++i) {
        const double x = i % 2 == 0 ? dice.of_any_size(1e-300, 745.0) : dice.between(0.0, 5.0);
        const Decay d = decay(x);
        ASSERT_LE(units_in_last_place(d.factor, std::exp(-x)), 2.0) << x;
        ASSERT_LE(units_in_last_place(d.mean, -std::expm1(-x) / x), 2.0) << x;
    }
}

TEST(Decay, is_right_at_its_ends) {
    EXPECT_EQ(decay(0.0).factor, 1.0);
    EXPECT_EQ(decay(0.0).mean, 1.0);
    EXPECT_EQ(decay(5e-324).factor, 1.0);
    EXPECT_EQ(decay(5e-324).mean, 1.0);
    EXPECT_EQ(decay(1e300).factor, 0.0);
    EXPECT_EQ(decay(1e300).mean, 1e-300);
    EXPECT_EQ(decay(std::numeric_limits<double>::infinity()).factor, 0.0);
    EXPECT_EQ(decay(std::numeric_limits<double>::infinity()).mean, 0.0);
}

// Of the exact value, which a double alone would round.
double units_off(double value, long double exact) {
    const auto nearest = static_cast<double>(exact);
    const double unit = std::nextafter(nearest, std::numeric_limits<double>::infinity()) - nearest;
    return std::abs(static_cast<double>(static_cast<long double>(value) - exact)) / unit;
}

TEST(SpanOfDecay, agrees_with_the_c_library_s_logarithm_to_two_units_in_the_last_place) {
    constexpr std::uint64_t kSeed = 4;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (int i = 0; i < 200000; ++i) {
        const double lost = i % 3 == 0   ? dice.of_any_size(1e-300, 1.0)
                            : i % 3 == 1 ? dice.between(0.0, 1.0)
                                         : 1.0 - dice.of_any_size(0x1p-53, 0.5);
        if (lost >= 1.0) continue;
        const long double exact = -std::log1p(-static_cast<long double>(lost));
        ASSERT_LE(units_off(span_of_decay(lost), exact), 2.0) << lost;
    }
}

TEST(SpanOfDecay, is_right_at_its_ends) {
    EXPECT_EQ(span_of_decay(0.0), 0.0);
    EXPECT_EQ(span_of_decay(5e-324), 5e-324);
    EXPECT_EQ(span_of_decay(1e-17), 1e-17);
    EXPECT_EQ(span_of_decay(0.5), 0x1.62e42fefa39efp-1);            // ln(2)
    EXPECT_EQ(span_of_decay(1.0 - 0x1p-53), 0x1.25e4f7b2737fap+5);  // 53 ln(2)
    EXPECT_EQ(span_of_decay(1.0), std::numeric_limits<double>::infinity());
}

TEST(SpanOfDecay, undoes_a_decay) {
    for (double x = 1e-9; x < 1.0; x *= 1.7) {
        EXPECT_NEAR(span_of_decay(x * decay(x).mean) / x, 1.0, 1e-15) << x;
    }
}

Scene one_ball() {
    Scene scene;
    scene.bodies.push_back({Vec2d::Zero(), Vec2d(2, -1), 0.5, 1.0});
    return scene;
}

Vec2d velocity_after(double span_s, int ticks, const Control<double>& control) {
    World<double> world(one_ball());
    const BodyId ball = world.ids()[0];
    world.set_control(ball, control);
    for (int i = 0; i < ticks; ++i) world.step(span_s / ticks);
    return world.body(ball).velocity_mps;
}

TEST(Kick, velocity_and_top_speed_do_not_depend_on_the_tick_rate) {
    const Control<double> control{Vec2d(6, 8), 2.5};
    for (const int rate_hz : {1, 10, 30, 60, 128, 1000}) {
        const Vec2d soon = velocity_after(1.0, rate_hz, control);
        EXPECT_LE((soon - velocity_after(1.0, 1, control)).norm(), 1e-12) << rate_hz;
        const Vec2d late = velocity_after(30.0, 30 * rate_hz, control);
        EXPECT_NEAR(late.norm(), 10.0 / 2.5, 1e-12) << rate_hz;
    }
}

TEST(Kick, without_drag_it_is_constant_acceleration) {
    World<double> world(one_ball());
    const BodyId ball = world.ids()[0];
    world.set_control(ball, {Vec2d(0.5, 4), 0.0});
    world.step(2.0);
    EXPECT_EQ(world.body(ball).velocity_mps, Vec2d(3, 7));
    EXPECT_EQ(world.body(ball).position_m, Vec2d(5, 6));  // x + v t + a t^2 / 2
}

TEST(Kick, ever_smaller_drag_tends_to_none) {
    const Vec2d none = velocity_after(1.0, 60, {Vec2d(3, 1), 0.0});
    for (const double drag : {1e-6, 1e-9, 1e-12, 1e-15, 1e-300, 5e-324}) {
        const Vec2d little = velocity_after(1.0, 60, {Vec2d(3, 1), drag});
        EXPECT_LE((little - none).norm(), 10.0 * drag + 1e-13) << drag;
    }
}

TEST(Kick, overwhelming_drag_leaves_the_terminal_velocity) {
    const Vec2d v = velocity_after(1.0, 60, {Vec2d(3e9, 0), 1e9});
    EXPECT_NEAR(v.x(), 3.0, 1e-15);
    EXPECT_EQ(v.y(), 0.0);
}

TEST(Kick, drag_alone_stops_a_ball_within_its_stopping_distance) {
    World<double> world(one_ball());
    const BodyId ball = world.ids()[0];
    world.set_control(ball, {Vec2d::Zero(), 4.0});
    for (int i = 0; i < 60 * 20; ++i) world.step(1.0 / 60.0);
    EXPECT_LT(world.body(ball).velocity_mps.norm(), 1e-30);
    EXPECT_NEAR(world.body(ball).position_m.x(), 2.0 / 4.0, 1e-3);
}

TEST(Kick, a_control_acts_until_it_is_taken_back) {
    World<double> world(one_ball());
    const BodyId ball = world.ids()[0];
    world.set_control(ball, {Vec2d(1, 0), 0.0});
    world.step(1.0);
    EXPECT_EQ(world.body(ball).velocity_mps, Vec2d(3, -1));
    world.set_control(ball, {});
    world.step(1.0);
    world.step(1.0);
    EXPECT_EQ(world.body(ball).velocity_mps, Vec2d(3, -1));
    world.set_control(ball, {Vec2d(0, 1), 0.0});
    world.step(1.0);
    EXPECT_EQ(world.body(ball).velocity_mps, Vec2d(3, 0));
}

TEST(Kick, single_precision_reaches_the_same_top_speed) {
    World<float> world(one_ball());
    const BodyId ball = world.ids()[0];
    world.set_control(ball, {Vec2<float>(6, 8), 2.5F});
    for (int i = 0; i < 1800; ++i) world.step(1.0F / 60.0F);
    EXPECT_NEAR(world.body(ball).velocity_mps.norm(), 4.0F, 2e-5F);
}

}  // namespace
}  // namespace fts::physics
