#include "client/bot/pilot.h"

#include <array>

#include "client/bot/pilots/chaser.h"
#include "client/bot/pilots/collector.h"
#include "client/bot/pilots/defender.h"
#include "client/bot/pilots/idle.h"
#include "client/bot/pilots/wanderer.h"

namespace fts::bot {
namespace {

using Maker = std::unique_ptr<Pilot> (*)();

template <typename T>
std::unique_ptr<Pilot> make() {
    return std::make_unique<T>();
}

constexpr std::array<std::string_view, 5> kNames = {"chaser", "collector", "defender", "wanderer",
                                                    "idle"};
constexpr std::array<Maker, kNames.size()> kMakers = {make<Chaser>, make<Collector>, make<Defender>,
                                                      make<Wanderer>, make<Idle>};

}  // namespace

std::span<const std::string_view> pilot_names() {
    return kNames;
}

std::unique_ptr<Pilot> make_pilot(std::string_view name) {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        if (kNames[i] == name) return kMakers[i]();
    }
    return nullptr;
}

double uniform(Rng& rng, double low, double high) {
    constexpr double kTwoToMinus53 = 1.0 / 9007199254740992.0;
    return low + (high - low) * (static_cast<double>(rng() >> 11U) * kTwoToMinus53);
}

}  // namespace fts::bot
