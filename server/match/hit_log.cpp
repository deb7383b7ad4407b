#include "server/match/hit_log.h"

#include <algorithm>
#include <tuple>

namespace fts::server {

void HitLog::add(const replication::HitState& hit) {
    const auto same = std::find_if(hits_.begin(), hits_.end(), [&](const auto& other) {
        return std::tie(other.tick, other.a, other.b) == std::tie(hit.tick, hit.a, hit.b);
    });
    if (same != hits_.end()) {
        if (hit.impulse > same->impulse) *same = hit;
        return;
    }
    if (hits_.size() < kMaxHits) {
        hits_.push_back(hit);
        return;
    }
    ++left_out_;
    const auto weakest =
        std::min_element(hits_.begin(), hits_.end(),
                         [](const auto& a, const auto& b) { return a.impulse < b.impulse; });
    if (hit.impulse > weakest->impulse) *weakest = hit;
}

std::vector<replication::HitState> HitLog::sorted() const {
    auto result = hits_;
    std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
        return std::tie(a.tick, a.a, a.b) < std::tie(b.tick, b.a, b.b);
    });
    return result;
}

}  // namespace fts::server
