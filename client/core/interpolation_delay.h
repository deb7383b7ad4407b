// InterpolationDelay: how far behind its snapshots a client has to draw, so that a newer one is
// nearly always there to draw towards. A lost or late snapshot costs nothing if the one after it
// comes in time; what counts is how old the newest one had grown each time a newer one came. From
// those ages it takes the least delay that would have left only a small share of the time in a
// window without one: up at once, down when what called for it has left the window.
//
// Ages are local time less server time: what the two clocks differ by is part of them. Seconds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fts::client {

// Beyond the usual flight of a snapshot, until the first two have come.
inline constexpr double kInitialDelayS = 0.1;
// As far beyond the usual flight as a delay goes. A longer stall is seen as a stall rather than
// paid for in latency by every later frame.
inline constexpr double kMaxDelayS = 0.4;
// What is remembered, and so how long a bad moment is paid for.
inline constexpr double kDelayWindowS = 30.0;
// The share of that time that may go without a newer snapshot.
inline constexpr double kDelayStarvedShare = 0.001;
// Kept on top, so that a stream without any jitter is not cut short by a hair.
inline constexpr double kDelayMarginS = 1e-4;
// The one worst moment of a full window is a hiccup, not the way the link is.
inline constexpr std::size_t kDelayHiccups = 1;

class InterpolationDelay {
  public:
    // At most this many gaps are remembered: the whole window at 60 Hz.
    static constexpr std::size_t kMaxGaps = 2048;
    // How often the delay is made shorter.
    static constexpr double kReviewS = 0.5;

    // At local `now_s` the newest snapshot was `age_s` old, and then a newer one came. The usual
    // flight of a snapshot is `flight_s`, of the same origin as the ages. Times ascend.
    void observe(double age_s, double flight_s, double now_s);

    // Draw what the server had this long ago; 0 until something was observed.
    double age_to_draw_s() const { return age_to_draw_s_; }
    // How far beyond its usual flight the newest has grown old when a newer one comes, on average.
    double mean_excess_s() const { return mean_excess_s_; }
    bool measured() const { return count_ > 0; }
    // Gaps that would have needed more than kMaxDelayS.
    std::uint64_t limited_count() const { return limited_count_; }

  private:
    struct Gap {
        double age_s = 0.0;
        double at_s = 0.0;
    };
    void review(double now_s);
    std::size_t held() const;

    std::array<Gap, kMaxGaps> gaps_{};
    std::size_t begin_ = 0, count_ = 0;  // ever left, ever observed
    double age_to_draw_s_ = 0.0;
    double mean_excess_s_ = 0.0;
    double since_s_ = 0.0, reviewed_s_ = 0.0;
    std::uint64_t limited_count_ = 0;
};

}  // namespace fts::client
