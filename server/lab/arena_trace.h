// The arena that `fts-lab replication` streams: equal discs in a box of 16:9, of which 30 % are
// steered as players do (one of eight directions or none, changed at random three times a second),
// and the rest coast. The same numbers give the same trace on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/physics/splitmix.h"
#include "common/replication/control_events.h"
#include "common/replication/lattice_world.h"

namespace fts::lab {

inline constexpr double kTraceHeightM = 64.0;
inline constexpr double kTraceWidthM = kTraceHeightM * 16.0 / 9.0;
inline constexpr double kTraceCoverage = 0.05;
inline constexpr double kTraceSteeredPart = 0.3;
inline constexpr double kTraceChangesPerS = 3.0;
inline constexpr double kTraceThrustMps2 = kTraceHeightM;
inline constexpr double kTraceDragPerS = 2.0;
inline constexpr double kTraceRmsSpeedMps = 0.22 * kTraceHeightM;
inline constexpr int kTraceTickRateHz = 60;
// The first part of every trace is not measured.
inline constexpr double kUnmeasuredS = 10.0;
inline constexpr double kMaxTraceBalls = 65535;  // ids have 16 bits
inline constexpr double kMaxTraceS = 1e6;
inline constexpr replication::Lattice kTraceLattice{kTraceHeightM / 4096.0,
                                                    10.0 * kTraceHeightM / 4096.0};

struct TraceSnapshot {
    replication::Tick tick = 0;
    std::vector<replication::BallState> balls;
    std::vector<replication::ControlEvent> events;  // since the snapshot before
};

// Covering what they should, to the nearest step of a radius.
double trace_radius_m(std::size_t count);

struct TickWatch {
    std::function<void(const physics::World<double>&)> before, after;
};

// What server and client know of it besides snapshots.
replication::Course trace_course();

class ArenaTrace {
  public:
    // With `snaps`, the server's state is put on the lattice at every snapshot, and the trace soon
    // is another than without. Nothing, with `error` set, when so many balls do not fit.
    static std::optional<ArenaTrace> make(std::size_t count, std::uint64_t seed,
                                          replication::Tick snapshot_ticks, bool snaps,
                                          std::string& error);

    // On to the next snapshot; `watch` sees the world before and after each tick.
    TraceSnapshot next(const TickWatch& watch = {});
    double rms_speed_mps() const;
    // What snapping has added to the kinetic energy so far, each time as a part of what there was.
    double energy_added_by_snapping() const { return energy_added_; }

  private:
    ArenaTrace(std::vector<replication::BallState> balls, std::uint64_t seed,
               replication::Tick snapshot_ticks, bool snaps);
    void steer(TraceSnapshot& snapshot);
    void snap();

    replication::Course course_;
    replication::Tick snapshot_ticks_;
    bool snaps_;
    std::vector<replication::BallState> balls_;
    replication::LatticeWorld world_;
    physics::SplitMix random_;
    replication::Tick tick_ = 0;
    double energy_added_ = 0.0;
};

}  // namespace fts::lab
