// The inputs of one client between the network and the match: each applied once, in order, one a
// tick.
//
// Never more than kMaxQueuedInputs wait. When a burst brings more, the oldest are left out, and
// when the queue has had slack for a whole kInputSlackWindowTicks one is skipped: a player is
// better served by a fresh input than by a complete record of stale ones. What was left out is
// counted. A client that minds what it is told of its slack (`take_slack`) does not get that far.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/game/input.h"
#include "common/replication/messages.h"

namespace fts::server {

class InputQueue {
  public:
    // False, and nothing is taken, when the sequences are not ones a client can have come to.
    // Inputs that were seen before are passed over. The next tick takes place `ticks_ahead` from
    // now, [0, 1] ticks.
    bool add(const replication::InputPacket& packet, double ticks_ahead = 0.0);

    // What acts in the coming tick: the oldest that waits, else the last one again, and after
    // kInputSilenceTicks without any, hands off the controls.
    game::InputCommand next();

    // How early inputs have come since the last call, as a SnapshotPacket says it.
    std::uint8_t take_slack();

    std::uint32_t applied_sequence() const { return applied_sequence_; }  // 0: none yet
    std::size_t size() const { return queue_.size(); }
    std::uint64_t left_out() const { return left_out_; }

  private:
    struct Entry {
        std::uint32_t sequence = 0;
        game::InputCommand command;
        double added_tick = 0.0;  // with its fraction, counted from the first tick of this queue
    };
    void take();
    void shorten_slack();

    std::deque<Entry> queue_;
    std::uint32_t newest_sequence_ = 0;
    std::uint32_t applied_sequence_ = 0;
    game::InputCommand current_;
    std::uint64_t ticks_ = 0;
    std::optional<double> least_slack_ticks_;  // since it was last taken
    bool ran_dry_ = false;                     // since then
    int silent_ticks_ = 0;
    int window_ticks_ = 0;
    std::size_t least_waiting_ = kNoneSeen;
    std::uint64_t left_out_ = 0;

    static constexpr std::size_t kNoneSeen = SIZE_MAX;
};

}  // namespace fts::server
