// Screens that say one thing: connecting, and why a session came to an end.
#pragma once

#include <string>

#include "client/sdl/canvas.h"

namespace fts::sdl {

// True when the player gives up waiting.
bool draw_connecting(Canvas& canvas, const std::string& server, bool joining);

enum class NoticeChoice : std::uint8_t { kNone, kBack, kRetry };
NoticeChoice draw_ended(Canvas& canvas, const std::string& title, const std::string& words);

}  // namespace fts::sdl
