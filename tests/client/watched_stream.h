// Snapshots of a server that reach a client's clock over a simulated link, and the frames that the
// client draws meanwhile, in simulated time: the same figures from a seed on every machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <span>

#include "client/core/server_clock.h"
#include "common/net/simulated_link.h"
#include "tests/net/memory_network.h"

namespace fts::client {

struct StreamConfig {
    net::LinkConditions link;  // delay_s is the mean flight, unless a test moves `late_s`
    double snapshot_hz = 60.0;
    double frame_hz = 144.0;
    double server_drift = 0.0;  // the server's clock runs faster than ours by this share
};

struct Frame {
    double now_s = 0.0;
    double draw_s = 0.0;   // the server's time that is drawn
    double delay_s = 0.0;  // how far that is behind a snapshot of the mean flight
    bool starved = false;  // the newest snapshot is older than that
};

class WatchedStream {
  public:
    explicit WatchedStream(const StreamConfig& config)
        : config_(config),
          link_(std::make_unique<net::MemoryTransport>(network_, kServer), config.link),
          client_(network_, kClient) {
        // Frames and snapshots have no phase in common.
        const double phase = std::fmod(0.618 * static_cast<double>(config.link.seed), 1.0);
        next_frame_s_ = kStartS + phase / config_.frame_hz;
        next_snapshot_s_ = server_at_s(kStartS);
    }

    // What the server's clock says at local `now_s`.
    double server_at_s(double now_s) const {
        return kServerAheadS - server_behind_s + (now_s - kStartS) * (1.0 + config_.server_drift);
    }

    // Frame after frame, up to `seconds` from now.
    template <typename OnFrame>
    void run(double seconds, OnFrame on_frame) {
        for (const double end_s = now_s_ + seconds; now_s_ < end_s;) {
            send_snapshots_before(next_frame_s_);
            const double last_s = now_s_;
            now_s_ = next_frame_s_;
            next_frame_s_ += 1.0 / config_.frame_hz;
            receive(0.5 * (last_s + now_s_));
            if (clock.started()) on_frame(draw());
        }
    }
    void run(double seconds) {
        run(seconds, [](const Frame&) {});
    }

    ServerClock clock;
    double late_s = 0.0;           // added to every flight
    double server_behind_s = 0.0;  // time that the server has dropped so far
    bool is_cut = false;           // what is sent while this is set is lost

  private:
    static constexpr double kStartS = 50.0, kServerAheadS = 1000.0;
    static constexpr net::Address kServer{{}, 1}, kClient{{}, 2};

    void send_snapshots_before(double until_s) {
        for (;; next_snapshot_s_ += 1.0 / config_.snapshot_hz) {
            const double wait_s = next_snapshot_s_ - server_at_s(now_s_);
            const double at_s = now_s_ + std::max(0.0, wait_s / (1.0 + config_.server_drift));
            if (at_s >= until_s) return;
            link_.poll(at_s, [](const auto&...) {});
            std::uint8_t bytes[sizeof(double)];
            std::memcpy(bytes, &next_snapshot_s_, sizeof bytes);
            if (!is_cut) link_.send(kClient, bytes);
        }
    }

    void receive(double arrival_s) {
        link_.poll(now_s_, [](const auto&...) {});
        client_.poll(now_s_, [&](const net::Address&, std::span<const std::uint8_t> bytes) {
            double server_s = 0.0;
            std::memcpy(&server_s, bytes.data(), sizeof server_s);
            held_up_.emplace(now_s_ + late_s, server_s);
        });
        while (!held_up_.empty() && held_up_.begin()->first <= now_s_) {
            hear(held_up_.extract(held_up_.begin()).mapped(), arrival_s);
        }
    }

    void hear(double server_s, double arrival_s) {
        if (server_s <= newest_s_) return clock.hear(server_s, arrival_s);
        clock.observe(server_s, arrival_s);
        newest_s_ = server_s;
    }

    Frame draw() {
        const double draw_s = clock.draw_time_s(now_s_);
        const double flight_s = config_.link.delay_s + late_s;
        return {now_s_, draw_s, server_at_s(now_s_ - flight_s) - draw_s, draw_s > newest_s_};
    }

    StreamConfig config_;
    net::MemoryNetwork network_;
    net::SimulatedLink link_;
    net::MemoryTransport client_;
    double now_s_ = kStartS, next_frame_s_ = 0.0, next_snapshot_s_ = 0.0;
    double newest_s_ = -1.0;
    std::multimap<double, double> held_up_;  // when it gets here, and the server's time in it
};

}  // namespace fts::client
