#include "common/replication/shared_replay.h"

#include <utility>

namespace fts::replication {

SharedReplay::Result SharedReplay::replay(const Snapshot& start, Tick baseline_tick,
                                          const ControlPart& part, Tick snapshot_ticks,
                                          const CourseOf& course_of) {
    Arena& arena = arenas_[start.arena];
    Made& made = arena.recent[part.tick / snapshot_ticks % arena.recent.size()];
    if (made.snapshot && made.snapshot->tick == part.tick && made.digest == part.outcome_digest) {
        return {Outcome::kMade, made.snapshot};
    }
    // Another's newest snapshot will do if what happened since is in this part.
    const bool can_go_on = arena.running && arena.level == start.level &&
                           arena.running->tick() >= baseline_tick &&
                           arena.running->tick() < part.tick;
    if (!can_go_on) {
        const auto course = course_of(start.level);
        if (!course) return {};
        arena.running.emplace(*course, start, snapshot_ticks);
        arena.level = start.level;
    }
    arena.running->run_to(part.tick, part.events);
    Snapshot outcome = arena.running->snapshot();
    if (outcome_digest_of(outcome) != part.outcome_digest || !is_canonical(outcome)) {
        arena.running.reset();
        return {Outcome::kUnlike, nullptr};
    }
    made = {part.outcome_digest, std::make_shared<const Snapshot>(std::move(outcome))};
    return {Outcome::kMade, made.snapshot};
}

}  // namespace fts::replication
