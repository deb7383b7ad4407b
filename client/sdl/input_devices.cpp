#include "client/sdl/input_devices.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fts::sdl {
namespace {

constexpr double kStickDeadZone = 0.18;
constexpr double kStickRange = 32767.0;
constexpr float kFullThrustUnits = 90;  // pointer this far from the ball: full thrust

double along(const std::set<SDL_Scancode>& held, std::array<SDL_Scancode, 2> forwards,
             std::array<SDL_Scancode, 2> backwards) {
    const auto any = [&](const std::array<SDL_Scancode, 2>& keys) {
        return std::ranges::any_of(keys, [&](SDL_Scancode key) { return held.contains(key); });
    };
    return (any(forwards) ? 1.0 : 0.0) - (any(backwards) ? 1.0 : 0.0);
}

}  // namespace

InputDevices::~InputDevices() {
    for (const auto& [id, pad] : pads_) SDL_GameControllerClose(pad);
}

void InputDevices::handle(const SDL_Event& event, bool typing) {
    switch (event.type) {
        case SDL_KEYDOWN:
            if (event.key.repeat != 0) break;
            if (event.key.keysym.scancode == SDL_SCANCODE_ESCAPE) actions_.back = true;
            if (typing) break;
            held_.insert(event.key.keysym.scancode);
            press(event.key.keysym.scancode);
            break;
        case SDL_KEYUP:
            held_.erase(event.key.keysym.scancode);
            break;
        case SDL_MOUSEMOTION:
            pointer_ = {static_cast<float>(event.motion.x), static_cast<float>(event.motion.y)};
            break;
        case SDL_MOUSEBUTTONDOWN:
        case SDL_MOUSEBUTTONUP:
            pointer_ = {static_cast<float>(event.button.x), static_cast<float>(event.button.y)};
            if (event.button.button == SDL_BUTTON_LEFT) {
                left_button_ = event.type == SDL_MOUSEBUTTONDOWN;
            }
            if (event.button.button == SDL_BUTTON_RIGHT) {
                right_button_ = event.type == SDL_MOUSEBUTTONDOWN;
            }
            break;
        case SDL_CONTROLLERDEVICEADDED:
            if (SDL_GameController* pad = SDL_GameControllerOpen(event.cdevice.which)) {
                pads_[SDL_JoystickInstanceID(SDL_GameControllerGetJoystick(pad))] = pad;
            }
            break;
        case SDL_CONTROLLERDEVICEREMOVED:
            if (const auto pad = pads_.find(event.cdevice.which); pad != pads_.end()) {
                SDL_GameControllerClose(pad->second);
                pads_.erase(pad);
            }
            std::erase_if(pad_held_,
                          [&](const auto& held) { return held.first == event.cdevice.which; });
            break;
        case SDL_CONTROLLERBUTTONDOWN:
            press_pad(event.cbutton.which, event.cbutton.button);
            break;
        case SDL_CONTROLLERBUTTONUP:
            pad_held_.erase({event.cbutton.which, event.cbutton.button});
            break;
        case SDL_WINDOWEVENT:
            if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) {
                held_.clear();
                pad_held_.clear();
                left_button_ = right_button_ = false;
            }
            break;
        default:
            break;
    }
}

void InputDevices::press(SDL_Scancode key) {
    switch (key) {
        case SDL_SCANCODE_E:
            actions_.inspector = true;
            break;
        case SDL_SCANCODE_V:
            actions_.velocities = true;
            break;
        case SDL_SCANCODE_M:
            actions_.momenta = true;
            break;
        case SDL_SCANCODE_G:
            actions_.ghost = true;
            break;
        case SDL_SCANCODE_C:
            actions_.camera = true;
            break;
        case SDL_SCANCODE_H:
            actions_.keys = true;
            break;
        case SDL_SCANCODE_T:
            actions_.chat = true;
            break;
        default:
            break;
    }
    constexpr int kSlots = static_cast<int>(game::kStatCount);
    const int number = static_cast<int>(key) - static_cast<int>(SDL_SCANCODE_1);
    if (number >= 0 && number < kSlots) actions_.slot = number;
    const int pad_number = static_cast<int>(key) - static_cast<int>(SDL_SCANCODE_KP_1);
    if (pad_number >= 0 && pad_number < kSlots) actions_.slot = pad_number;
}

void InputDevices::press_pad(int which, Uint8 button) {
    pad_held_.insert({which, button});
    if (button == SDL_CONTROLLER_BUTTON_Y) actions_.inspector = true;
    if (button == SDL_CONTROLLER_BUTTON_X) actions_.velocities = true;
    if (button == SDL_CONTROLLER_BUTTON_START) actions_.back = true;
    if (button == SDL_CONTROLLER_BUTTON_BACK) actions_.camera = true;
}

Actions InputDevices::take_actions() {
    const Actions taken = actions_;
    actions_ = {};
    return taken;
}

physics::Vec2d InputDevices::stick() const {
    physics::Vec2d strongest = physics::Vec2d::Zero();
    for (const auto& [id, pad] : pads_) {
        const physics::Vec2d tilt(
            SDL_GameControllerGetAxis(pad, SDL_CONTROLLER_AXIS_LEFTX) / kStickRange,
            -SDL_GameControllerGetAxis(pad, SDL_CONTROLLER_AXIS_LEFTY) / kStickRange);
        if (tilt.norm() > strongest.norm()) strongest = tilt;
    }
    const double length = strongest.norm();
    if (length < kStickDeadZone) return physics::Vec2d::Zero();
    const double pushed = std::min(1.0, (length - kStickDeadZone) / (1.0 - kStickDeadZone));
    return strongest * (pushed / length);
}

game::InputCommand InputDevices::command(const std::optional<ImVec2>& own_px, float unit) const {
    physics::Vec2d thrust(
        along(held_, {SDL_SCANCODE_D, SDL_SCANCODE_RIGHT}, {SDL_SCANCODE_A, SDL_SCANCODE_LEFT}),
        along(held_, {SDL_SCANCODE_W, SDL_SCANCODE_UP}, {SDL_SCANCODE_S, SDL_SCANCODE_DOWN}));
    if (thrust.norm() > 1.0) thrust.normalize();
    if (thrust.isZero()) thrust = stick();
    if (thrust.isZero() && left_button_ && own_px) {
        const physics::Vec2d offset(static_cast<double>(pointer_.x - own_px->x),
                                    static_cast<double>(own_px->y - pointer_.y));
        thrust = offset / static_cast<double>(kFullThrustUnits * unit);
        if (thrust.norm() > 1.0) thrust.normalize();
    }
    const auto pad_holds = [&](Uint8 button) {
        return std::ranges::any_of(pad_held_,
                                   [&](const auto& held) { return held.second == button; });
    };
    game::InputCommand command = game::command_toward(thrust);
    command.dash = held_.contains(SDL_SCANCODE_SPACE) || pad_holds(SDL_CONTROLLER_BUTTON_A);
    command.brake = held_.contains(SDL_SCANCODE_LSHIFT) || held_.contains(SDL_SCANCODE_RSHIFT) ||
                    right_button_ || pad_holds(SDL_CONTROLLER_BUTTON_B);
    return command;
}

}  // namespace fts::sdl
