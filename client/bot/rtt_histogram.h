// RttHistogram: how round-trip times were spread, in a fixed amount of memory however long a run
// is.
#pragma once

#include <array>
#include <cstdint>

namespace fts::bot {

class RttHistogram {
  public:
    static constexpr double kBucketS = 0.00025;
    // Longer ones count as this long.
    static constexpr std::size_t kBuckets = 8192;

    void add(double rtt_s);
    void add(const RttHistogram& other);

    std::uint64_t count() const { return count_; }
    // 0 without samples.
    double mean_s() const;
    // The time that `share` of the samples do not exceed, to a bucket; `share` in [0, 1].
    double quantile_s(double share) const;

  private:
    std::array<std::uint32_t, kBuckets> counts_{};
    std::uint64_t count_ = 0;
    double sum_s_ = 0.0;
};

}  // namespace fts::bot
