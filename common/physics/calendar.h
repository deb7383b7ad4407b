// The calendar of an event-driven simulation: for each body the time of the next thing that happens
// to it, earliest first. Bodies with equal times come in ascending order of index, so that the
// order of events is total and depends on the times only.
//
// A heap of four children a node, each brood in one cache line, that knows where every body stands.
// For few: what an entry costs grows with the logarithm of their number. bucket_calendar.h is for
// many.
//
// Not thread-safe. No allocation but in `reset`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace fts::physics {

class Calendar {
  public:
    struct Entry {
        double time_s = std::numeric_limits<double>::infinity();
        std::uint32_t body = 0xffffffff;

        bool operator<(const Entry& other) const {
            return time_s < other.time_s || (time_s == other.time_s && body < other.body);
        }
    };

    // Empties it. `slots` is above every body's index.
    void reset(std::uint32_t slots);
    // Empties it. Linear in the number of entries.
    void clear();

    // Enters a body, or moves it. An infinite time removes it.
    void set(std::uint32_t body, double time_s);
    void remove(std::uint32_t body);

    bool empty() const { return end_ == kRoot; }
    const Entry& top() const { return at(kRoot); }

  private:
    // The children of slot s are the brood s - 2, and the root is the last of brood 0, so that all
    // broods begin at a cache line. Vacant slots hold the default Entry, which is after all others.
    struct alignas(64) Brood {
        Entry child[4];
    };
    static_assert(sizeof(Brood) == 64);
    static constexpr std::uint32_t kRoot = 3;
    static constexpr std::uint32_t kNowhere = 0;

    static std::uint32_t parent_of(std::uint32_t slot) { return slot / 4 + 2; }
    Entry& at(std::uint32_t slot) { return broods_[slot / 4].child[slot % 4]; }
    const Entry& at(std::uint32_t slot) const { return broods_[slot / 4].child[slot % 4]; }
    void put(std::uint32_t slot, const Entry& entry) {
        at(slot) = entry;
        slot_of_[entry.body] = slot;
    }
    void rise(std::uint32_t slot, const Entry& entry);
    void sink(std::uint32_t slot, const Entry& entry);

    std::vector<Brood> broods_;
    std::vector<std::uint32_t> slot_of_;  // by body
    std::uint32_t end_ = kRoot;           // one past the last slot in use
};

}  // namespace fts::physics
