// The ground of the match: background, platform, coins.
#pragma once

#include <vector>

#include "client/core/view.h"
#include "client/sdl/camera.h"
#include "client/sdl/canvas.h"

namespace fts::sdl {

void draw_background(const Canvas& canvas);
void draw_platform(const Canvas& canvas, const Camera& camera, const physics::Platform& platform);
void draw_coins(const Canvas& canvas, const Camera& camera,
                const std::vector<client::CoinView>& coins);

}  // namespace fts::sdl
