// How a control is coded: what a keyboard can say (eight directions or none) is believed likely,
// anything else can be said.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/replication/range_coder.h"
#include "common/replication/snapshot.h"

namespace fts::replication {

// A byte, most significant bit first; each bit knows those before it.
struct ByteModel {
    std::array<AdaptiveBit, 256> nodes;

    template <typename Coder>
    std::uint8_t code(Coder& coder, std::uint8_t value) {
        std::uint32_t node = 1;
        for (int i = 7; i >= 0; --i) {
            const bool set = coder.bit(nodes[node], (value >> i & 1) != 0);
            node = node << 1 | (set ? 1U : 0U);
        }
        return static_cast<std::uint8_t>(node);
    }
};

struct ThrustModel {
    ByteModel x;
    std::array<ByteModel, 3> y;  // by what x is: none, in between, full
    AdaptiveBit brake{0x1000, 8};

    static ThrustModel of_keyboards();

    // The control of a ball: told to an encoder, set by a decoder.
    template <typename Coder, typename Steered>
    void code(Coder& coder, Steered& ball) {
        const std::uint8_t x_byte = x.code(coder, static_cast<std::uint8_t>(ball.thrust_x));
        const std::uint8_t y_byte =
            y[kind_of(x_byte)].code(coder, static_cast<std::uint8_t>(ball.thrust_y));
        ball.thrust_x = static_cast<std::int8_t>(x_byte);
        ball.thrust_y = static_cast<std::int8_t>(y_byte);
        ball.brake = coder.bit(brake, ball.brake);
    }

  private:
    static std::size_t kind_of(std::uint8_t x_byte) {
        const auto value = static_cast<std::int8_t>(x_byte);
        return value == 0 ? 0 : value == 127 || value == -127 ? 2 : 1;
    }
};

inline bool same_control(const BallState& a, const BallState& b) {
    return a.thrust_x == b.thrust_x && a.thrust_y == b.thrust_y && a.brake == b.brake;
}

}  // namespace fts::replication
