#include "common/replication/hit_log.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace fts::replication {

HitState hit_of(const physics::Contact<double>& contact, Tick tick, std::uint16_t a,
                std::uint16_t b) {
    constexpr double kGreatest = std::numeric_limits<std::uint32_t>::max();
    const double impulse = std::round(contact.impulse_ns / kImpulseStepNs);
    return {.tick = tick,
            .a = std::min(a, b),
            .b = std::max(a, b),
            .x = quantise(contact.point_m.x(), kPositionStepM),
            .y = quantise(contact.point_m.y(), kPositionStepM),
            .impulse = static_cast<std::uint32_t>(std::clamp(impulse, 0.0, kGreatest))};
}

void HitLog::add(const HitState& hit) {
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

std::vector<HitState> HitLog::sorted() const {
    auto result = hits_;
    std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
        return std::tie(a.tick, a.a, a.b) < std::tie(b.tick, b.a, b.b);
    });
    return result;
}

}  // namespace fts::replication
