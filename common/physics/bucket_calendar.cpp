#include "common/physics/bucket_calendar.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace fts::physics {
namespace {

constexpr std::uint32_t kFewestBuckets = 64;
// The ring is so many times as long as it takes until an eighth of all comes up.
constexpr double kEighthsInRing = 32.0;
constexpr std::size_t kTimesSampled = 256;
// Stretches are counted up to here; all later times are in this one.
constexpr std::int64_t kLastStretch = std::int64_t{1} << 62;
constexpr std::uint32_t kSpreadEvery = 16;
constexpr std::uint64_t kCoarse = 0xffffffffe0000000;  // half of a double's places
constexpr std::int64_t kNoStretch = std::numeric_limits<std::int64_t>::max();

// Whether `rounded` is a - b exactly: what it lacks is at most half the last place of it, of a and
// of b, of one of which it is a multiple.
bool is_difference(double a, double b, double rounded) {
    return rounded + b == a && a - rounded == b;
}

}  // namespace

void BucketCalendar::reset(std::uint32_t slots) {
    assert(slots < kFirstOf);
    nodes_.assign(std::size_t{slots} + 1, Node{0.0, kAbsent, slots});
    const std::uint32_t buckets = std::bit_ceil(std::max(slots, kFewestBuckets));
    first_.assign(std::size_t{buckets} + 1, nobody());
    occupied_.assign(buckets / 64, 0);
    sample_s_.reserve(kTimesSampled + 1);
    many_.reset(slots);
    few_count_ = 0;
    mask_ = buckets - 1;
    entries_ = 0;
    begin_s_ = kLongAgo;
    stretches_per_s_ = 1.0;
    now_ = 0;
    nearest_far_ = kNoStretch;
}

void BucketCalendar::set(std::uint32_t body, double time_s) {
    if (time_s == std::numeric_limits<double>::infinity()) {
        remove(body);
        return;
    }
    nodes_[body].time_s = time_s;
    take_out(body);
    ++entries_;
    place(body);
}

void BucketCalendar::remove(std::uint32_t body) {
    take_out(body);
}

// Before the first `top` there are no stretches, and all are far.
std::int64_t BucketCalendar::stretch_of(double time_s) const {
    const double stretch = (time_s - begin_s_) * stretches_per_s_;
    constexpr auto kLast = static_cast<double>(kLastStretch);
    return static_cast<std::int64_t>(std::min(std::max(0.0, stretch), kLast));
}

// The body is in no list, or in one that is being emptied.
void BucketCalendar::place(std::uint32_t body) {
    const double time_s = nodes_[body].time_s;
    const std::int64_t stretch = stretch_of(time_s), ahead = stretch - now_;
    if (ahead > 0 && ahead <= static_cast<std::int64_t>(mask_)) [[likely]] {
        const std::uint32_t bucket = static_cast<std::uint32_t>(stretch) & mask_;
        link(bucket, body);
        occupied_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
    } else if (ahead <= 0) {
        place_now({time_s, body});
    } else {
        link(far(), body);
        nearest_far_ = std::min(nearest_far_, stretch);
    }
}

void BucketCalendar::place_now(const Entry& entry) {
    if (few_count_ < kMostFew && many_.empty()) {
        std::uint32_t at = few_count_++;
        for (; at > 0 && few_[at - 1] < entry; --at) few_[at] = few_[at - 1];
        few_[at] = entry;
        nodes_[entry.body].before = kAmongFew;
        return;
    }
    for (; few_count_ > 0; --few_count_) {
        const Entry& other = few_[few_count_ - 1];
        nodes_[other.body].before = kAmongMany;
        many_.set(other.body, other.time_s);
    }
    nodes_[entry.body].before = kAmongMany;
    many_.set(entry.body, entry.time_s);
}

void BucketCalendar::take_out_of_few(std::uint32_t body) {
    std::uint32_t at = --few_count_;
    Entry next = few_[at];
    while (next.body != body) std::swap(next, few_[--at]);
}

void BucketCalendar::take_out(std::uint32_t body) {
    Node& node = nodes_[body];
    if (node.before == kAbsent) return;
    --entries_;
    if (node.before == kAmongFew || node.before == kAmongMany) {
        node.before == kAmongFew ? take_out_of_few(body) : many_.remove(body);
        node.before = kAbsent;
        return;
    }
    nodes_[node.after].before = node.before;
    const bool is_first = (node.before & kFirstOf) != 0;
    std::uint32_t* const links[] = {&nodes_[is_first ? nobody() : node.before].after,
                                    &first_[is_first ? node.before & ~kFirstOf : 0]};
    *links[is_first ? 1 : 0] = node.after;
    node.before = kAbsent;
}

void BucketCalendar::link(std::uint32_t bucket, std::uint32_t body) {
    const std::uint32_t after = first_[bucket];
    nodes_[body].before = kFirstOf | bucket;
    nodes_[body].after = after;
    nodes_[after].before = body;
    first_[bucket] = body;
}

