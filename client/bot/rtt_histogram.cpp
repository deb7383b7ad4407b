#include "client/bot/rtt_histogram.h"

#include <algorithm>
#include <cmath>

namespace fts::bot {

void RttHistogram::add(double rtt_s) {
    const double bucket = std::clamp(rtt_s / kBucketS, 0.0, double(kBuckets - 1));
    ++counts_[static_cast<std::size_t>(bucket)];
    ++count_;
    sum_s_ += rtt_s;
}

void RttHistogram::add(const RttHistogram& other) {
    for (std::size_t i = 0; i < kBuckets; ++i) counts_[i] += other.counts_[i];
    count_ += other.count_;
    sum_s_ += other.sum_s_;
}

double RttHistogram::mean_s() const {
    return count_ == 0 ? 0.0 : sum_s_ / static_cast<double>(count_);
}

double RttHistogram::quantile_s(double share) const {
    if (count_ == 0) return 0.0;
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
        seen += counts_[i];
        if (seen >= wanted) return static_cast<double>(i + 1) * kBucketS;
    }
    return static_cast<double>(kBuckets) * kBucketS;
}

}  // namespace fts::bot
