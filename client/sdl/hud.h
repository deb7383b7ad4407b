// The words around the arena: level, clock, coins, players, feed, chat, own ball, link.
#pragma once

#include <deque>
#include <string>

#include "client/core/view.h"
#include "client/sdl/camera.h"
#include "client/sdl/canvas.h"

namespace fts::sdl {

struct FeedLine {
    std::string text;
    Colour colour = palette::kText;
    double born_s = 0.0;
};

struct HudState {
    std::deque<FeedLine> feed;  // oldest first
    std::deque<FeedLine> chat;
    bool velocity_arrows = false;
    bool momentum_arrows = false;
    bool ghost = false;  // where the server has the own ball
    bool shows_keys = true;
    double dash_ready_in_s = 0.0;  // as far as this end can tell
};

// The part of the window between the side panels.
Box stage_of(const Canvas& canvas);

void draw_hud(const Canvas& canvas, const client::View& view, const HudState& state);

// What is said in the middle of the arena: countdown, waiting, out of the game; often nothing.
void draw_announcement(const Canvas& canvas, const Camera& camera, const client::View& view);

}  // namespace fts::sdl
