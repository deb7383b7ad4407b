// Every fixed limit of the server, in one place. Reaching one is counted or logged, never silent.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/game/rules.h"
#include "common/net/connection.h"
#include "common/replication/messages.h"
#include "common/replication/snapshot_history.h"

namespace fts::server {

// ---- the process
// ------------------------------------------------------------------------------------

inline constexpr int kMaxArenas = 64;
// Connections beyond the players' places, so that a full server can say so, and a player who comes
// back is let in before the old session has timed out.
inline constexpr std::size_t kSpareConnections = 16;
inline constexpr std::size_t kMaxServerNameBytes = 48;

// ---- ticks
// ------------------------------------------------------------------------------------------

// How many late ticks are made up for at once; time lost beyond that is dropped.
inline constexpr int kMaxCatchUpTicks = 5;
inline constexpr double kOverrunNoticeEveryS = 1.0;

// Snapshots a second that a host may choose: whole numbers of ticks lie between them.
inline constexpr std::array kSnapshotRatesHz{20, 30, 60};
static_assert(std::ranges::all_of(kSnapshotRatesHz,
                                  [](int rate_hz) { return game::kTickRateHz % rate_hz == 0; }));
static_assert(std::ranges::find(kSnapshotRatesHz, game::kSnapshotRateHz) != kSnapshotRatesHz.end());

// ---- one client
// -------------------------------------------------------------------------------------

inline constexpr double kJoinTimeoutS = 10.0;    // from the handshake to a join request
inline constexpr double kLoadTimeoutS = 10.0;    // from a join request to the player's record
inline constexpr double kRefusalLingersS = 1.0;  // so that the reason arrives before the goodbye

// Inputs that wait for their tick: 8 ticks, 133 ms of jitter.
inline constexpr std::size_t kMaxQueuedInputs = 8;
// An input further ahead than this is not one a client can have come to: a minute of ticks.
inline constexpr std::uint32_t kMaxInputLead = 60 * game::kTickRateHz;
// When the queue has had inputs to spare for this long, one is skipped to shorten the delay. Long
// enough that a client which sends more slowly to the same end gets there first.
inline constexpr int kInputSlackWindowTicks = 2 * game::kTickRateHz;
// A player from whom nothing comes for this long lets go of the controls.
inline constexpr int kInputSilenceTicks = game::kTickRateHz / 2;
static_assert(kMaxQueuedInputs <= replication::kMaxInputsPerPacket);

// Of snapshots. With the least of it a level of a thousand balls is still sent whole in the time
// for which a snapshot can be led on from.
inline constexpr int kDefaultClientBytesPerS = 128'000;
inline constexpr int kMinClientBytesPerS = 16'000;
inline constexpr int kMaxClientBytesPerS = 100'000'000;

inline constexpr double kInputPacketsPerS = 2.0 * game::kTickRateHz;
inline constexpr double kInputPacketBurst = 60.0;
inline constexpr double kChatLinesPerS = 1.0;
inline constexpr double kChatBurst = 4.0;
inline constexpr double kRequestsPerS = 20.0;  // purchases, ready, and everything else reliable
inline constexpr double kRequestBurst = 40.0;

// Payloads that are not understood, from a peer whose every packet is authenticated: not an
// accident.
inline constexpr int kMaxMalformedPayloads = 8;

// ---- ledger
// -----------------------------------------------------------------------------------------

// Beyond it the game pauses until the store writes again: 25 MB, hours of a busy server's coins.
inline constexpr std::size_t kMaxUnwrittenTransactions = 200'000;
inline constexpr std::size_t kMaxTransactionsPerCommit = 4096;
inline constexpr std::size_t kMaxWaitingAnswers = 4096;
inline constexpr std::size_t kMaxWaitingLoads = 256;

}  // namespace fts::server
