// Bits out and bits in, each at the cost of its surprise: a binary range coder (Martin, "Range
// encoding", 1979; the carry is taken back into bytes already written) and the bit that learns how
// often it is set.
//
// Both ends call the same functions in the same order. `bit` and `raw` give back what they coded,
// so that one function can be written for both: an encoder is told the value, a decoder passes
// anything. Whole numbers throughout: every machine makes the same bytes.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace fts::replication {

// Beyond these a certainty would cost nothing, and its opposite could not be said.
inline constexpr std::uint32_t kLeastChance = 32;  // of 65536

// How likely a bit is to be set, from a prior and from what came: the mean of both, until as many
// have come as kMemory; from then on older ones fade.
class AdaptiveBit {
  public:
    static constexpr std::uint32_t kMemory = 160;

    constexpr AdaptiveBit() = default;
    // `chance` of 65536; the prior weighs as much as `weight` bits seen, less than kMemory.
    constexpr AdaptiveBit(std::uint32_t chance, std::uint32_t weight)
        : chance_(static_cast<std::uint16_t>(clamped(chance))),
          seen_(static_cast<std::uint8_t>(weight)) {}

    std::uint32_t chance() const { return chance_; }
    void learn(bool set) {
        const std::uint32_t target = set ? 0x10000U - kLeastChance : kLeastChance;
        const auto difference = static_cast<std::int32_t>(target - chance_);
        const std::int32_t step = difference * kRates[seen_] / 0x8000;
        chance_ = static_cast<std::uint16_t>(chance_ + step);
        seen_ = static_cast<std::uint8_t>(seen_ + (seen_ < kMemory ? 1 : 0));
    }

  private:
    static constexpr std::uint32_t clamped(std::uint32_t chance) {
        return chance < kLeastChance              ? kLeastChance
               : chance > 0x10000U - kLeastChance ? 0x10000U - kLeastChance
                                                  : chance;
    }
    // 1 / (n + 1.5), of 32768.
    static constexpr std::array<std::int32_t, kMemory + 1> kRates = [] {
        std::array<std::int32_t, kMemory + 1> rates{};
        for (std::uint32_t n = 0; n <= kMemory; ++n) {
            rates[n] = static_cast<std::int32_t>(0x10000U / (2 * n + 3));
        }
        return rates;
    }();

    std::uint16_t chance_ = 0x8000;
    std::uint8_t seen_ = 0;
};

namespace range_coder {
inline constexpr std::uint32_t kLeastRange = 1U << 24;
inline constexpr std::size_t kStateBytes = 4;
inline constexpr std::uint32_t kMaxRawBits = 16;  // at once
}  // namespace range_coder

class RangeEncoder {
  public:
    bool bit(AdaptiveBit& model, bool set) {
        const std::uint32_t part = (range_ >> 16) * model.chance();
        model.learn(set);
        if (set) {
            range_ = part;
        } else {
            low_ += part;
            range_ -= part;
        }
        settle();
        return set;
    }
    // `count` bits that nothing is known of.
    std::uint32_t raw(std::uint32_t value, std::uint32_t count) {
        assert(count <= range_coder::kMaxRawBits && value >> count == 0);
        range_ >>= count;
        low_ += std::uint64_t{range_} * value;
        settle();
        return value;
    }

    // One of `count` values, all as likely; 1 to 65536 of them.
    std::uint32_t even(std::uint32_t value, std::uint32_t count) {
        assert(value < count && count <= 1U << range_coder::kMaxRawBits);
        range_ /= count;
        low_ += std::uint64_t{range_} * value;
        settle();
        return value;
    }

    // No more than so many bytes if it were finished now.
    std::size_t size_limit() const { return bytes_.size() + range_coder::kStateBytes; }

    // The fewest bytes that lead a decoder, which reads zeros behind them, to the same bits.
    std::vector<std::uint8_t> finish() {
        for (std::uint32_t spared = 32;; spared -= 8) {
            const std::uint64_t unit = std::uint64_t{1} << spared;
            const std::uint64_t value = (low_ + unit - 1) & ~(unit - 1);
            if (value >= low_ + range_) continue;
            low_ = value;
            if (low_ >> 32 != 0) carry();
            for (std::uint32_t left = 32; left > spared; left -= 8) push();
            return std::exchange(bytes_, {});
        }
    }

  private:
    void settle() {
        if (low_ >> 32 != 0) carry();
        while (range_ < range_coder::kLeastRange) {
            push();
            range_ <<= 8;
        }
    }
    void push() {
        bytes_.push_back(static_cast<std::uint8_t>(low_ >> 24));
        low_ = (low_ & 0xFFFFFFU) << 8;
    }
    void carry() {
        low_ &= 0xFFFFFFFFU;
        for (std::size_t i = bytes_.size(); i > 0 && ++bytes_[i - 1] == 0; --i) {
        }
    }

    std::uint64_t low_ = 0;
    std::uint32_t range_ = 0xFFFFFFFFU;
    std::vector<std::uint8_t> bytes_;
};

// Any bytes are bits of some meaning; what they are must be judged by who reads them. Never reads
// past the end: it sees zeros there, and `complete` tells.
class RangeDecoder {
  public:
    explicit RangeDecoder(std::span<const std::uint8_t> bytes) : rest_(bytes) {
        for (std::size_t i = 0; i < range_coder::kStateBytes; ++i) pull();
    }

    bool bit(AdaptiveBit& model, bool = false) {
        const std::uint32_t part = (range_ >> 16) * model.chance();
        const bool set = code_ < part;
        model.learn(set);
        if (set) {
            range_ = part;
        } else {
            code_ -= part;
            range_ -= part;
        }
        settle();
        return set;
    }
    std::uint32_t raw(std::uint32_t, std::uint32_t count) {
        range_ >>= count;
        const std::uint32_t value = code_ / range_;
        const std::uint32_t mask = (1U << count) - 1;
        code_ -= (value & mask) * range_;
        settle();
        return value & mask;
    }

    std::uint32_t even(std::uint32_t, std::uint32_t count) {
        range_ /= count;
        const std::uint32_t found = code_ / range_;
        const std::uint32_t value = found < count ? found : count - 1;
        code_ -= value * range_;
        settle();
        return value;
    }

    // Nothing that an encoder wrote makes a decoder read so far.
    bool ran_out() const { return beyond_ > range_coder::kStateBytes; }
    // Whether the bytes were read to their end and no further. Up to kStateBytes at the end may
    // still be others than were written, where they change nothing.
    bool complete() const { return rest_.empty() && !ran_out(); }

  private:
    void settle() {
        while (range_ < range_coder::kLeastRange) {
            pull();
            range_ <<= 8;
        }
    }
    void pull() {
        std::uint8_t byte = 0;
        if (rest_.empty()) {
            ++beyond_;
        } else {
            byte = rest_.front();
            rest_ = rest_.subspan(1);
        }
        code_ = code_ << 8 | byte;
    }

    std::span<const std::uint8_t> rest_;
    std::uint32_t code_ = 0;
    std::uint32_t range_ = 0xFFFFFFFFU;
    std::size_t beyond_ = 0;
};

}  // namespace fts::replication
