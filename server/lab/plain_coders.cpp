// What others send, made as they would, for comparison: floats in Protobuf's wire format; every
// field in as few bits as its range needs; and the delta format of the game (delta.h).
#include <algorithm>
#include <bit>
#include <cmath>

#include "common/replication/byte_stream.h"
#include "common/replication/delta.h"
#include "server/lab/snapshot_coders.h"

namespace fts::lab {
namespace {

using replication::BallState;
using replication::ByteReader;
using replication::ByteWriter;
using replication::Snapshot;

// What these formats have room for: id and motion.
std::vector<BallState> motion_only(const std::vector<BallState>& balls) {
    std::vector<BallState> plain;
    plain.reserve(balls.size());
    for (const BallState& ball : balls) {
        plain.push_back({.id = ball.id, .x = ball.x, .y = ball.y, .vx = ball.vx, .vy = ball.vy});
    }
    return plain;
}

class PlainCoder : public SnapshotCoder {
  public:
    std::vector<BallState> shown(const TraceSnapshot& snapshot) const override {
        return motion_only(snapshot.balls);
    }
};

// message Snapshot { uint32 tick = 1; repeated Ball balls = 2; }
// message Ball { uint32 id = 1; float x_m = 2; float y_m = 3; float vx_mps = 4; float vy_mps = 5; }
class ProtobufCoder : public PlainCoder {
  public:
    std::string name() const override { return "protobuf floats"; }

    std::vector<Datagram> encode(std::span<const TraceSnapshot> history) const override {
        const TraceSnapshot& now = history.back();
        ByteWriter out;
        out.u8(kTickTag);
        out.varint(now.tick);
        for (const BallState& ball : now.balls) {
            ByteWriter message;
            message.u8(kIdTag);
            message.varint(ball.id);
            put(message, 2, ball.x, kTraceLattice.position_step_m);
            put(message, 3, ball.y, kTraceLattice.position_step_m);
            put(message, 4, ball.vx, kTraceLattice.velocity_step_mps);
            put(message, 5, ball.vy, kTraceLattice.velocity_step_mps);
            out.u8(kBallTag);
            out.varint(static_cast<std::uint32_t>(message.size()));
            out.append(message.bytes());
        }
        return {out.take()};
    }
    std::optional<std::vector<BallState>> decode(
        const TraceSnapshot*, std::span<const Datagram> payloads) const override {
        ByteReader in(payloads.front());
        if (in.u8() != kTickTag) return std::nullopt;
        in.varint();
        std::vector<BallState> balls;
        while (!in.failed() && !in.rest().empty()) {
            if (in.u8() != kBallTag) return std::nullopt;
            in.varint();
            BallState ball;
            if (in.u8() != kIdTag) return std::nullopt;
            ball.id = static_cast<std::uint16_t>(in.varint());
            ball.x = taken(in, kTraceLattice.position_step_m);
            ball.y = taken(in, kTraceLattice.position_step_m);
            ball.vx = taken(in, kTraceLattice.velocity_step_mps);
            ball.vy = taken(in, kTraceLattice.velocity_step_mps);
            balls.push_back(ball);
        }
        if (!in.complete()) return std::nullopt;
        return balls;
    }

  private:
    static constexpr std::uint8_t kTickTag = 1 << 3, kIdTag = 1 << 3, kBallTag = 2 << 3 | 2;
    static constexpr std::uint8_t kFixed32 = 5;

    static void put(ByteWriter& out, int field, std::int32_t steps, double step) {
        out.u8(static_cast<std::uint8_t>(field << 3 | kFixed32));
        const auto value = static_cast<float>(replication::dequantise(steps, step));
        out.little_endian(std::bit_cast<std::uint32_t>(value), 4);
    }
    static std::int32_t taken(ByteReader& in, double step) {
        in.u8();
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(in.little_endian(4)));
        return replication::quantise(static_cast<double>(value), step);
    }
};

// Each field in the bits that its least and greatest value of the snapshot ask for.
class BitPackingCoder : public PlainCoder {
  public:
    std::string name() const override { return "plain bit packing"; }

