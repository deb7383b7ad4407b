// Hands out 16-bit ids from 1 up, round and round. An id is never in use twice at once, and one
// that was given back stays unused for a time, so that a late packet cannot confuse two owners.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <utility>

namespace fts::server {

class IdPool {
  public:
    explicit IdPool(std::uint32_t rest_ticks) : rest_ticks_(rest_ticks) {}

    // Empty when every id is in use.
    std::optional<std::uint16_t> take(std::uint32_t now) {
        while (!resting_.empty() && now - resting_.front().second > rest_ticks_) {
            unavailable_.erase(resting_.front().first);
            resting_.pop_front();
        }
        // Rather an id that has not rested long enough than none.
        if (unavailable_.size() == kIdCount && !resting_.empty()) {
            unavailable_.erase(resting_.front().first);
            resting_.pop_front();
        }
        if (unavailable_.size() == kIdCount) return std::nullopt;
        do {
            last_ = last_ == kIdCount ? std::uint16_t{1} : static_cast<std::uint16_t>(last_ + 1);
        } while (unavailable_.contains(last_));
        unavailable_.insert(last_);
        return last_;
    }

    void give_back(std::uint16_t id, std::uint32_t now) { resting_.emplace_back(id, now); }

  private:
    static constexpr std::uint16_t kIdCount = 65535;

    std::uint32_t rest_ticks_;
    std::uint16_t last_ = 0;
    std::set<std::uint16_t> unavailable_;
    std::deque<std::pair<std::uint16_t, std::uint32_t>> resting_;
};

}  // namespace fts::server