void BucketCalendar::advance() {
    if (entries_ == 0) return;
    if (!has_stretches()) spread();
    while (few_count_ == 0 && many_.empty()) {
        std::int64_t next = next_occupied();
        if (next >= nearest_far_) {
            fetch_far();
            next = next_occupied();
            // None of them is within a round from now: the stretches are too short for what is
            // left.
            if (next > nearest_far_) {
                spread();
                continue;
            }
        }
        now_ = next;
        const std::uint32_t bucket = static_cast<std::uint32_t>(now_) & mask_;
        for (std::uint32_t body = first_[bucket]; body != nobody(); body = nodes_[body].after) {
            place_now({nodes_[body].time_s, body});
        }
        first_[bucket] = nobody();
        occupied_[bucket / 64] &= ~(std::uint64_t{1} << (bucket % 64));
    }
    look_beyond();
}

void BucketCalendar::look_beyond() {
    const auto first_in = [&](std::uint32_t ahead) {
        return first_[(static_cast<std::uint32_t>(now_) + ahead) & mask_];
    };
    has_gone_on_ = true;
    soon_count_ = 0;
    __builtin_prefetch(&nodes_[first_in(kAhead + 2)]);
    __builtin_prefetch(&nodes_[nodes_[first_in(kAhead + 1)].after]);
    std::uint32_t body = first_in(kAhead);
    for (; body != nobody() && soon_count_ < kMostSoon; body = nodes_[body].after) {
        soon_[soon_count_++] = body;
    }
}

// The stretch of the next bucket that is not empty; kNoStretch when all are.
std::int64_t BucketCalendar::next_occupied() const {
    const auto words = static_cast<std::uint32_t>(occupied_.size());
    const std::uint32_t begin = static_cast<std::uint32_t>(now_ + 1) & mask_;
    std::uint64_t word = occupied_[begin / 64] & (~std::uint64_t{0} << (begin % 64));
    for (std::uint32_t i = 0; i <= words; ++i) {
        const std::uint32_t at = (begin / 64 + i) & (words - 1);
        if (i > 0) word = occupied_[at];
        if (word == 0) continue;
        const std::uint32_t bucket = 64 * at + static_cast<std::uint32_t>(std::countr_zero(word));
        return now_ + 1 + ((bucket - begin) & mask_);
    }
    return kNoStretch;
}

// Those within a round from now come into the ring, or the heap.
void BucketCalendar::fetch_far() {
    nearest_far_ = kNoStretch;
    std::uint32_t body = first_[far()];
    first_[far()] = nobody();
    while (body != nobody()) {
        const std::uint32_t after = nodes_[body].after;
        place(body);
        body = after;
    }
}

void BucketCalendar::rebase(double shift_s) {
    const double begin_s = begin_s_ - shift_s;
    bool is_exact = is_difference(begin_s_, shift_s, begin_s);
    for (Node& node : nodes_) {
        const double time_s = node.time_s - shift_s;
        is_exact &= node.before == kAbsent || is_difference(node.time_s, shift_s, time_s);
        node.time_s = time_s;
    }
    if (!has_stretches() || entries_ == 0) return;
    // If nothing is rounded, all stay in the stretches where they are.
    if (!is_exact || !many_.empty() || rebases_to_spread_-- == 0) return spread();
    begin_s_ = begin_s;
    for (std::uint32_t i = 0; i < few_count_; ++i) few_[i].time_s -= shift_s;
}

// All are placed anew, in stretches that suit them.
void BucketCalendar::spread() {
    double first_s = std::numeric_limits<double>::infinity();
    for (std::uint32_t body = 0; body < nobody(); ++body) {
        const Node& node = nodes_[body];
        if (node.before != kAbsent) first_s = std::min(first_s, node.time_s);
    }
    // So coarse that it can be moved exactly.
    begin_s_ = std::bit_cast<double>(std::bit_cast<std::uint64_t>(first_s) & kCoarse);
    rebases_to_spread_ = kSpreadEvery;
    stretches_per_s_ = 1.0 / suitable_width_s(first_s);
    now_ = stretch_of(first_s);
    nearest_far_ = kNoStretch;
    std::fill(first_.begin(), first_.end(), nobody());
    std::fill(occupied_.begin(), occupied_.end(), 0);
    few_count_ = 0;
    many_.clear();
    for (std::uint32_t body = 0; body < nobody(); ++body) {
        if (nodes_[body].before != kAbsent) place(body);
    }
}

// Two to four a stretch, as long as the next eighth of all come up evenly.
double BucketCalendar::suitable_width_s(double first_s) {
    sample_s_.clear();
    const std::size_t stride = nodes_.size() / kTimesSampled + 1;
    for (std::size_t body = 0; body < nobody(); body += stride) {
        if (nodes_[body].before != kAbsent) sample_s_.push_back(nodes_[body].time_s);
    }
    if (sample_s_.empty()) return 1.0;
    const auto eighth = sample_s_.begin() + static_cast<std::ptrdiff_t>(sample_s_.size() / 8);
    std::nth_element(sample_s_.begin(), eighth, sample_s_.end());
    const double width_s = (*eighth - first_s) / (static_cast<double>(mask_) / kEighthsInRing);
    return std::isnormal(width_s) && std::isfinite(1.0 / width_s) ? width_s : 1.0;
}

}  // namespace fts::physics
