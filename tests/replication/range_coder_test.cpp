// What goes in comes out, at the cost of its surprise, and never from beyond the end of the bytes.
#include "common/replication/range_coder.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/replication/residual_model.h"
#include "tests/replication/random_snapshots.h"

namespace fts::replication {
namespace {

using testing::chance;
using testing::pick;
using testing::Rng;
using Bytes = std::vector<std::uint8_t>;

Bytes coded_bits(const std::vector<bool>& bits) {
    RangeEncoder encoder;
    AdaptiveBit model;
    for (const bool bit : bits) encoder.bit(model, bit);
    return encoder.finish();
}

TEST(RangeCoder, GivesBackBitsOfEveryFrequency) {
    for (const int percent : {0, 1, 10, 50, 97, 100}) {
        Rng rng(static_cast<std::uint64_t>(percent) + 1);
        std::vector<bool> bits;
        for (int i = 0; i < 5000; ++i) bits.push_back(chance(rng, percent));
        const Bytes bytes = coded_bits(bits);
        RangeDecoder decoder(bytes);
        AdaptiveBit model;
        for (const bool bit : bits) ASSERT_EQ(decoder.bit(model), bit) << percent << " %";
        EXPECT_TRUE(decoder.complete()) << percent << " %";
    }
}

TEST(RangeCoder, SpendsLittleMoreThanTheEntropy) {
    Rng rng(3);
    std::vector<bool> bits;
    for (int i = 0; i < 20'000; ++i) bits.push_back(chance(rng, 5));
    const double p = 0.05;
    const double entropy_bytes = 20'000 * -(p * std::log2(p) + (1 - p) * std::log2(1 - p)) / 8;
    EXPECT_LT(static_cast<double>(coded_bits(bits).size()), 1.06 * entropy_bytes);
}

TEST(RangeCoder, GivesBackPlainAndEvenNumbersAmongAdaptiveBits) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        const auto code_all = [seed](auto& coder, std::vector<std::uint32_t>& values, bool told) {
            Rng rng(seed);
            AdaptiveBit model;
            for (std::size_t i = 0; i < 3000; ++i) {
                const auto width = static_cast<std::uint32_t>(pick(rng, 0, 16));
                const auto count = static_cast<std::uint32_t>(pick(rng, 1, 1 << 16));
                const auto wanted = static_cast<std::uint32_t>(rng() & 0xFFFFU);
                const std::uint32_t narrow = wanted & ((1U << width) - 1);
                values.push_back(coder.raw(told ? narrow : 0, width));
                values.push_back(coder.even(told ? wanted % count : 0, count));
                values.push_back(coder.bit(model, told && wanted % 50 == 0) ? 1 : 0);
            }
        };
        RangeEncoder encoder;
        std::vector<std::uint32_t> in, out;
        code_all(encoder, in, true);
        const Bytes bytes = encoder.finish();
        RangeDecoder decoder(bytes);
        code_all(decoder, out, false);
        EXPECT_EQ(in, out);
        EXPECT_TRUE(decoder.complete());
    }
}

// A low end of all ones that a last addition carries into every byte.
TEST(RangeCoder, CarriesThroughBytesAlreadyWritten) {
    for (std::uint32_t last = 0; last < 64; ++last) {
        RangeEncoder encoder;
        for (int i = 0; i < 40; ++i) encoder.even(0xFFFE, 0xFFFF);
        encoder.even(last, 64);
        const Bytes bytes = encoder.finish();
        RangeDecoder decoder(bytes);
        for (int i = 0; i < 40; ++i) ASSERT_EQ(decoder.even(0, 0xFFFF), 0xFFFEU);
        EXPECT_EQ(decoder.even(0, 64), last);
        EXPECT_TRUE(decoder.complete());
    }
}

TEST(RangeCoder, NoticesBytesThatAreMissingOrToSpare) {
    Rng rng(5);
    RangeEncoder encoder;
    for (int i = 0; i < 100; ++i) {
        encoder.raw(static_cast<std::uint32_t>(pick(rng, 1, 0xFFFF)), 16);
    }
    Bytes bytes = encoder.finish();
    const auto ends_well = [](const Bytes& read) {
        RangeDecoder decoder(read);
        for (int i = 0; i < 100; ++i) decoder.raw(0, 16);
        return decoder.complete();
    };
    EXPECT_TRUE(ends_well(bytes));
    Bytes longer = bytes;
    longer.resize(bytes.size() + range_coder::kStateBytes + 1);
    EXPECT_FALSE(ends_well(longer));
    bytes.resize(bytes.size() - 5);
    EXPECT_FALSE(ends_well(bytes));
}

TEST(NumberModel, GivesBackNumbersOfAnySizeWhateverWasExpected) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        const auto doubt = static_cast<Doubt>(pick(rng, 0, kDoubts - 1));
        std::vector<std::int32_t> numbers{0, 1, -1, INT32_MAX, INT32_MIN, INT32_MIN + 1};
        for (int i = 0; i < 2000; ++i) {
            const auto width = static_cast<int>(pick(rng, 0, 31));
            numbers.push_back(static_cast<std::int32_t>(static_cast<std::int32_t>(rng()) >> width));
        }
        RangeEncoder encoder;
        NumberModel model = NumberModel::of_spread(doubt);
        for (const std::int32_t number : numbers) code_number(encoder, model, number);
        const Bytes bytes = encoder.finish();
        RangeDecoder decoder(bytes);
        model = NumberModel::of_spread(doubt);
        for (const std::int32_t number : numbers) {
            ASSERT_EQ(code_number(decoder, model, 0), number);
        }
        EXPECT_TRUE(decoder.complete());
    }
}

TEST(NumberModel, CostsLessTheBetterItsSpreadFits) {
    const auto bytes_of = [](Doubt doubt) {
        Rng rng(11);
        RangeEncoder encoder;
        for (int i = 0; i < 60; ++i) {
            NumberModel model = NumberModel::of_spread(doubt);
            std::int64_t sum = 0;
            for (int k = 0; k < 12; ++k) sum += pick(rng, -4, 4);
            code_number(encoder, model, static_cast<std::int32_t>(sum));
        }
        return encoder.finish().size();
    };
    const Doubt fitting = doubt_of(12 * 60.0 / 9.0);
    EXPECT_LT(bytes_of(fitting), bytes_of(static_cast<Doubt>(fitting - 6)));
    EXPECT_LT(bytes_of(fitting), bytes_of(static_cast<Doubt>(fitting + 6)));
}

TEST(Doubt, IsTheClassOfItsOwnVariance) {
    for (Doubt doubt = 0; doubt < kDoubts; ++doubt) {
        EXPECT_EQ(doubt_of(variance_of(doubt)), doubt);
        EXPECT_EQ(doubt_of(1.9 * variance_of(doubt)), doubt);
    }
    EXPECT_EQ(doubt_of(0.0), 0);
    EXPECT_EQ(doubt_of(1e300), kDoubts - 1);
}

}  // namespace
}  // namespace fts::replication
