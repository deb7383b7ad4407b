// Durations counted in buckets that grow by 4.5 %: quantiles of a run of any length in fixed
// memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fts::server {

class DurationHistogram {
  public:
    void record(double duration_s);

    std::uint64_t count() const { return count_; }
    double max_s() const { return max_s_; }
    double mean_s() const { return count_ == 0 ? 0.0 : sum_s_ / static_cast<double>(count_); }
    // The duration that a share of `quantile` in [0, 1] does not exceed, to within a bucket; 0 when
    // empty.
    double quantile_s(double quantile) const;

  private:
    static constexpr int kBucketsPerOctave = 16;
    static constexpr double kSmallestS = 1e-6;
    static constexpr std::size_t kBuckets = 24 * kBucketsPerOctave;  // up to 16 s

    std::array<std::uint64_t, kBuckets> buckets_{};
    std::uint64_t count_ = 0;
    double sum_s_ = 0.0;
    double max_s_ = 0.0;
};

}  // namespace fts::server
