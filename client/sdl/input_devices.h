// InputDevices: keyboard, mouse and gamepads, which may come and go, as what the game asks for.
#pragma once

#include <map>
#include <optional>
#include <set>

#include <SDL.h>
#include <imgui.h>

#include "client/sdl/screens/match.h"
#include "common/game/input.h"

namespace fts::sdl {

class InputDevices {
  public:
    ~InputDevices();
    InputDevices() = default;
    InputDevices(const InputDevices&) = delete;
    InputDevices& operator=(const InputDevices&) = delete;

    // `typing`: keys belong to a text field. Only key presses are kept from the game then; releases
    // always count, so that no key sticks.
    void handle(const SDL_Event& event, bool typing);

    // What was pressed since the last call.
    Actions take_actions();

    // Steering as held now. `own_px` is where the own ball is drawn; the pointer steers from there.
    // Right is +x, up is +y.
    game::InputCommand command(const std::optional<ImVec2>& own_px, float unit) const;

  private:
    void press(SDL_Scancode key);
    void press_pad(int which, Uint8 button);
    physics::Vec2d stick() const;

    std::set<SDL_Scancode> held_;
    std::set<std::pair<SDL_JoystickID, Uint8>> pad_held_;
    std::map<SDL_JoystickID, SDL_GameController*> pads_;
    ImVec2 pointer_{0, 0};
    bool left_button_ = false, right_button_ = false;
    Actions actions_;
};

}  // namespace fts::sdl
