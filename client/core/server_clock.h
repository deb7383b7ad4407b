// ServerClock: the server's time as seen from here, from nothing but the ticks of snapshots and
// when they arrived. The fastest of the recent arrivals says what the offset is; the others say how
// late a snapshot can be, which sets how far behind it is safe to draw.
//
// It is the time of the newest snapshot that could be here by now, so half a round trip behind the
// server's own. Times in seconds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "client/core/interpolation_delay.h"
#include "client/core/paced_clock.h"

namespace fts::client {

class ServerClock {
  public:
    // How many arrivals the offset is taken over; about four seconds at 30 Hz. Older ones are
    // forgotten, so that a server or a route that became slower is followed.
    static constexpr std::size_t kWindow = 128;

    // A snapshot of the server's `server_s` arrived at local `arrival_s`. Newer ones only, in
    // order.
    void observe(double server_s, double arrival_s);

    bool started() const { return count_ > 0; }
    // Best estimate; a new arrival may step it either way. Expects `started()`.
    double estimate_s(double now_s) const;
    // The moment to draw: `delay_s()` behind the estimate, never earlier than an earlier answer.
    // Expects `started()`.
    double draw_time_s(double now_s);

    double delay_s() const { return delay_.delay_s(); }
    std::uint64_t delay_limited_count() const { return delay_.limited_count(); }

  private:
    std::array<double, kWindow> offsets_s_{};
    std::size_t count_ = 0;  // ever observed
    double offset_s_ = 0.0;  // the greatest in the window
    double last_server_s_ = 0.0;
    InterpolationDelay delay_;
    PacedClock draw_clock_;
};

}  // namespace fts::client
