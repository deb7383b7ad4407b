#include "common/physics/hit_order.h"

#include <algorithm>
#include <bit>
#include <span>

namespace fts::physics {
namespace {

bool comes_before(const BodyPair& one, const BodyPair& other) {
    return one.a.index != other.a.index ? one.a.index < other.a.index : one.b.index < other.b.index;
}

bool same_slots(const BodyPair& one, const BodyPair& other) {
    return one.a.index == other.a.index && one.b.index == other.b.index;
}

// So few are sorted by moving each to its place.
constexpr std::ptrdiff_t kFew = 16;

void sort_few(std::span<BodyPair> hits) {
    for (std::size_t k = 1; k < hits.size(); ++k) {
        const BodyPair hit = hits[k];
        std::size_t to = k;
        for (; to > 0 && comes_before(hit, hits[to - 1]); --to) hits[to] = hits[to - 1];
        hits[to] = hit;
    }
}

// For what is in the order of a's slots; most of its groups are small, but one body may touch many.
void sort_groups(std::vector<BodyPair>& hits) {
    for (auto first = hits.begin(); first != hits.end();) {
        const auto end = std::find_if(
            first, hits.end(), [&](const BodyPair& hit) { return hit.a.index != first->a.index; });
        end - first <= kFew ? sort_few({first, end}) : std::sort(first, end, comes_before);
        first = end;
    }
}

}  // namespace

// Two passes over the halves of the bits of a's slot; where hits are fewer than digits have values,
// comparing them is faster.
void HitOrder::sort(std::vector<BodyPair>& hits, std::uint32_t slots) {
    digit_bits_ = static_cast<unsigned>(std::bit_width(slots) + 1) / 2;
    if (hits.size() < (std::size_t{1} << digit_bits_) / 2) {
        std::sort(hits.begin(), hits.end(), comes_before);
    } else {
        scatter(hits, half_sorted_, 0);
        scatter(half_sorted_, hits, digit_bits_);
        sort_groups(hits);
    }
    hits.erase(std::unique(hits.begin(), hits.end(), same_slots), hits.end());
}

void HitOrder::scatter(const std::vector<BodyPair>& from, std::vector<BodyPair>& to,
                       unsigned shift) {
    const std::uint32_t mask = (1U << digit_bits_) - 1U;
    begins_.assign(std::size_t{mask} + 1, 0);
    for (const BodyPair& hit : from) ++begins_[hit.a.index >> shift & mask];
    std::uint32_t total = 0;
    for (std::uint32_t& begin : begins_) {
        const std::uint32_t count = begin;
        begin = total;
        total += count;
    }
    to.resize(from.size());
    for (const BodyPair& hit : from) to[begins_[hit.a.index >> shift & mask]++] = hit;
}

}  // namespace fts::physics
