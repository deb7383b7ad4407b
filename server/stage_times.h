// How long the stages of a tick take. The clock is passed in; without one nothing is measured and
// nothing is paid.
//
// `enter` begins a stage and ends the one before; a stage may be entered many times a tick, and
// what counts is its sum over the tick. Work between two ticks counts for the one that follows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>

#include "server/duration_histogram.h"

namespace fts::server {

enum class Stage : std::uint8_t {
    kReceive,    // datagrams read, opened and acted upon
    kInputs,     // each player's input of the tick
    kMatch,      // the game: AI, physics, knock-offs
    kMessages,   // what the game has to say, encoded and queued
    kSnapshots,  // taken and encoded
    kSeal,       // snapshots wrapped and sealed for each client
    kLedger,     // coins handed over to the store's thread, and its answers
    kUpkeep,     // resends, acknowledgements, timeouts
    kSend,       // datagrams given to the system
};
inline constexpr std::array<std::string_view, 9> kStageNames{
    "receive", "inputs", "match", "messages", "snapshots", "seal", "ledger", "upkeep", "send"};

class StageTimes {
  public:
    // Seconds of any monotonic clock.
    using Clock = std::function<double()>;
    explicit StageTimes(Clock clock) : clock_(std::move(clock)) {}

    void enter(Stage stage);
    // Ends the stage; what follows counts for none.
    void leave();
    // Ends the stage and the tick.
    void end_tick();

    using Histograms = std::array<DurationHistogram, kStageNames.size()>;  // of sums over a tick
    const Histograms& histograms() const { return histograms_; }

  private:
    static constexpr std::size_t kNone = kStageNames.size();

    Clock clock_;
    std::size_t current_ = kNone;
    double entered_s_ = 0.0;
    std::array<double, kStageNames.size()> sums_s_{};
    Histograms histograms_;
};

}  // namespace fts::server
