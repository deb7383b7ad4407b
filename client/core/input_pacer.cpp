#include "client/core/input_pacer.h"

#include <algorithm>
#include <cmath>

namespace fts::client {

void InputPacer::start(double now_s) {
    next_s_ = now_s;
}

InputPacer::Due InputPacer::due(double now_s, double tick_s) {
    if (now_s < next_s_) return {};
    const double interval_s = tick_s / pace(now_s);
    const double ticks = std::floor((now_s - next_s_) / interval_s) + 1.0;
    next_s_ += ticks * interval_s;
    lead_s_ += ticks * (tick_s - interval_s);
    const double inputs = std::min(ticks, double(kMaxCatchUpTicks));
    for (int i = 0; i < static_cast<int>(inputs); ++i) leads_s_[++sent_ % kSendsKept] = lead_s_;
    return {static_cast<int>(inputs), static_cast<std::uint64_t>(ticks - inputs)};
}

// What was sent earlier waits longer. Free of that, old reports and new ones can be compared, and
// the pace answers at once to what it has brought about but not yet heard of.
void InputPacer::observe(std::uint32_t sequence, double slack_s, double now_s) {
    if (sequence <= reported_ || sequence > sent_) return;
    reported_ = sequence;
    const double free_slack_s = slack_s - leads_s_[sequence % kSendsKept];
    while (!least_.empty() && least_.back().slack_s >= free_slack_s) least_.pop_back();
    least_.push_back({free_slack_s, now_s});
    while (least_.front().at_s < now_s - kWindowS) least_.pop_front();
}

double InputPacer::pace(double now_s) const {
    if (least_.empty() || least_.back().at_s < now_s - kWindowS) return 1.0;
    const double missing_s = kTargetSlackS - (least_.front().slack_s + lead_s_);
    return 1.0 + std::clamp(missing_s / kSettleS, -kMaxPaceChange, kMaxPaceChange);
}

}  // namespace fts::client
