#include "client/core/input_queue.h"

namespace fts::client {

void InputQueue::push(const game::InputCommand& input) {
    if (waiting_.size() == replication::kMaxInputsPerPacket) {
        waiting_.pop_front();
        ++first_sequence_;
        ++given_up_count_;
    }
    waiting_.push_back(input);
}

void InputQueue::acknowledge(std::uint32_t sequence) {
    if (sequence >= first_sequence_ + waiting_.size()) return;
    while (first_sequence_ <= sequence) {
        waiting_.pop_front();
        ++first_sequence_;
    }
}

replication::InputPacket InputQueue::packet(replication::Tick acked_snapshot_tick) const {
    return {acked_snapshot_tick, first_sequence_, {waiting_.begin(), waiting_.end()}};
}

}  // namespace fts::client
