#include "common/replication/snapshot_history.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace fts::replication {
namespace {

using Slot = std::shared_ptr<const Snapshot>;

// An empty slot is older than any snapshot.
bool is_older(const Slot& a, const Slot& b) {
    if (!a || !b) return !a && b;
    return a->tick < b->tick;
}

}  // namespace

void SnapshotHistory::add(std::shared_ptr<const Snapshot> snapshot) {
    assert(snapshot);
    for (Slot& slot : slots_) {
        if (!slot || slot->tick != snapshot->tick) continue;
        slot = std::move(snapshot);
        return;
    }
    Slot& oldest = *std::min_element(slots_.begin(), slots_.end(), is_older);
    if (is_older(oldest, snapshot)) oldest = std::move(snapshot);
}

std::shared_ptr<const Snapshot> SnapshotHistory::find(Tick tick) const {
    for (const Slot& slot : slots_) {
        if (slot && slot->tick == tick) return slot;
    }
    return nullptr;
}

std::shared_ptr<const Snapshot> SnapshotHistory::newest() const {
    return *std::max_element(slots_.begin(), slots_.end(), is_older);
}

void SnapshotHistory::clear() {
    slots_.fill(nullptr);
}

}  // namespace fts::replication
