// Messages that arrive each exactly once and in order, over packets that may not. A message is cut
// into fragments, all messages' fragments are numbered 0, 1, 2, ..., and each is sent until it is
// known to have arrived. Time is passed in; knows no packet.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/net/bytes.h"
#include "common/net/connection.h"

namespace fts::net {

inline constexpr std::size_t kFragmentBytes = 1024;
// Fragments under way at once; what the receiver must be ready to hold.
inline constexpr std::size_t kFragmentWindow = 64;
// What may wait to be sent or acknowledged.
inline constexpr std::size_t kMaxQueuedBytes = 4 * kMaxMessageBytes;
inline constexpr std::size_t kMaxQueuedFragments = 1024;
// The most that reliable messages take of the link, and how much of it at a stroke.
inline constexpr double kReliableBytesPerS = 256.0 * 1024.0;
inline constexpr double kReliableBurstBytes = 32.0 * 1024.0;
static_assert(kMaxQueuedBytes / kFragmentBytes <= kMaxQueuedFragments);
static_assert(kFragmentWindow * kFragmentBytes >= kMaxMessageBytes);

struct Fragment {
    std::uint64_t number = 0;
    bool ends_message = false;
    std::vector<std::uint8_t> bytes;  // exactly kFragmentBytes, but for the last of a message
};

class ReliableSender {
  public:
    // False when the message is too large or the queue is full.
    bool queue(Bytes message);
    // Earns the right to send as time passes. `resend_after_s` is what the link asks for.
    void update(double now_s, double resend_after_s);
    // The next fragment that should be sent now and has at most `room` bytes; null when there is
    // none.
    const Fragment* due(double now_s, std::size_t room);
    // Notes that what `due` returned has been sent.
    void mark_sent(std::uint64_t number, double now_s);
    void acknowledge(std::uint64_t number);
    std::size_t queued_bytes() const { return queued_bytes_; }

  private:
    struct Queued {
        Fragment fragment;
        bool acknowledged = false;
        int times_sent = 0;
        double sent_at_s = 0.0;
    };
    bool is_overdue(const Queued& queued, double now_s) const;
    void slow_down(double now_s);

    std::deque<Queued> queue_;
    std::uint64_t first_ = 0;  // number of queue_.front()
    std::uint64_t next_ = 0;
    std::size_t queued_bytes_ = 0;
    std::size_t under_way_ = 0;
    double window_ = 32.0;  // fragments; grows with what arrives, halves with what does not
    double slowed_at_s_ = -1.0;
    double resend_after_s_ = 0.25;
    double allowance_bytes_ = kReliableBurstBytes;
    std::optional<double> updated_at_s_;
};

class ReliableReceiver {
  public:
    // Takes a fragment in any order, any number of times, and appends the messages that are now
    // whole. False when no honest sender could have sent it.
    bool accept(std::uint64_t number, bool ends_message, Bytes bytes,
                std::vector<std::vector<std::uint8_t>>& messages);
    // The number of the fragment that is waited for.
    std::uint64_t next_number() const { return next_; }

  private:
    std::array<std::optional<Fragment>, kFragmentWindow> waiting_;
    std::uint64_t next_ = 0;
    std::vector<std::uint8_t> message_;
};

}  // namespace fts::net
