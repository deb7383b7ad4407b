#include "common/physics/hit_order.h"

#include <algorithm>
#include <bit>
#include <span>

namespace fts::physics {
namespace {

bool comes_before(const SlotPair& one, const SlotPair& other) {
    return one.slot_a != other.slot_a ? one.slot_a < other.slot_a : one.slot_b < other.slot_b;
}

bool same_slots(const SlotPair& one, const SlotPair& other) {
    return one.slot_a == other.slot_a && one.slot_b == other.slot_b;
}

// So few are sorted by moving each to its place.
constexpr std::ptrdiff_t kFew = 16;

void sort_few(std::span<SlotPair> pairs) {
    for (std::size_t k = 1; k < pairs.size(); ++k) {
        const SlotPair pair = pairs[k];
        std::size_t to = k;
        for (; to > 0 && comes_before(pair, pairs[to - 1]); --to) pairs[to] = pairs[to - 1];
        pairs[to] = pair;
    }
}

// For what is in the order of slot_a; most of its groups are small, but one body may touch many.
void sort_groups(std::vector<SlotPair>& pairs) {
    for (auto first = pairs.begin(); first != pairs.end();) {
        const auto end = std::find_if(
            first, pairs.end(), [&](const SlotPair& pair) { return pair.slot_a != first->slot_a; });
        end - first <= kFew ? sort_few({first, end}) : std::sort(first, end, comes_before);
        first = end;
    }
}

}  // namespace

// Two passes over the halves of slot_a's bits; where pairs are fewer than the digits have values,
// comparing them is faster.
void HitOrder::sort(std::vector<SlotPair>& pairs, std::uint32_t slots) {
    digit_bits_ = static_cast<unsigned>(std::bit_width(slots) + 1) / 2;
    if (pairs.size() < (std::size_t{1} << digit_bits_) / 2) {
        std::sort(pairs.begin(), pairs.end(), comes_before);
    } else {
        scatter(pairs, half_sorted_, 0);
        scatter(half_sorted_, pairs, digit_bits_);
        sort_groups(pairs);
    }
    pairs.erase(std::unique(pairs.begin(), pairs.end(), same_slots), pairs.end());
}

void HitOrder::scatter(const std::vector<SlotPair>& from, std::vector<SlotPair>& to,
                       unsigned shift) {
    const std::uint32_t mask = (1U << digit_bits_) - 1U;
    begins_.assign(std::size_t{mask} + 1, 0);
    for (const SlotPair& pair : from) ++begins_[pair.slot_a >> shift & mask];
    std::uint32_t total = 0;
    for (std::uint32_t& begin : begins_) {
        const std::uint32_t count = begin;
        begin = total;
        total += count;
    }
    to.resize(from.size());
    for (const SlotPair& pair : from) to[begins_[pair.slot_a >> shift & mask]++] = pair;
}

}  // namespace fts::physics
