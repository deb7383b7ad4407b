#include "server/input_queue.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "server/limits.h"

namespace fts::server {

bool InputQueue::add(const replication::InputPacket& packet, double ticks_ahead) {
    if (packet.inputs.empty()) return true;
    const std::uint64_t last = std::uint64_t{packet.first_sequence} + packet.inputs.size() - 1;
    const std::uint64_t furthest = std::uint64_t{newest_sequence_} + kMaxInputLead;
    if (packet.first_sequence == 0 || last > furthest ||
        last > std::numeric_limits<std::uint32_t>::max()) {
        return false;
    }
    std::uint32_t sequence = packet.first_sequence;
    for (const game::InputCommand& command : packet.inputs) {
        if (sequence > newest_sequence_) {
            queue_.push_back({sequence, command, static_cast<double>(ticks_ + 1) - ticks_ahead});
            newest_sequence_ = sequence;
        }
        ++sequence;
    }
    while (queue_.size() > kMaxQueuedInputs) {
        queue_.pop_front();
        ++left_out_;
    }
    return true;
}

game::InputCommand InputQueue::next() {
    ++ticks_;
    least_waiting_ = std::min(least_waiting_, queue_.size());
    if (queue_.empty()) {
        ran_dry_ = true;
        if (++silent_ticks_ > kInputSilenceTicks) current_ = {};
    } else {
        take();
    }
    if (++window_ticks_ >= kInputSlackWindowTicks) shorten_slack();
    return current_;
}

void InputQueue::take() {
    silent_ticks_ = 0;
    const double waited_ticks = static_cast<double>(ticks_) - queue_.front().added_tick;
    least_slack_ticks_ = std::min(least_slack_ticks_.value_or(waited_ticks), waited_ticks);
    applied_sequence_ = queue_.front().sequence;
    current_ = queue_.front().command;
    queue_.pop_front();
}

std::uint8_t InputQueue::take_slack() {
    const std::optional<double> least_ticks = std::exchange(least_slack_ticks_, std::nullopt);
    if (std::exchange(ran_dry_, false) || !least_ticks) return replication::kNoInputWaited;
    const double steps = std::floor(*least_ticks / replication::kInputSlackStepTicks);
    return static_cast<std::uint8_t>(std::clamp(steps, 0.0, double(replication::kMaxInputSlack)));
}

void InputQueue::shorten_slack() {
    if (least_waiting_ > 1 && !queue_.empty()) {
        queue_.pop_front();
        ++left_out_;
    }
    window_ticks_ = 0;
    least_waiting_ = kNoneSeen;
}

}  // namespace fts::server
