// Inputs from a client's hands to the tick that takes them, over a simulated link in simulated
// time: the client sends so that they wait as little as the link allows.
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "client/core/input_pacer.h"
#include "client/core/input_queue.h"
#include "common/net/simulated_link.h"
#include "common/replication/delta.h"
#include "common/replication/wire.h"
#include "server/input_queue.h"
#include "server/limits.h"
#include "tests/net/memory_network.h"

namespace fts::server {
namespace {

struct Conditions {
    net::LinkConditions link;
    double server_drift = 0.0;  // its ticks are shorter by this share
    bool told = true;           // the client hears of its slack
};

struct Waits {
    int ticks = 0, dry_ticks = 0;
    double wait_sum_ticks = 0.0;
    std::uint64_t left_out = 0;

    double mean_wait_ms() const { return wait_sum_ticks / (ticks - dry_ticks) * 1e3 / 60.0; }
    double dry_share() const { return double(dry_ticks) / ticks; }
};

// One client that looks 144 times a second, one server that looks a thousand times, as it does
// when every datagram wakes it up.
class Line {
  public:
    explicit Line(const Conditions& conditions)
        : conditions_(conditions),
          link_(std::make_unique<net::MemoryTransport>(network_, kClient), conditions.link),
          server_(network_, kServer) {
        const double phase = std::fmod(0.618 * double(conditions.link.seed), 1.0);
        next_tick_s_ = kStartS + phase * kTickS;
        pacer_.start(kStartS);
    }

    Waits run(double seconds) {
        Waits waits;
        const std::uint64_t left_out_before = queue_.left_out();
        for (const double end_s = now_s_ + seconds; now_s_ < end_s; now_s_ += 1e-3) {
            if (now_s_ >= next_frame_s_) frame();
            receive();
            if (now_s_ >= next_tick_s_) tick(waits);
        }
        waits.left_out = queue_.left_out() - left_out_before;
        return waits;
    }

  private:
    static constexpr double kStartS = 5.0, kTickS = game::kTickDurationS;
    static constexpr net::Address kServer{{}, 1}, kClient{{}, 2};

    void frame() {
        next_frame_s_ += 1.0 / 144.0;
        for (const replication::SnapshotPacket& packet : std::exchange(arrived_, {})) {
            inputs_.acknowledge(packet.acked_input_sequence);
            if (packet.input_slack == replication::kNoInputWaited || !conditions_.told) continue;
            const double slack_ticks = packet.input_slack * replication::kInputSlackStepTicks;
            pacer_.observe(packet.acked_input_sequence, slack_ticks * kTickS, now_s_);
        }
        const auto due = pacer_.due(now_s_, kTickS);
        for (int i = 0; i < due.inputs; ++i) inputs_.push({});
        if (due.inputs > 0) link_.send(kServer, replication::encode(inputs_.packet(0)));
    }

    void receive() {
        link_.poll(now_s_, [&](const net::Address&, std::span<const std::uint8_t> bytes) {
            const auto packet = replication::decode_snapshot_packet(bytes);
            ASSERT_TRUE(packet);
            arrived_.push_back(*packet);
        });
        server_.poll(now_s_, [&](const net::Address&, std::span<const std::uint8_t> bytes) {
            const double ahead_ticks = (next_tick_s_ - now_s_) / kTickS;
            const auto packet = replication::decode_input_packet(bytes);
            ASSERT_TRUE(queue_.add(*packet, std::clamp(ahead_ticks, 0.0, 1.0)));
        });
    }

    void tick(Waits& waits) {
        next_tick_s_ += kTickS * (1.0 - conditions_.server_drift);
        ++tick_;
        queue_.next();
        const std::uint8_t slack = queue_.take_slack();
        ++waits.ticks;
        if (slack == replication::kNoInputWaited) {
            ++waits.dry_ticks;
        } else {
            waits.wait_sum_ticks += (slack + 0.5) * replication::kInputSlackStepTicks;
        }
        const std::uint8_t least = std::min(slack, slack_before_);
        slack_before_ = slack;
        if (tick_ % 2 != 0) return;
        const bool dry = std::max(slack, least) == replication::kNoInputWaited;
        replication::Snapshot snapshot;
        snapshot.tick = tick_;
        const auto part =
            replication::encode_delta({}, snapshot, replication::kMinPartBytes).front();
        server_.send(kClient,
                     replication::encode(replication::SnapshotPacket{
                         queue_.applied_sequence(), dry ? replication::kNoInputWaited : least,
                         replication::SnapshotPacket::Kind::kStates, part}));
    }

    Conditions conditions_;
    net::MemoryNetwork network_;
    net::SimulatedLink link_;
    net::MemoryTransport server_;
    client::InputPacer pacer_;
    client::InputQueue inputs_;
    std::vector<replication::SnapshotPacket> arrived_;  // and not yet looked at
    InputQueue queue_;
    double now_s_ = kStartS, next_frame_s_ = kStartS, next_tick_s_ = 0.0;
    replication::Tick tick_ = 0;
    std::uint8_t slack_before_ = replication::kNoInputWaited;
};

struct Both {
    Waits told, untold;
};

Both compare(const char* what, double jitter_s, double loss, double drift) {
    Both both;
    for (const bool told : {false, true}) {
        Waits& all = told ? both.told : both.untold;
        for (std::uint64_t seed = 1; seed <= 8; ++seed) {
            Line line({{.loss = loss, .delay_s = 0.035, .jitter_s = jitter_s, .seed = seed},
                       drift,
                       told});
            line.run(5.0);
            const Waits waits = line.run(60.0);
            all.ticks += waits.ticks;
            all.dry_ticks += waits.dry_ticks;
            all.wait_sum_ticks += waits.wait_sum_ticks;
            all.left_out += waits.left_out;
        }
    }
    std::printf(
        "%s: inputs wait %.1f ms, were %.1f; ticks without one %.2f %%, were %.2f %%; "
        "left out %d, were %d\n",
        what, both.told.mean_wait_ms(), both.untold.mean_wait_ms(), both.told.dry_share() * 1e2,
        both.untold.dry_share() * 1e2, int(both.told.left_out), int(both.untold.left_out));
    return both;
}

TEST(InputTiming, loses_none_at_low_jitter_and_lets_them_wait_less) {
    const Both both = compare("jitter 2 ms", 0.002, 0.0, 0.0);
    EXPECT_LT(both.told.mean_wait_ms(), 0.8 * both.untold.mean_wait_ms());
    EXPECT_LT(both.told.mean_wait_ms(), 12.0);
    EXPECT_EQ(both.told.left_out, 0U);
    EXPECT_EQ(both.told.dry_ticks, 0);
}

TEST(InputTiming, loses_none_to_clocks_that_drift) {
    for (const double drift : {-200e-6, 200e-6}) {
        SCOPED_TRACE(drift);
        const Both both =
            compare(drift < 0.0 ? "server slower" : "server faster", 0.002, 0.0, drift);
        EXPECT_LT(both.told.mean_wait_ms(), 12.0);
        EXPECT_EQ(both.told.left_out, 0U);
        EXPECT_EQ(both.told.dry_ticks, 0);
    }
}

TEST(InputTiming, takes_no_longer_than_jitter_and_loss_call_for) {
    const Both both = compare("jitter 20 ms, loss 5 %", 0.02, 0.05, 0.0);
    EXPECT_LT(both.told.mean_wait_ms(), both.untold.mean_wait_ms());
    EXPECT_LT(both.told.dry_share(), 0.01);
    EXPECT_LT(both.told.left_out, both.untold.left_out);
}

}  // namespace
}  // namespace fts::server
