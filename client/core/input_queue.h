// InputQueue: inputs that the server has not yet acknowledged, in order. Each packet repeats them,
// so that a lost one costs nothing.
#pragma once

#include <cstdint>
#include <deque>

#include "common/game/input.h"
#include "common/replication/messages.h"

namespace fts::client {

class InputQueue {
  public:
    // The input of the next tick. Sequence numbers are 1, 2, 3, ... When kMaxInputsPerPacket are
    // already waiting the oldest is given up, and counted.
    void push(const game::InputCommand& input);
    // The server has applied everything up to `sequence`. One that was never sent is ignored.
    void acknowledge(std::uint32_t sequence);

    // All that are waiting.
    replication::InputPacket packet(replication::Tick acked_snapshot_tick) const;

    std::size_t waiting() const { return waiting_.size(); }
    std::uint64_t given_up_count() const { return given_up_count_; }

  private:
    std::deque<game::InputCommand> waiting_;
    std::uint32_t first_sequence_ = 1;  // of waiting_.front()
    std::uint64_t given_up_count_ = 0;
};

}  // namespace fts::client
