#include "common/physics/calendar.h"

#include <algorithm>

namespace fts::physics {

void Calendar::reset(std::uint32_t slots) {
    broods_.assign((std::size_t{kRoot} + slots) / 4 + 1, Brood());
    slot_of_.assign(slots, kNowhere);
    end_ = kRoot;
}

void Calendar::clear() {
    for (; end_ > kRoot; --end_) {
        slot_of_[at(end_ - 1).body] = kNowhere;
        at(end_ - 1) = Entry();
    }
}

void Calendar::set(std::uint32_t body, double time_s) {
    if (time_s == std::numeric_limits<double>::infinity()) {
        remove(body);
        return;
    }
    const Entry entry{time_s, body};
    const std::uint32_t slot = slot_of_[body];
    if (slot == kNowhere) {
        rise(end_++, entry);
    } else if (entry < at(slot)) {
        rise(slot, entry);
    } else {
        sink(slot, entry);
    }
}

void Calendar::remove(std::uint32_t body) {
    const std::uint32_t slot = slot_of_[body];
    if (slot == kNowhere) return;
    slot_of_[body] = kNowhere;
    const Entry last = at(--end_);
    at(end_) = Entry();
    if (slot == end_) return;
    if (slot > kRoot && last < at(parent_of(slot))) {
        rise(slot, last);
    } else {
        sink(slot, last);
    }
}

void Calendar::rise(std::uint32_t slot, const Entry& entry) {
    while (slot > kRoot && entry < at(parent_of(slot))) {
        put(slot, at(parent_of(slot)));
        slot = parent_of(slot);
    }
    put(slot, entry);
}

void Calendar::sink(std::uint32_t slot, const Entry& entry) {
    for (;;) {
        const std::uint32_t brood = slot - 2;
        if (4 * brood >= end_) break;
        const Entry* child = broods_[brood].child;
        std::uint32_t first = child[1] < child[0] ? 1U : 0U;
        const std::uint32_t second = child[3] < child[2] ? 3U : 2U;
        if (child[second] < child[first]) first = second;
        if (!(child[first] < entry)) break;
        put(slot, child[first]);
        slot = 4 * brood + first;
    }
    put(slot, entry);
}

}  // namespace fts::physics
