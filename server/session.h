// Session: what the server knows of one connected client.
//
//   kGreeting --JoinRequest--> kLoading --record loaded--> kPlaying
//       |                         |
//       +-------refused-----------+----> kRefused, gone after kRefusalLingersS
//
// A session is gone when the connection is. It holds no coin and no ball: those are the ledger's
// and the match's.
#pragma once

#include <cstdint>
#include <string>

#include "common/net/connection.h"
#include "server/input_queue.h"
#include "server/limits.h"
#include "server/match/match.h"
#include "server/rate_limit.h"
#include "server/snapshot_courier.h"

namespace fts::server {

struct Session {
    enum class State : std::uint8_t { kGreeting, kLoading, kPlaying, kRefused };

    net::ConnectionId id = 0;
    PlayerKey key{};
    net::Address address;

    State state = State::kGreeting;
    double state_since_s = 0.0;
    int malformed_payloads = 0;

    // From the join request on.
    std::string name;
    int wanted_arena = -1;          // -1: wherever there is room
    std::uint64_t load_ticket = 0;  // of the journal, in kLoading

    // In kPlaying.
    int arena = 0;
    PlayerId player = 0;
    InputQueue inputs;
    SnapshotCourier courier{kDefaultClientBytesPerS};

    RateLimit input_packets{kInputPacketsPerS, kInputPacketBurst};
    RateLimit chat_lines{kChatLinesPerS, kChatBurst};
    RateLimit requests{kRequestsPerS, kRequestBurst};

    void enter(State next, double now_s) {
        state = next;
        state_since_s = now_s;
    }
    bool is_playing() const { return state == State::kPlaying; }
    // For the log.
    std::string who() const;
};

}  // namespace fts::server
