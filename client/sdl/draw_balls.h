// Balls: rubber bodies, who they are, how heavy they are, and the arrows of their motion.
#pragma once

#include "client/core/view.h"
#include "client/sdl/camera.h"
#include "client/sdl/canvas.h"

namespace fts::sdl {

struct BallLook {
    Colour colour = palette::kAccent;
    double mass_kg = 1.0;  // the inner ring's thickness tells it
    bool own = false;
    double opacity = 1.0;
};
// A rubber ball without words.
void draw_rubber_ball(const Canvas& canvas, ImVec2 centre, float radius, const BallLook& look);

// The sign of a behaviour, about `size` pixels across.
void draw_behaviour_glyph(const Canvas& canvas, ImVec2 centre, float size,
                          game::Behaviour behaviour, Colour colour);

struct Arrows {
    bool velocity = false;
    bool momentum = false;
};
void draw_balls(const Canvas& canvas, const Camera& camera, const client::View& view,
                const Arrows& arrows);
// Where the server's snapshots have the own ball, when it is drawn elsewhere.
void draw_ghost(const Canvas& canvas, const Camera& camera, const client::View& view);
// Once more, above something that dims the others.
void draw_own_ball(const Canvas& canvas, const Camera& camera, const client::View& view);

Colour ball_colour(const client::BallView& ball);

}  // namespace fts::sdl
