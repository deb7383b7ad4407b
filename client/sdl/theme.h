// The look of the client as named constants: palette, type scale and spacing. Lengths are in units
// of a 1280 x 720 window; Canvas::px turns them into pixels of the window at hand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <imgui.h>

#include "common/game/level.h"

namespace fts::sdl {

// 0xAABBGGRR, the order ImGui draws in.
using Colour = ImU32;

constexpr Colour rgb(std::uint32_t hex, double alpha = 1.0) {
    const auto a = static_cast<std::uint32_t>(alpha * 255.0 + 0.5);
    return (a << 24U) | ((hex & 0xffU) << 16U) | (hex & 0xff00U) | ((hex >> 16U) & 0xffU);
}
// The same hue, `factor` times as opaque.
Colour fade(Colour colour, double factor);
// From `a` (t = 0) to `b` (t = 1), channel by channel.
Colour mix(Colour a, Colour b, double t);

namespace palette {
inline constexpr Colour kBackground = rgb(0x0a1020);
inline constexpr Colour kBackgroundGlow = rgb(0x15213f);
inline constexpr Colour kPlatformCentre = rgb(0x233255);
inline constexpr Colour kPlatformRim = rgb(0x182341);
inline constexpr Colour kPlatformEdge = rgb(0x7f9ddb);
inline constexpr Colour kPlatformSide = rgb(0x060a15);
inline constexpr Colour kGrid = rgb(0x8fabe6);
inline constexpr Colour kPanel = rgb(0x111a30, 0.97);
inline constexpr Colour kCard = rgb(0x1a2643);
inline constexpr Colour kCardHover = rgb(0x22315a);
inline constexpr Colour kLine = rgb(0x32436f);
inline constexpr Colour kField = rgb(0x0c1326);
inline constexpr Colour kVeil = rgb(0x070c18);
inline constexpr Colour kText = rgb(0xeaf0fb);
inline constexpr Colour kTextQuiet = rgb(0xa9b7d3);
inline constexpr Colour kTextFaint = rgb(0x7c8cae);
inline constexpr Colour kAccent = rgb(0x79c0ff);
inline constexpr Colour kOnAccent = rgb(0x081225);
inline constexpr Colour kGold = rgb(0xf5c451);
inline constexpr Colour kGoldDeep = rgb(0xb07d1a);
inline constexpr Colour kGood = rgb(0x5bd6a6);
inline constexpr Colour kBad = rgb(0xff8b78);
inline constexpr Colour kOwnRing = rgb(0xffffff);
inline constexpr Colour kInk = rgb(0x070b16);

// Okabe and Ito's colours, told apart with any colour vision, lifted for a dark ground.
inline constexpr std::array<Colour, 8> kPlayers = {
    rgb(0x56b4e9), rgb(0xf0a12b), rgb(0x21b98a), rgb(0xe58fc0),
    rgb(0xf0e05a), rgb(0xec6a34), rgb(0x4b86ea), rgb(0xe9e2d4),
};
}  // namespace palette

Colour player_colour(std::uint8_t index);
// AI balls are greys with a tint, so that the players' colours stand out.
Colour behaviour_colour(game::Behaviour behaviour);
const char* behaviour_name(game::Behaviour behaviour);

enum class TextStyle : std::uint8_t { kCaption, kBody, kStrong, kHeading, kTitle, kDisplay };
inline constexpr std::size_t kTextStyleCount = 6;
inline constexpr std::array<float, kTextStyleCount> kTextUnits = {13, 16, 16, 22, 36, 84};

namespace space {
inline constexpr float kHair = 4, kSmall = 8, kMedium = 16, kLarge = 24, kHuge = 40;
inline constexpr float kMargin = 24;      // between the window's edge and anything in it
inline constexpr float kSidePanel = 208;  // width of the player list and of the feed
inline constexpr float kButtonHeight = 46;
inline constexpr float kCorner = 10;
}  // namespace space

}  // namespace fts::sdl
