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
constexpr std::int64_t kNoStretch = std::numeric_limits<std::int64_t>::max();

}  // namespace

void BucketCalendar::reset(std::uint32_t slots) {
    assert(slots < kFirstOf);
    nodes_.assign(slots, Node{0.0, kAbsent, kNobody});
    const std::uint32_t buckets = std::bit_ceil(std::max(slots, kFewestBuckets));
    first_.assign(std::size_t{buckets} + 1, kNobody);
    occupied_.assign(buckets / 64, 0);
    sample_s_.reserve(kTimesSampled + 1);
    many_.reset(slots);
    few_count_ = 0;
    mask_ = buckets - 1;
    entries_ = 0;
    begin_s_ = stretches_per_s_ = 0.0;
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
    const double stretch = std::max(0.0, (time_s - begin_s_) * stretches_per_s_);
    constexpr auto kLast = static_cast<double>(kLastStretch);
    if (!(stretch < kLast) || stretches_per_s_ == 0.0) return kLastStretch;
    return static_cast<std::int64_t>(stretch);
}

// The body is in no list, or in one that is being emptied.
void BucketCalendar::place(std::uint32_t body) {
    const double time_s = nodes_[body].time_s;
    const std::int64_t stretch = stretch_of(time_s), ahead = stretch - now_;
    if (ahead <= 0) {
        place_now({time_s, body});
    } else if (ahead <= static_cast<std::int64_t>(mask_)) {
        const std::uint32_t bucket = static_cast<std::uint32_t>(stretch) & mask_;
        link(bucket, body);
        occupied_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
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
    if (node.after != kNobody) nodes_[node.after].before = node.before;
    if ((node.before & kFirstOf) == 0) {
        nodes_[node.before].after = node.after;
    } else {
        const std::uint32_t bucket = node.before & ~kFirstOf;
        first_[bucket] = node.after;
        if (node.after == kNobody && bucket != far()) {
            occupied_[bucket / 64] &= ~(std::uint64_t{1} << (bucket % 64));
        }
    }
    node.before = kAbsent;
}

void BucketCalendar::link(std::uint32_t bucket, std::uint32_t body) {
    const std::uint32_t after = first_[bucket];
    nodes_[body].before = kFirstOf | bucket;
    nodes_[body].after = after;
    if (after != kNobody) nodes_[after].before = body;
    first_[bucket] = body;
}

void BucketCalendar::advance() {
    if (entries_ == 0) return;
    if (stretches_per_s_ == 0.0) spread();
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
        for (std::uint32_t body = first_[bucket]; body != kNobody; body = nodes_[body].after) {
            place_now({nodes_[body].time_s, body});
        }
        first_[bucket] = kNobody;
        occupied_[bucket / 64] &= ~(std::uint64_t{1} << (bucket % 64));
    }
    look_beyond();
}

void BucketCalendar::look_beyond() {
    has_gone_on_ = true;
    soon_count_ = 0;
    std::uint32_t body = first_[static_cast<std::uint32_t>(now_ + kAhead) & mask_];
    for (; body != kNobody && soon_count_ < kMostSoon; body = nodes_[body].after) {
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
    first_[far()] = kNobody;
    while (body != kNobody) {
        const std::uint32_t after = nodes_[body].after;
        place(body);
        body = after;
    }
}

void BucketCalendar::rebase(double shift_s) {
    for (Node& node : nodes_) node.time_s -= shift_s;
    if (entries_ > 0) spread();
}

// All are placed anew, in stretches that suit them.
void BucketCalendar::spread() {
    double first_s = std::numeric_limits<double>::infinity();
    for (const Node& node : nodes_) {
        if (node.before != kAbsent) first_s = std::min(first_s, node.time_s);
    }
    begin_s_ = first_s;
    stretches_per_s_ = 1.0 / suitable_width_s(first_s);
    now_ = 0;
    nearest_far_ = kNoStretch;
    std::fill(first_.begin(), first_.end(), kNobody);
    std::fill(occupied_.begin(), occupied_.end(), 0);
    few_count_ = 0;
    many_.clear();
    for (std::uint32_t body = 0; body < nodes_.size(); ++body) {
        if (nodes_[body].before != kAbsent) place(body);
    }
}

// Two to four a stretch, as long as the next eighth of all come up evenly.
double BucketCalendar::suitable_width_s(double first_s) {
    sample_s_.clear();
    const std::size_t stride = nodes_.size() / kTimesSampled + 1;
    for (std::size_t body = 0; body < nodes_.size(); body += stride) {
        if (nodes_[body].before != kAbsent) sample_s_.push_back(nodes_[body].time_s);
    }
    if (sample_s_.empty()) return 1.0;
    const auto eighth = sample_s_.begin() + static_cast<std::ptrdiff_t>(sample_s_.size() / 8);
    std::nth_element(sample_s_.begin(), eighth, sample_s_.end());
    const double width_s = (*eighth - first_s) / (static_cast<double>(mask_) / kEighthsInRing);
    return std::isnormal(width_s) && std::isfinite(1.0 / width_s) ? width_s : 1.0;
}

}  // namespace fts::physics
