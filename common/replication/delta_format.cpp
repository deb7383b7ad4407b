#include "common/replication/delta_format.h"

namespace fts::replication::delta_format {
namespace {

class Fnv1a {
  public:
    void add(std::uint32_t word) { hash_ = (hash_ ^ word) * 1099511628211U; }
    void add(std::int32_t word) { add(static_cast<std::uint32_t>(word)); }
    std::uint16_t top_16_bits() const { return static_cast<std::uint16_t>(hash_ >> 48); }

  private:
    std::uint64_t hash_ = 14695981039346656037U;
};

std::uint32_t byte(std::int8_t value) {
    return static_cast<std::uint8_t>(value);
}

void add_ball(Fnv1a& hash, const BallState& ball) {
    hash.add(ball.id | std::uint32_t{ball.player_id} << 16);
    hash.add(ball.x);
    hash.add(ball.y);
    hash.add(ball.vx);
    hash.add(ball.vy);
    hash.add(byte(ball.thrust_x) | byte(ball.thrust_y) << 8 | std::uint32_t{ball.brake} << 16 |
             std::uint32_t{ball.kind} << 18 | std::uint32_t{ball.behaviour} << 19);
    hash.add(std::uint32_t{ball.radius});
    hash.add(ball.mass);
    hash.add(ball.handling.acceleration);
    hash.add(ball.handling.drag);
    hash.add(ball.handling.braking);
    hash.add(ball.handling.dash);
}

}  // namespace

std::uint16_t digest_of(const Snapshot& snapshot) {
    Fnv1a hash;
    hash.add(snapshot.tick);
    hash.add(std::uint32_t{snapshot.arena} | std::uint32_t{snapshot.level} << 16);
    hash.add(snapshot.phase_end_tick);
    for (const BallState& ball : snapshot.balls) add_ball(hash, ball);
    for (const CoinState& coin : snapshot.coins) {
        hash.add(coin.id | std::uint32_t{coin.value_coins} << 16);
        hash.add(coin.x);
        hash.add(coin.y);
    }
    return hash.top_16_bits();
}

std::int32_t predicted_position(std::int32_t position, std::int32_t velocity_before,
                                std::int32_t velocity_after, std::uint32_t ticks) {
    constexpr auto kPositionStepsPerVelocityStep =
        static_cast<std::int64_t>(kVelocityStepMps / kPositionStepM);
    static_assert(static_cast<double>(kPositionStepsPerVelocityStep) * kPositionStepM ==
                  kVelocityStepMps);
    constexpr std::int64_t kDivisor = 4 * std::int64_t{game::kTickRateHz};
    const std::int64_t numerator = 2 * kPositionStepsPerVelocityStep * ticks *
                                       (std::int64_t{velocity_before} + velocity_after) +
                                   kDivisor / 2;
    const std::int64_t rounded_down = (numerator - (numerator < 0 ? kDivisor - 1 : 0)) / kDivisor;
    return wrapping_sum(position, rounded_down);
}

BallState predicted(const BallState& before, std::uint32_t ticks) {
    BallState ball = before;
    ball.x = predicted_position(before.x, before.vx, before.vx, ticks);
    ball.y = predicted_position(before.y, before.vy, before.vy, ticks);
    return ball;
}

std::vector<std::uint8_t> with_digest(std::span<const std::uint8_t> bytes) {
    StateDigest digest;
    digest.add(bytes);
    ByteWriter out;
    out.append(bytes);
    out.little_endian(digest.value(), kDigestBytes);
    return out.take();
}

std::optional<std::span<const std::uint8_t>> without_digest(std::span<const std::uint8_t> part) {
    if (part.size() < kDigestBytes) return std::nullopt;
    const auto bytes = part.first(part.size() - kDigestBytes);
    StateDigest digest;
    digest.add(bytes);
    ByteReader in(part.last(kDigestBytes));
    if (in.little_endian(kDigestBytes) != digest.value()) return std::nullopt;
    return bytes;
}

}  // namespace fts::replication::delta_format
