#include "common/replication/snapshot_receiver.h"

#include <utility>

namespace fts::replication {

Tick tick_of(const SnapshotPacket& packet) {
    if (packet.kind == SnapshotPacket::Kind::kStates) {
        const auto header = peek_part(packet.part);
        return header ? header->tick : 0;
    }
    const auto header = peek_control_part(packet.part);
    return header ? header->tick : 0;
}

SnapshotReceiver::Received SnapshotReceiver::receive(const SnapshotPacket& packet,
                                                     Tick snapshot_ticks,
                                                     const CourseOf& course_of) {
    if (packet.kind == SnapshotPacket::Kind::kStates) return {receive_states(packet.part), {}};
    return receive_events(packet.part, snapshot_ticks, course_of);
}

bool SnapshotReceiver::is_news(Tick tick) {
    if (!any_ || tick > newest_tick_) return true;
    if (!history_.find(tick)) ++counts_.late;
    return false;
}

// A baseline that is no longer held makes a part unreadable; the gap shows.
std::shared_ptr<const Snapshot> SnapshotReceiver::receive_states(
    std::span<const std::uint8_t> part) {
    const auto header = peek_part(part);
    if (!header) {
        ++counts_.malformed;
        return nullptr;
    }
    if (!is_news(header->tick)) return nullptr;
    static const Snapshot kNothing;
    const auto held = history_.find(header->baseline_tick);
    if (!held && header->baseline_tick != 0) return nullptr;
    auto whole = assembler_.add(held ? *held : kNothing, part);
    if (!whole) return nullptr;
    replay_.reset();
    return keep(std::move(*whole));
}

SnapshotReceiver::Received SnapshotReceiver::receive_events(std::span<const std::uint8_t> part,
                                                            Tick snapshot_ticks,
                                                            const CourseOf& course_of) {
    const auto header = peek_control_part(part);
    if (!header) {
        ++counts_.malformed;
        return {};
    }
    if (!is_news(header->tick)) return {};
    const auto baseline = history_.find(header->baseline_tick);
    if (!baseline) return {};
    auto told = decode_events(*baseline, part);
    if (!told) {
        ++counts_.malformed;
        return {};
    }
    // What was replayed up to a newer snapshot than the baseline need not be replayed again.
    const auto newest = history_.newest();
    if (!replay_ || replay_->tick() != newest->tick) {
        const auto course = course_of(newest->level);
        if (!course) return {};
        replay_.emplace(*course, *newest, snapshot_ticks);
    }
    replay_->run_to(told->tick, told->events);
    Snapshot outcome = replay_->snapshot();
    if (outcome_digest_of(outcome) == told->outcome_digest) {
        std::vector<ControlEvent>& controls = told->events.controls;
        std::erase_if(controls, [&](const auto& event) { return event.tick <= newest->tick; });
        return {keep(std::move(outcome)), std::move(controls)};
    }
    ++counts_.unlike;
    replay_.reset();
    history_.clear();
    return {};
}

std::shared_ptr<const Snapshot> SnapshotReceiver::keep(Snapshot&& snapshot) {
    if (!is_canonical(snapshot)) {
        ++counts_.malformed;
        replay_.reset();
        return nullptr;
    }
    newest_tick_ = snapshot.tick;
    any_ = true;
    auto shared = std::make_shared<const Snapshot>(std::move(snapshot));
    history_.add(shared);
    return shared;
}

Tick SnapshotReceiver::held_tick() const {
    const auto newest = history_.newest();
    return newest ? newest->tick : 0;
}

SnapshotReceiver::Counts SnapshotReceiver::counts() const {
    Counts counts = counts_;
    counts.malformed += assembler_.malformed_count();
    return counts;
}

}  // namespace fts::replication
