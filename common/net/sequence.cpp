#include "common/net/sequence.h"

#include <algorithm>

namespace fts::net {

std::uint64_t nearest_with_low_bits(std::uint32_t low, std::uint64_t reference) {
    constexpr std::uint64_t kPeriod = std::uint64_t{1} << 32;
    const std::uint32_t ahead = low - static_cast<std::uint32_t>(reference);
    const std::uint64_t candidate = reference + ahead;
    return ahead >= kPeriod / 2 && candidate >= kPeriod ? candidate - kPeriod : candidate;
}

bool ReplayWindow::is_fresh(std::uint64_t number) const {
    if (number == 0) return false;
    if (number > newest_) return true;
    if (newest_ - number >= kReplayWindowPackets) return false;
    return !seen_[number % kReplayWindowPackets];
}

void ReplayWindow::mark(std::uint64_t number) {
    if (number > newest_) {
        const std::uint64_t skipped =
            std::min<std::uint64_t>(number - newest_ - 1, kReplayWindowPackets);
        for (std::uint64_t i = 1; i <= skipped; ++i) {
            seen_[(number - i) % kReplayWindowPackets] = false;
        }
        newest_ = number;
    }
    seen_[number % kReplayWindowPackets] = true;
}

std::uint64_t ReplayWindow::seen_before_newest() const {
    std::uint64_t bits = 0;
    for (std::uint64_t i = 0; i < kAckBits && i + 1 < newest_; ++i) {
        if (seen_[(newest_ - 1 - i) % kReplayWindowPackets]) bits |= std::uint64_t{1} << i;
    }
    return bits;
}

}  // namespace fts::net
