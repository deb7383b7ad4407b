// Tells one state, and how it was said, from another: FNV-1a over 32-bit words, the top half of 64
// bits. It finds what was altered or predicted otherwise; against who alters on purpose, packets
// are sealed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/replication/snapshot.h"

namespace fts::replication {

class StateDigest {
  public:
    static constexpr std::size_t kBytes = 4;

    void add(std::uint32_t word) { hash_ = (hash_ ^ word) * 1099511628211U; }
    void add(std::int32_t word) { add(static_cast<std::uint32_t>(word)); }
    void add(const BallState& ball) {
        add(ball.id | std::uint32_t{ball.player_id} << 16);
        add(ball.x);
        add(ball.y);
        add(ball.vx);
        add(ball.vy);
        add(byte(ball.thrust_x) | byte(ball.thrust_y) << 8 | std::uint32_t{ball.brake} << 16 |
            std::uint32_t{ball.kind} << 18 | std::uint32_t{ball.behaviour} << 20);
        add(std::uint32_t{ball.radius});
        add(ball.mass);
        add(ball.handling.acceleration);
        add(ball.handling.drag);
        add(ball.handling.braking);
        add(ball.handling.dash);
    }
    // As little-endian words, the last filled up with zeros; then how many there were.
    void add(std::span<const std::uint8_t> bytes) {
        std::uint32_t word = 0;
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            word |= std::uint32_t{bytes[i]} << (8 * (i % 4));
            if (i % 4 != 3 && i + 1 != bytes.size()) continue;
            add(word);
            word = 0;
        }
        add(static_cast<std::uint32_t>(bytes.size()));
    }
    std::uint32_t value() const { return static_cast<std::uint32_t>(hash_ >> 32); }

  private:
    static std::uint32_t byte(std::int8_t value) { return static_cast<std::uint8_t>(value); }

    std::uint64_t hash_ = 14695981039346656037U;
};

}  // namespace fts::replication
