// A picture of the window as a PNG file.
#pragma once

#include <string>

#include "client/sdl/rasteriser.h"

namespace fts::sdl {

// False with `error` set to a message that names the file and a remedy.
bool write_png(const PixelView& picture, const std::string& path, std::string& error);

}  // namespace fts::sdl
