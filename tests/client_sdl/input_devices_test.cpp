#include "client/sdl/input_devices.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fts::sdl {
namespace {

SDL_Event key(SDL_Scancode scancode, bool down) {
    SDL_Event event{};
    event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
    event.key.keysym.scancode = scancode;
    return event;
}

SDL_Event mouse(Uint8 button, bool down, int x, int y) {
    SDL_Event event{};
    event.type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP;
    event.button.button = button;
    event.button.x = x;
    event.button.y = y;
    return event;
}

SDL_Event pad_button(Uint8 button, bool down) {
    SDL_Event event{};
    event.type = down ? SDL_CONTROLLERBUTTONDOWN : SDL_CONTROLLERBUTTONUP;
    event.cbutton.which = 3;
    event.cbutton.button = button;
    return event;
}

class Devices : public testing::Test {
  protected:
    void hold(SDL_Scancode scancode, bool typing = false) {
        devices_.handle(key(scancode, true), typing);
    }
    void let_go(SDL_Scancode scancode, bool typing = false) {
        devices_.handle(key(scancode, false), typing);
    }
    physics::Vec2d thrust() const { return game::thrust_of(command()); }
    game::InputCommand command() const { return devices_.command(ImVec2{400, 300}, 1.0F); }

    InputDevices devices_;
};

TEST_F(Devices, ask_for_nothing_when_nothing_is_held) {
    EXPECT_EQ(command(), game::InputCommand{});
}

TEST_F(Devices, steer_by_letters_and_arrows_with_up_as_plus_y) {
    for (const SDL_Scancode up : {SDL_SCANCODE_W, SDL_SCANCODE_UP}) {
        hold(up);
        EXPECT_NEAR(thrust().y(), 1.0, 0.01);
        EXPECT_NEAR(thrust().x(), 0.0, 0.01);
        let_go(up);
    }
    hold(SDL_SCANCODE_A);
    hold(SDL_SCANCODE_S);
    EXPECT_NEAR(thrust().x(), -std::sqrt(0.5), 0.01);
    EXPECT_NEAR(thrust().y(), -std::sqrt(0.5), 0.01);
    hold(SDL_SCANCODE_D);
    EXPECT_NEAR(thrust().x(), 0.0, 0.01);
}

TEST_F(Devices, dash_and_brake_while_held) {
    hold(SDL_SCANCODE_SPACE);
    hold(SDL_SCANCODE_RSHIFT);
    EXPECT_TRUE(command().dash);
    EXPECT_TRUE(command().brake);
    let_go(SDL_SCANCODE_SPACE);
    let_go(SDL_SCANCODE_RSHIFT);
    EXPECT_FALSE(command().dash);
    EXPECT_FALSE(command().brake);
}

TEST_F(Devices, thrust_towards_the_pointer_while_the_left_button_is_held) {
    devices_.handle(mouse(SDL_BUTTON_LEFT, true, 400, 100), false);
    EXPECT_NEAR(thrust().y(), 1.0, 0.01);
    SDL_Event motion{};
    motion.type = SDL_MOUSEMOTION;
    motion.motion.x = 445;
    motion.motion.y = 300;
    devices_.handle(motion, false);
    EXPECT_NEAR(thrust().x(), 0.5, 0.01);
    EXPECT_NEAR(thrust().y(), 0.0, 0.01);
    devices_.handle(mouse(SDL_BUTTON_LEFT, false, 445, 300), false);
    EXPECT_TRUE(thrust().isZero());
}

TEST_F(Devices, ignore_the_pointer_without_an_own_ball) {
    devices_.handle(mouse(SDL_BUTTON_LEFT, true, 10, 10), false);
    devices_.handle(mouse(SDL_BUTTON_RIGHT, true, 10, 10), false);
    const game::InputCommand without = devices_.command(std::nullopt, 1.0F);
    EXPECT_EQ(without.thrust_x, 0);
    EXPECT_TRUE(without.brake);
}

TEST_F(Devices, keep_typed_letters_from_the_ball_but_never_let_a_key_stick) {
    hold(SDL_SCANCODE_W);
    hold(SDL_SCANCODE_E, true);
    hold(SDL_SCANCODE_D, true);
    EXPECT_FALSE(devices_.take_actions().inspector);
    EXPECT_NEAR(thrust().x(), 0.0, 0.01);
    let_go(SDL_SCANCODE_W, true);
    EXPECT_TRUE(thrust().isZero());
}

TEST_F(Devices, tell_each_press_once) {
    hold(SDL_SCANCODE_E);
    hold(SDL_SCANCODE_4);
    hold(SDL_SCANCODE_ESCAPE, true);
    const Actions actions = devices_.take_actions();
    EXPECT_TRUE(actions.inspector);
    EXPECT_TRUE(actions.back);
    EXPECT_EQ(actions.slot, 3);
    const Actions later = devices_.take_actions();
    EXPECT_FALSE(later.inspector || later.back || later.slot.has_value());
}

TEST_F(Devices, do_not_repeat_a_key_that_the_keyboard_repeats) {
    SDL_Event repeated = key(SDL_SCANCODE_V, true);
    repeated.key.repeat = 1;
    devices_.handle(repeated, false);
    EXPECT_FALSE(devices_.take_actions().velocities);
}

TEST_F(Devices, take_gamepad_buttons_and_forget_them_when_the_pad_is_pulled_out) {
    devices_.handle(pad_button(SDL_CONTROLLER_BUTTON_A, true), false);
    devices_.handle(pad_button(SDL_CONTROLLER_BUTTON_B, true), false);
    devices_.handle(pad_button(SDL_CONTROLLER_BUTTON_Y, true), false);
    EXPECT_TRUE(command().dash);
    EXPECT_TRUE(command().brake);
    EXPECT_TRUE(devices_.take_actions().inspector);
    SDL_Event removed{};
    removed.type = SDL_CONTROLLERDEVICEREMOVED;
    removed.cdevice.which = 3;
    devices_.handle(removed, false);
    EXPECT_FALSE(command().dash);
    EXPECT_FALSE(command().brake);
}

TEST_F(Devices, let_go_of_everything_when_the_window_loses_the_keyboard) {
    hold(SDL_SCANCODE_D);
    devices_.handle(mouse(SDL_BUTTON_RIGHT, true, 0, 0), false);
    SDL_Event lost{};
    lost.type = SDL_WINDOWEVENT;
    lost.window.event = SDL_WINDOWEVENT_FOCUS_LOST;
    devices_.handle(lost, false);
    EXPECT_EQ(command(), game::InputCommand{});
}

}  // namespace
}  // namespace fts::sdl
