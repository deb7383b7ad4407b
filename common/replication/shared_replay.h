// SharedReplay: the replays behind the snapshots that clients of one server make in one process.
// Each snapshot is made once, by whoever is told of it first; the others find it by its tick and
// digest. A client alone has one to itself.
//
// Hits of a snapshot are those since the one that was made before it, by whomever.
//
// Not thread-safe: all who share it run on one thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "common/replication/arena_replay.h"

namespace fts::replication {

class SharedReplay {
  public:
    // What is known of a level; empty before that has been said.
    using CourseOf = std::function<std::optional<Course>(int level)>;

    enum class Outcome : std::uint8_t { kMade, kUnlike, kNoCourse };
    struct Result {
        Outcome outcome = Outcome::kNoCourse;
        std::shared_ptr<const Snapshot> snapshot;  // of kMade
    };
    // What becomes of `start` by what `part` tells. `start` is held by the caller, and not older
    // than the baseline of the part.
    Result replay(const Snapshot& start, Tick baseline_tick, const ControlPart& part,
                  Tick snapshot_ticks, const CourseOf& course_of);

  private:
    struct Made {
        std::uint32_t digest = 0;
        std::shared_ptr<const Snapshot> snapshot;
    };
    struct Arena {
        std::optional<ArenaReplay> running;  // at the newest snapshot that was made
        std::uint16_t level = 0;
        std::array<Made, 64> recent;  // by tick, modulo
    };

    std::map<std::uint8_t, Arena> arenas_;
};

}  // namespace fts::replication
