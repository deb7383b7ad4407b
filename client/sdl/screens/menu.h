// The first screen: who you are, where to play.
#pragma once

#include <string>

#include "client/sdl/canvas.h"

namespace fts::sdl {

struct MenuState {
    std::string name;
    std::string address;
    std::string problem;  // why the last attempt came to nothing, in words with a remedy; or empty
};
enum class MenuChoice : std::uint8_t { kNone, kJoin, kHost, kQuit };

inline constexpr std::size_t kMaxAddressBytes = 255;

MenuChoice draw_menu(Canvas& canvas, MenuState& state);

}  // namespace fts::sdl
