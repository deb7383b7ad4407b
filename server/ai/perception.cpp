#include "server/ai/perception.h"

#include <algorithm>
#include <utility>

namespace fts::server::ai {

void Memory::remember(Frame frame) {
    if (frames_.size() == kFrames) frames_.pop_back();
    frames_.push_front(std::move(frame));
}

const Frame* Memory::as_of(int ticks_ago) const {
    if (frames_.empty()) return nullptr;
    return &frames_[std::min(static_cast<std::size_t>(ticks_ago), frames_.size() - 1)];
}

}  // namespace fts::server::ai
