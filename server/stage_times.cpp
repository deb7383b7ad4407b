#include "server/stage_times.h"

namespace fts::server {

void StageTimes::enter(Stage stage) {
    if (!clock_) return;
    const double now_s = clock_();
    if (current_ != kNone) sums_s_[current_] += now_s - entered_s_;
    current_ = static_cast<std::size_t>(stage);
    entered_s_ = now_s;
}

void StageTimes::leave() {
    if (current_ == kNone) return;
    sums_s_[current_] += clock_() - entered_s_;
    current_ = kNone;
}

void StageTimes::end_tick() {
    if (!clock_) return;
    leave();
    for (std::size_t i = 0; i < sums_s_.size(); ++i) histograms_[i].record(sums_s_[i]);
    sums_s_ = {};
}

}  // namespace fts::server
