#include "common/replication/snapshot_history.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "common/replication/delta.h"

namespace fts::replication {
namespace {

Tick tick_of_held(const std::shared_ptr<const Snapshot>& snapshot) {
    return snapshot->tick;
}

}  // namespace

void SnapshotHistory::add(std::shared_ptr<const Snapshot> snapshot) {
    assert(snapshot);
    const auto place = std::ranges::lower_bound(held_, snapshot->tick, {}, tick_of_held);
    if (place != held_.end() && (*place)->tick == snapshot->tick) {
        *place = std::move(snapshot);
    } else {
        held_.insert(place, std::move(snapshot));
    }
    const Tick newest_tick = held_.back()->tick;
    while (newest_tick - held_.front()->tick > kMaxBaselineAgeTicks) held_.pop_front();
}

std::shared_ptr<const Snapshot> SnapshotHistory::find(Tick tick) const {
    auto found = newest_up_to(tick);
    return found && found->tick == tick ? found : nullptr;
}

std::shared_ptr<const Snapshot> SnapshotHistory::newest() const {
    return held_.empty() ? nullptr : held_.back();
}

std::shared_ptr<const Snapshot> SnapshotHistory::newest_up_to(Tick tick) const {
    const auto after = std::ranges::upper_bound(held_, tick, {}, tick_of_held);
    return after == held_.begin() ? nullptr : *std::prev(after);
}

}  // namespace fts::replication
