// The calendar of calendar.h for many bodies: what `set`, `remove` and `top` cost does not grow
// with their number, while times are spread over some span as those of a gas are. It gives the same
// order, to the last entry, for any times.
//
// A queue of bounded increment (Paul, "A complexity O(1) priority queue for event driven molecular
// dynamics simulations", 2007): a ring of buckets, each of them a short stretch of time and an
// unordered list; what is in the present bucket is kept in order, and in a heap if it is many.
// Times beyond the ring wait in one more list, which is gone through once in at least half a round.
// How long a bucket is suits the times that are there at the first `top` after `reset`, at every
// so many calls of `rebase`, and when the ring has run empty.
//
// Not thread-safe. No allocation but in `reset`.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "common/physics/calendar.h"
#include "common/physics/roomy_vector.h"

namespace fts::physics {

class BucketCalendar {
  public:
    using Entry = Calendar::Entry;

    // Empties it. `slots` is above every body's index.
    void reset(std::uint32_t slots);

    // Enters a body, or moves it. An infinite time removes it.
    void set(std::uint32_t body, double time_s);
    void remove(std::uint32_t body);

    bool empty() const { return entries_ == 0; }
    const Entry& top() {
        if (few_count_ > 0) return few_[few_count_ - 1];
        if (many_.empty()) advance();
        return few_count_ > 0 ? few_[few_count_ - 1] : many_.top();
    }

    // Whether `top` went on to another stretch of time since the last call; then `soon` is who
    // comes up kAhead stretches later, in no order: most of them, as far as is known yet.
    bool has_gone_on() { return std::exchange(has_gone_on_, false); }
    std::span<const std::uint32_t> soon() const { return {soon_, soon_count_}; }
    static constexpr std::uint32_t kMostSoon = 8;

    // All times become earlier by `shift_s`. Linear in the number of bodies.
    void rebase(double shift_s);

  private:
    // In the list of a bucket, of the far ones, or in none. `before` is a body, or tells the list
    // that this is the first of. After the last one comes nobody(), who has a node as well, so that
    // links are written without asking.
    struct Node {
        double time_s = 0.0;
        std::uint32_t before = 0;
        std::uint32_t after = 0;
    };
    static_assert(sizeof(Node) == 16);
    static constexpr std::uint32_t kAmongFew = 0xfffffffe;  // in place of `before`
    static constexpr std::uint32_t kAmongMany = 0xfffffffd;
    static constexpr std::uint32_t kAbsent = 0xfffffffc;
    static constexpr std::uint32_t kFirstOf = 0x80000000;  // a flag: the rest is a bucket
    static constexpr std::uint32_t kMostFew = 24;
    static constexpr std::uint32_t kAhead = 3;
    static constexpr double kLongAgo = -std::numeric_limits<double>::infinity();

    std::int64_t stretch_of(double time_s) const;
    std::uint32_t far() const { return mask_ + 1; }
    std::uint32_t nobody() const { return static_cast<std::uint32_t>(nodes_.size()) - 1; }
    bool has_stretches() const { return begin_s_ > kLongAgo; }
    void place(std::uint32_t body);
    void place_now(const Entry& entry);
    void take_out(std::uint32_t body);
    void take_out_of_few(std::uint32_t body);
    void link(std::uint32_t bucket, std::uint32_t body);
    void advance();
    void look_beyond();
    std::int64_t next_occupied() const;
    void fetch_far();
    void spread();
    double suitable_width_s(double first_s);

    RoomyVector<Node> nodes_;              // by body
    RoomyVector<std::uint32_t> first_;     // by bucket; the last one is of the far ones
    std::vector<std::uint64_t> occupied_;  // a bit for each bucket that is not empty, or just was
    std::vector<double> sample_s_;
    // Of the stretch now_ and all before it: the few have the earliest at the end, and are none
    // while there are many.
    Entry few_[kMostFew];
    std::uint32_t few_count_ = 0;
    Calendar many_;
    std::uint32_t soon_[kMostSoon] = {};
    std::uint32_t soon_count_ = 0;
    bool has_gone_on_ = false;
    std::uint32_t entries_ = 0;
    std::uint32_t mask_ = 0;
    double begin_s_ = kLongAgo;  // of stretch 0; long ago while there are no stretches
    double stretches_per_s_ = 1.0;
    std::uint32_t rebases_to_spread_ = 0;
    std::int64_t now_ = 0;
    std::int64_t nearest_far_ = 0;  // no far one is in an earlier stretch
};

}  // namespace fts::physics
