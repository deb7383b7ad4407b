// The match: arena, balls, effects and HUD, with the inspector, the shop and the pause menu over
// it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/core/session.h"
#include "client/core/view.h"
#include "client/sdl/camera.h"
#include "client/sdl/canvas.h"
#include "client/sdl/draw_effects.h"
#include "client/sdl/hud.h"
#include "client/sdl/screens/shop.h"
#include "common/game/input.h"

namespace fts::sdl {

// What the player did with keys or buttons since the last frame, beside steering.
struct Actions {
    bool inspector = false, velocities = false, momenta = false, camera = false, keys = false;
    bool ghost = false, chat = false, back = false;
    std::optional<int> slot;  // 0 to 5, of the shop
};

struct MatchState {
    HudState hud;
    ShopState shop;
    Effects effects;
    Camera camera;
    CameraMode camera_mode = CameraMode::kWhole;
    bool inspecting = false;
    bool paused = false;
    bool chatting = false;
    std::string draft;                                // of a chat line
    std::map<std::uint16_t, std::string> ball_names;  // of those seen
    double drawn_s = -1.0;  // when the last frame was drawn; negative: never
};

struct MatchChoice {
    std::optional<game::Stat> buy;
    bool ready = false;
    std::optional<std::string> chat;
    bool leave = false, quit = false;
};

// True while something is shown that is to hold to the last bit: then every ball is drawn where the
// server has it, at one moment.
bool shows_laws(const MatchState& state);

// True while keys, mouse and gamepad steer the ball rather than a menu.
bool steers(const MatchState& state, const client::View& view);

void apply(const Actions& actions, MatchState& state, const client::View& view);
// Keeps count of the dash that `command` asks for, as the server will.
void count_dash(const game::InputCommand& command, const client::View& view, double dt_s,
                HudState& hud);
void take_notices(const std::vector<client::Notice>& notices, const client::View& view,
                  MatchState& state, double now_s);
MatchChoice draw_match(Canvas& canvas, const client::View& view, MatchState& state,
                       std::optional<int> slot);

}  // namespace fts::sdl
