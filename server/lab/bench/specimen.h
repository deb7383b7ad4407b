// An engine in a scene, warmed up and ready to be timed, with what it does to the laws: a fast
// wrong answer is not a result.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "server/lab/bench/bench_cell.h"
#include "server/lab/bench/engine.h"

namespace fts::lab {

// Pairs of balls that fly at each other, and how many of them came out on the other side.
struct HeadOn {
    std::size_t pairs = 0, through = 0;
    double per_1000() const {
        return 1000.0 * static_cast<double>(through) / static_cast<double>(pairs);
    }
};
inline constexpr std::size_t kHeadOnPairs = 1000;

// Equal balls, each pair alone on its line, that meet at a random moment of a tick.
HeadOn shoot_head_on(const std::string& engine, double closing_radii_per_tick, std::size_t pairs);

// An energy that became infinite or no number counts as this error, which JSON can hold.
inline constexpr double kEnergyLost = 1e300;

struct Laws {
    double energy_error = 0.0;  // relative, >= 0, after `ticks` ticks from the start
    std::size_t ticks = 0;      // warm_up_ticks
    // At the speed of the scene: each ball at the root of the mean square. Empty for a floor.
    std::optional<HeadOn> head_on;
};

// After how many ticks energy is judged and timing begins, for every engine alike: a second of the
// scene. Large and fast scenes have less, so that the slowest engine takes a few seconds, but 5
// ticks at least, and as many as move a ball by a radius.
std::size_t warm_up_ticks(const BenchScene& scene);

class Specimen {
  public:
    // Throws SceneRefused.
    explicit Specimen(const BenchCell& cell);

    Engine& engine() { return *engine_; }
    const Laws& laws() const { return laws_; }
    void set(const std::optional<HeadOn>& head_on) { laws_.head_on = head_on; }

  private:
    std::unique_ptr<Engine> engine_;
    Laws laws_;
};

// Specimens by cell, so that whoever measures one again need not warm it up again. When their balls
// become too many, all are forgotten.
class SpecimenStore {
  public:
    // The cell is one that is run (reason_not_to_run). Valid until the next call. Null, and
    // `not_run` says why, when its scene cannot be made.
    Specimen* get(const BenchCell& cell, std::string& not_run);

  private:
    Specimen* make(const BenchCell& cell, std::string& not_run);

    std::map<std::string, Specimen> specimens_;
    std::map<std::pair<std::string, double>, HeadOn> head_on_;  // by engine and speed
    std::map<std::string, std::string> refused_;                // why, by the scene's text
    std::size_t balls_ = 0;
};

}  // namespace fts::lab
