// InputPacer: says when inputs are due, one for each tick of the server, and holds them so that
// each arrives just before the tick that takes it. The server reports how long inputs waited there;
// the pacer sends a little faster or slower than once a tick until the least of those waits is
// kTargetSlackS. Nothing is skipped for that: an input is made later rather than thrown away.
//
// Times in seconds of any monotonic clock, passed in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace fts::client {

class InputPacer {
  public:
    // Faster or slower than the server's ticks by at most this share.
    static constexpr double kMaxPaceChange = 0.05;
    // A deviation would be gone after this long, at the pace it sets.
    static constexpr double kSettleS = 0.5;
    // What is to be left of the wait in the worst case seen.
    static constexpr double kTargetSlackS = 0.004;
    // How long a short wait is remembered.
    static constexpr double kWindowS = 2.0;
    // A stall longer than this is not made up for with stale inputs.
    static constexpr int kMaxCatchUpTicks = 15;

    struct Due {
        int inputs = 0;             // to be sent now
        std::uint64_t skipped = 0;  // ticks before those, which go without one
    };

    // The first input is due at `now_s`.
    void start(double now_s);
    // Those due count as sent; their sequence numbers are 1, 2, 3, ...
    Due due(double now_s, double tick_s);
    // The server says that an input waited `slack_s`, none less, up to when it applied `sequence`.
    // Reports that are older than the one before are passed over.
    void observe(std::uint32_t sequence, double slack_s, double now_s);

    // Of the inputs, [1 - kMaxPaceChange, 1 + kMaxPaceChange]; 1: that of the server's ticks.
    double pace(double now_s) const;

  private:
    struct Report {
        double slack_s = 0.0;  // as if nothing had been sent faster or slower
        double at_s = 0.0;
    };
    // More than are ever waiting for an answer.
    static constexpr std::size_t kSendsKept = 64;

    double next_s_ = 0.0;
    double lead_s_ = 0.0;  // sent earlier by this much than at the pace of ticks
    std::uint32_t sent_ = 0, reported_ = 0;
    std::array<double, kSendsKept> leads_s_{};  // by sequence
    std::deque<Report> least_;                  // ascending in both: the least slack first
};

}  // namespace fts::client
