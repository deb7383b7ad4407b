// What became of the packets that we sent: acknowledged or lost, and what that says about the link.
// Also hands out their numbers, each once.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "common/net/bytes.h"

namespace fts::net {

// More than this many unresolved packets, and the oldest counts as lost.
inline constexpr std::size_t kMaxUnresolvedPackets = 2048;

struct Acknowledgement {
    std::uint64_t newest = 0;         // 0: nothing has arrived yet
    std::uint64_t before_newest = 0;  // bit i: newest - 1 - i has arrived
    double delay_s = 0.0;             // between the arrival of the newest and this answer
};

class SentPackets {
  public:
    // The number of the next packet; the first is 1, so that 0 may mean none.
    std::uint64_t next_number() const { return first_ + sent_.size(); }
    // Notes that it was sent, and which fragments of reliable messages it carried.
    void record(double now_s, std::vector<std::uint64_t> fragments);
    // Appends the fragments that are now known to have arrived. False when it speaks of packets
    // never sent, which an honest peer cannot.
    bool acknowledge(const Acknowledgement& ack, double now_s,
                     std::vector<std::uint64_t>& fragments);
    // Gives up on what can no longer be acknowledged.
    void update(double now_s);

    std::uint64_t newest_acknowledged() const { return newest_acknowledged_; }
    // Smoothed as in RFC 6298; 0 until measured.
    double rtt_s() const { return rtt_s_; }
    double rtt_jitter_s() const { return rtt_jitter_s_; }
    // Share of recent packets that were never acknowledged, [0, 1].
    double loss() const { return loss_; }
    // How long to wait for an acknowledgement before sending a fragment again.
    double resend_after_s() const;

  private:
    struct Sent {
        double at_s = 0.0;
        bool acknowledged = false;
        std::vector<std::uint64_t> fragments;
    };
    void measure(double sample_s);
    void resolve(bool lost);

    std::deque<Sent> sent_;
    std::uint64_t first_ = 1;  // number of sent_.front()
    std::uint64_t newest_acknowledged_ = 0;
    double rtt_s_ = 0.0;
    double rtt_jitter_s_ = 0.0;
    double loss_ = 0.0;
    std::uint64_t resolved_ = 0;
};

}  // namespace fts::net
