#include "client/core/interpolation_delay.h"

#include <algorithm>
#include <limits>

namespace fts::client {
namespace {

// Share that one gap has in the mean: a memory of about two seconds at 60 Hz.
constexpr double kMeanShare = 1.0 / 128.0;

}  // namespace

std::size_t InterpolationDelay::held() const {
    return count_ - begin_;
}

void InterpolationDelay::observe(double age_s, double flight_s, double now_s) {
    const double longest_s = flight_s + kMaxDelayS;
    const double counted_s = std::min(age_s, longest_s);
    if (age_s > longest_s) {
        ++limited_count_;
        if (measured()) return;
    }
    if (!measured()) {
        since_s_ = now_s;
        mean_excess_s_ = counted_s - flight_s;
    }
    mean_excess_s_ += (counted_s - flight_s - mean_excess_s_) * kMeanShare;
    gaps_[count_ % kMaxGaps] = {counted_s, now_s};
    ++count_;
    if (held() > kMaxGaps) ++begin_;
    while (gaps_[begin_ % kMaxGaps].at_s < now_s - kDelayWindowS) ++begin_;
    if (counted_s > age_to_draw_s_ || count_ == 1 || now_s >= reviewed_s_ + kReviewS) {
        review(now_s);
    }
}

// The least age D for which sum(max(0, age - D)) over the gaps, which is the time that would have
// gone without a newer snapshot, is the share that is allowed. The sum is convex and falls with D,
// so Newton's steps from below never overshoot.
void InterpolationDelay::review(double now_s) {
    reviewed_s_ = now_s;
    const double span_s = std::min(now_s - since_s_, kDelayWindowS);
    const double allowed_s = span_s * kDelayStarvedShare;
    double worst_s = -std::numeric_limits<double>::infinity(), second_s = worst_s;
    for (std::size_t i = begin_; i != count_; ++i) {
        const double age_s = gaps_[i % kMaxGaps].age_s;
        second_s = std::max(second_s, std::min(worst_s, age_s));
        worst_s = std::max(worst_s, age_s);
    }
    const bool spare_worst = span_s >= kDelayWindowS && held() > kDelayHiccups;
    double draw_s = (spare_worst ? second_s : worst_s) - allowed_s;
    for (;;) {
        double sum_s = spare_worst ? -worst_s : 0.0;
        double longer = spare_worst ? -1.0 : 0.0;
        for (std::size_t i = begin_; i != count_; ++i) {
            const double age_s = gaps_[i % kMaxGaps].age_s;
            if (age_s <= draw_s) continue;
            sum_s += age_s;
            longer += 1.0;
        }
        const double next_s = longer > 0.0 ? (sum_s - allowed_s) / longer : draw_s;
        if (!(next_s > draw_s + 1e-6)) break;
        draw_s = next_s;
    }
    age_to_draw_s_ = draw_s + kDelayMarginS;
}

}  // namespace fts::client
