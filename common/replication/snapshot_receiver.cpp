#include "common/replication/snapshot_receiver.h"

#include <utility>

namespace fts::replication {
namespace {

const Snapshot kNothing;

}  // namespace

Tick tick_of(const SnapshotPacket& packet) {
    if (tells_states(packet.kind)) {
        const auto header = peek_part(packet.part);
        return header ? header->tick : 0;
    }
    const auto header = peek_control_part(packet.part);
    return header ? header->tick : 0;
}

SnapshotReceiver::Received SnapshotReceiver::receive(const SnapshotPacket& packet,
                                                     Tick snapshot_ticks,
                                                     const CourseOf& course_of) {
    using Kind = SnapshotPacket::Kind;
    if (packet.kind == Kind::kStates) return {.snapshot = receive_states(packet.part)};
    if (packet.kind != Kind::kSomeStates) {
        return receive_events(packet.part, snapshot_ticks, course_of);
    }
    const auto some = decode_alone(packet.part);
    return some ? sketched_with(*some, snapshot_ticks, course_of) : Received{};
}

SnapshotReceiver::Received SnapshotReceiver::receive(const KeyframePart& part, Tick snapshot_ticks,
                                                     const CourseOf& course_of) {
    const auto some = decode_alone(part.part);
    if (!some) return {};
    if (auto whole = receive_states(part.part)) return {.snapshot = std::move(whole)};
    return sketched_with(*some, snapshot_ticks, course_of);
}

std::optional<Snapshot> SnapshotReceiver::decode_alone(std::span<const std::uint8_t> part) {
    auto some = decode_part(kNothing, part);
    if (!some) ++counts_.malformed;
    return some;
}

SnapshotReceiver::Received SnapshotReceiver::sketched_with(const Snapshot& part,
                                                           Tick snapshot_ticks,
                                                           const CourseOf& course_of) {
    const auto exact = history_.newest();
    const auto course = course_of(part.level);
    if (!course || (exact && exact->tick >= part.tick)) return {};
    if (exact && exact->tick > sketch_.now().tick) sketch_.begin(*exact);
    sketch_.tell(part, *course, snapshot_ticks);
    return {.snapshot = std::make_shared<const Snapshot>(sketch_.now()), .exact = false};
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
    const auto held = history_.find(header->baseline_tick);
    if (!held && header->baseline_tick != 0) return nullptr;
    auto whole = assembler_.add(held ? *held : kNothing, part);
    if (!whole) return nullptr;
    if (!is_canonical(*whole)) {
        ++counts_.malformed;
        return nullptr;
    }
    return keep(std::make_shared<const Snapshot>(std::move(*whole)));
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
    const SharedReplay::Result result =
        replays_->replay(*newest, baseline->tick, *told, snapshot_ticks, course_of);
    if (result.outcome == SharedReplay::Outcome::kMade) {
        std::vector<ControlEvent>& controls = told->events.controls;
        std::erase_if(controls, [&](const auto& event) { return event.tick <= newest->tick; });
        return {keep(result.snapshot), std::move(controls)};
    }
    if (result.outcome == SharedReplay::Outcome::kUnlike) {
        ++counts_.unlike;
        start_over();
    }
    return {};
}

void SnapshotReceiver::start_over() {
    counts_.malformed += assembler_.malformed_count();
    assembler_ = {};
    history_.clear();
    any_ = false;
}

std::shared_ptr<const Snapshot> SnapshotReceiver::keep(std::shared_ptr<const Snapshot> snapshot) {
    newest_tick_ = snapshot->tick;
    any_ = true;
    history_.add(snapshot);
    return snapshot;
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
