#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

#include "common/replication/delta.h"
#include "common/replication/delta_format.h"

namespace fts::replication {
namespace {

template <typename Entry>
void append(std::vector<Entry>& to, const std::vector<Entry>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

bool same_arena_state(const Snapshot& a, const Snapshot& b) {
    return a.arena == b.arena && a.phase == b.phase && a.level == b.level &&
           a.phase_end_tick == b.phase_end_tick;
}

}  // namespace

std::optional<Snapshot> SnapshotAssembler::add(const Snapshot& baseline,
                                               std::span<const std::uint8_t> bytes) {
    auto decoded = delta_format::decode(baseline, bytes);
    if (!decoded) {
        ++malformed_count_;
        return std::nullopt;
    }
    const PartHeader header = decoded->header;
    if (any_complete_ && header.tick <= newest_complete_) return std::nullopt;
    Pending* pending = pending_for(header);
    if (pending == nullptr) return std::nullopt;

    Piece piece{header.part, decoded->begin_key, decoded->end_key, std::move(decoded->snapshot)};
    const bool of_the_same_delta = header.baseline_tick == pending->header.baseline_tick &&
                                   header.part_count == pending->header.part_count;
    const Fit fit = of_the_same_delta ? insert(*pending, std::move(piece)) : Fit::kContradicts;
    if (fit == Fit::kContradicts) ++malformed_count_;
    if (fit != Fit::kNew) return std::nullopt;
    if (pending->pieces.size() < header.part_count) return std::nullopt;

    auto whole = joined(std::move(*pending));
    if (whole) {
        newest_complete_ = header.tick;
        any_complete_ = true;
        std::erase_if(pending_, [&](const Pending& p) { return p.header.tick <= header.tick; });
    } else {
        ++malformed_count_;
        std::erase_if(pending_, [&](const Pending& p) { return p.header.tick == header.tick; });
    }
    return whole;
}

// Null when there is no room for a tick as old as this one.
SnapshotAssembler::Pending* SnapshotAssembler::pending_for(const PartHeader& header) {
    const auto older = [](const Pending& a, const Pending& b) {
        return a.header.tick < b.header.tick;
    };
    const auto same = std::find_if(pending_.begin(), pending_.end(),
                                   [&](const Pending& p) { return p.header.tick == header.tick; });
    if (same != pending_.end()) return &*same;
    if (pending_.size() == kMaxPendingTicks) {
        const auto oldest = std::min_element(pending_.begin(), pending_.end(), older);
        if (oldest->header.tick > header.tick) return nullptr;
        pending_.erase(oldest);
    }
    return &pending_.emplace_back(Pending{header, {}});
}

SnapshotAssembler::Fit SnapshotAssembler::insert(Pending& pending, Piece piece) {
    std::vector<Piece>& held = pending.pieces;
    const auto next = std::lower_bound(
        held.begin(), held.end(), piece.part,
        [](const Piece& candidate, std::uint16_t part) { return candidate.part < part; });
    if (next != held.end()) {
        if (next->part == piece.part) return Fit::kRepeated;
        if (piece.end_key > next->begin_key) return Fit::kContradicts;
    }
    if (next != held.begin() && std::prev(next)->end_key > piece.begin_key)
        return Fit::kContradicts;
    if (!held.empty() && !same_arena_state(held.front().snapshot, piece.snapshot)) {
        return Fit::kContradicts;
    }
    held.insert(next, std::move(piece));
    return Fit::kNew;
}

std::optional<Snapshot> SnapshotAssembler::joined(Pending pending) {
    Snapshot whole = std::move(pending.pieces.front().snapshot);
    for (std::size_t i = 1; i < pending.pieces.size(); ++i) {
        const Piece& piece = pending.pieces[i];
        if (pending.pieces[i - 1].end_key != piece.begin_key) return std::nullopt;
        append(whole.balls, piece.snapshot.balls);
        append(whole.coins, piece.snapshot.coins);
        append(whole.hits, piece.snapshot.hits);
    }
    if (!is_canonical(whole)) return std::nullopt;  // hits of different parts may be out of order
    return whole;
}

}  // namespace fts::replication
