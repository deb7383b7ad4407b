#include "common/replication/thrust_model.h"

#include <initializer_list>

namespace fts::replication {
namespace {

constexpr std::uint32_t kKeyboardWeight = 24;

ByteModel likely(std::initializer_list<std::int8_t> values) {
    std::array<std::uint32_t, 512> weights{};
    for (std::size_t leaf = 256; leaf < 512; ++leaf) weights[leaf] = 1;
    for (const std::int8_t value : values) weights[256 + static_cast<std::uint8_t>(value)] = 4000;
    for (std::size_t node = 255; node > 0; --node) {
        weights[node] = weights[2 * node] + weights[2 * node + 1];
    }
    ByteModel model;
    for (std::size_t node = 1; node < 256; ++node) {
        model.nodes[node] = {65536U / weights[node] * weights[2 * node + 1] +
                                 65536U % weights[node] * weights[2 * node + 1] / weights[node],
                             kKeyboardWeight};
    }
    return model;
}

}  // namespace

ThrustModel ThrustModel::of_keyboards() {
    // A copy is a tenth of the work, and every part of a snapshot begins with one.
    static const ThrustModel kModel = [] {
        ThrustModel model;
        model.x = likely({0, 127, -127, 90, -90});
        model.y = {likely({0, 127, -127}), likely({90, -90}), likely({0})};
        return model;
    }();
    return kModel;
}

}  // namespace fts::replication
