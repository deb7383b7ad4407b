// The last own hit, as the paper draws it: figure 1 (in the plane), figure 2 (turned so that the
// line of centres lies flat), the numbers, and a sentence that says why it went as it did.
#pragma once

#include "client/core/view.h"
#include "client/sdl/canvas.h"

namespace fts::sdl {

// True when the player closes it.
bool draw_inspector(Canvas& canvas, const client::View& view);

// The two figures, for drawing elsewhere.
struct HitColours {
    Colour own, other;
};
void draw_figure_in_plane(const Canvas& canvas, const Box& box,
                          const replication::CollisionReport& hit, const HitColours& colours);
void draw_figure_turned(const Canvas& canvas, const Box& box,
                        const replication::CollisionReport& hit, const HitColours& colours);

}  // namespace fts::sdl
