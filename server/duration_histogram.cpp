#include "server/duration_histogram.h"

#include <algorithm>
#include <cmath>

namespace fts::server {

void DurationHistogram::record(double duration_s) {
    std::size_t bucket = 0;
    if (duration_s > kSmallestS) {
        const double octaves = std::log2(duration_s / kSmallestS);
        bucket = static_cast<std::size_t>(std::ceil(octaves * kBucketsPerOctave));
    }
    ++buckets_[std::min(bucket, kBuckets - 1)];
    ++count_;
    sum_s_ += duration_s;
    max_s_ = std::max(max_s_, duration_s);
}

double DurationHistogram::quantile_s(double quantile) const {
    if (count_ == 0) return 0.0;
    const double wanted = std::clamp(quantile, 0.0, 1.0) * static_cast<double>(count_);
    std::uint64_t seen = 0;
    for (std::size_t bucket = 0; bucket + 1 < kBuckets; ++bucket) {
        seen += buckets_[bucket];
        if (seen > 0 && static_cast<double>(seen) >= wanted) {
            const double top_s =
                kSmallestS * std::exp2(static_cast<double>(bucket) / kBucketsPerOctave);
            return std::min(top_s, max_s_);
        }
    }
    return max_s_;
}

}  // namespace fts::server
