#include "client/sdl/theme.h"

#include <algorithm>
#include <cmath>

namespace fts::sdl {
namespace {

std::uint32_t channel(Colour colour, unsigned shift) {
    return (colour >> shift) & 0xffU;
}

}  // namespace

Colour fade(Colour colour, double factor) {
    const double alpha = channel(colour, 24) * std::clamp(factor, 0.0, 1.0);
    return (colour & 0xffffffU) | (static_cast<std::uint32_t>(std::lround(alpha)) << 24U);
}

Colour mix(Colour a, Colour b, double t) {
    const double share = std::clamp(t, 0.0, 1.0);
    Colour mixed = 0;
    for (const unsigned shift : {0U, 8U, 16U, 24U}) {
        const double value = channel(a, shift) * (1.0 - share) + channel(b, shift) * share;
        mixed |= static_cast<std::uint32_t>(std::lround(value)) << shift;
    }
    return mixed;
}

Colour player_colour(std::uint8_t index) {
    return palette::kPlayers[index % palette::kPlayers.size()];
}

Colour behaviour_colour(game::Behaviour behaviour) {
    switch (behaviour) {
        case game::Behaviour::kChaser:
            return rgb(0xb39a9a);
        case game::Behaviour::kEdgeGuard:
            return rgb(0x93a3b8);
        case game::Behaviour::kInterceptor:
            return rgb(0xa69cbb);
        case game::Behaviour::kHerd:
            return rgb(0x9aad9f);
        case game::Behaviour::kCoward:
            return rgb(0xb5ad97);
        case game::Behaviour::kBruiser:
            return rgb(0x8d8f9c);
    }
    return rgb(0x9a9aa5);
}

const char* behaviour_name(game::Behaviour behaviour) {
    switch (behaviour) {
        case game::Behaviour::kChaser:
            return "Chaser";
        case game::Behaviour::kEdgeGuard:
            return "Edge guard";
        case game::Behaviour::kInterceptor:
            return "Interceptor";
        case game::Behaviour::kHerd:
            return "Herd ball";
        case game::Behaviour::kCoward:
            return "Coward";
        case game::Behaviour::kBruiser:
            return "Bruiser";
    }
    return "AI ball";
}

}  // namespace fts::sdl