    std::vector<Datagram> encode(std::span<const TraceSnapshot> history) const override {
        const TraceSnapshot& now = history.back();
        ByteWriter out;
        out.varint(now.tick);
        out.varint(static_cast<std::uint32_t>(now.balls.size()));
        std::uint32_t bits = 0, held = 0;
        for (const auto& field : kFields) {
            const auto [least, most] = std::minmax_element(
                now.balls.begin(), now.balls.end(), [&](const BallState& a, const BallState& b) {
                    return value_of(a, field) < value_of(b, field);
                });
            const std::int32_t low = value_of(*least, field);
            const auto width = static_cast<std::uint32_t>(
                std::bit_width(static_cast<std::uint32_t>(value_of(*most, field) - low)));
            out.little_endian(static_cast<std::uint32_t>(low), 4);
            out.u8(static_cast<std::uint8_t>(width));
            for (const BallState& ball : now.balls) {
                const auto above = static_cast<std::uint32_t>(value_of(ball, field) - low);
                for (std::uint32_t i = 0; i < width; ++i) {
                    bits |= (above >> i & 1U) << held;
                    if (++held < 8) continue;
                    out.u8(static_cast<std::uint8_t>(bits));
                    bits = held = 0;
                }
            }
            if (held > 0) out.u8(static_cast<std::uint8_t>(bits));
            bits = held = 0;
        }
        return {out.take()};
    }
    std::optional<std::vector<BallState>> decode(
        const TraceSnapshot*, std::span<const Datagram> payloads) const override {
        ByteReader in(payloads.front());
        in.varint();
        std::vector<BallState> balls(in.varint_up_to(1U << 16));
        for (const auto& field : kFields) {
            const auto low = static_cast<std::int32_t>(in.little_endian(4));
            const std::uint32_t width = in.u8();
            if (in.failed() || width > 32) return std::nullopt;
            std::uint32_t bits = 0, held = 0;
            for (BallState& ball : balls) {
                std::uint32_t above = 0;
                for (std::uint32_t i = 0; i < width; ++i) {
                    if (held == 0) {
                        bits = in.u8();
                        held = 8;
                    }
                    above |= (bits & 1U) << i;
                    bits >>= 1;
                    --held;
                }
                set_value(ball, field, low + static_cast<std::int32_t>(above));
            }
        }
        if (!in.complete()) return std::nullopt;
        return balls;
    }

  private:
    enum class Field { kId, kX, kY, kVx, kVy };
    static constexpr Field kFields[] = {Field::kId, Field::kX, Field::kY, Field::kVx, Field::kVy};

    static std::int32_t value_of(const BallState& ball, Field field) {
        switch (field) {
            case Field::kId:
                return ball.id;
            case Field::kX:
                return ball.x;
            case Field::kY:
                return ball.y;
            case Field::kVx:
                return ball.vx;
            case Field::kVy:
                break;
        }
        return ball.vy;
    }
    static void set_value(BallState& ball, Field field, std::int32_t value) {
        switch (field) {
            case Field::kId:
                ball.id = static_cast<std::uint16_t>(value);
                break;
            case Field::kX:
                ball.x = value;
                break;
            case Field::kY:
                ball.y = value;
                break;
            case Field::kVx:
                ball.vx = value;
                break;
            case Field::kVy:
                ball.vy = value;
                break;
        }
    }
};

class DeltaCoder : public PlainCoder {
  public:
    std::string name() const override { return "the game's delta format"; }

    std::vector<BallState> shown(const TraceSnapshot& snapshot) const override {
        return of_game(snapshot).balls;
    }
    std::vector<Datagram> encode(std::span<const TraceSnapshot> history) const override {
        const Snapshot baseline = history.size() > 1 ? of_game(history.front()) : Snapshot{};
        return replication::encode_delta(baseline, of_game(history.back()), kMaxDatagramBytes);
    }
    std::optional<std::vector<BallState>> decode(
        const TraceSnapshot* baseline, std::span<const Datagram> payloads) const override {
        const Snapshot before = baseline != nullptr ? of_game(*baseline) : Snapshot{};
        std::vector<BallState> balls;
        for (const Datagram& part : payloads) {
            const auto snapshot = replication::decode_part(before, part);
            if (!snapshot) return std::nullopt;
            balls.insert(balls.end(), snapshot->balls.begin(), snapshot->balls.end());
        }
        return balls;
    }

  private:
    static Snapshot of_game(const TraceSnapshot& snapshot) {
        Snapshot game;
        game.tick = snapshot.tick;
        game.balls = motion_only(snapshot.balls);
        for (BallState& ball : game.balls) {
            ball.vx = static_cast<std::int32_t>(std::lround(ball.vx * kGameStepsPerTraceStep));
            ball.vy = static_cast<std::int32_t>(std::lround(ball.vy * kGameStepsPerTraceStep));
        }
        return game;
    }
};

}  // namespace

std::unique_ptr<SnapshotCoder> make_protobuf_coder() {
    return std::make_unique<ProtobufCoder>();
}
std::unique_ptr<SnapshotCoder> make_bit_packing_coder() {
    return std::make_unique<BitPackingCoder>();
}
std::unique_ptr<SnapshotCoder> make_delta_coder() {
    return std::make_unique<DeltaCoder>();
}

}  // namespace fts::lab
