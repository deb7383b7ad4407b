// InterpolationDelay: how far behind the server's time to draw, so that the snapshot to draw
// towards has nearly always arrived. Follows what arrivals needed: up at once, down slowly.
#pragma once

#include <cstdint>

namespace fts::client {

// Until the first measurement.
inline constexpr double kInitialDelayS = 0.1;
// A longer stall is seen as a stall rather than paid for in latency by every later frame.
inline constexpr double kMaxDelayS = 0.4;
// Kept on top of what was measured, for the spread within one frame.
inline constexpr double kDelayMarginS = 0.005;
// Time constant of the way down.
inline constexpr double kDelayFallS = 4.0;

class InterpolationDelay {
  public:
    // An arrival at local time `arrival_s` would have been in time with a delay of `needed_s`.
    void observe(double needed_s, double arrival_s);

    double delay_s() const { return delay_s_; }
    // Arrivals that would have needed more than kMaxDelayS.
    std::uint64_t limited_count() const { return limited_count_; }

  private:
    bool measured_ = false;
    double delay_s_ = kInitialDelayS;
    double last_arrival_s_ = 0.0;
    std::uint64_t limited_count_ = 0;
};

}  // namespace fts::client
