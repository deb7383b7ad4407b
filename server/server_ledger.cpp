#include <utility>

#include "server/server.h"

namespace fts::server {

void Server::hand_over_transactions() {
    set_paused(!journal_.has_room());
    if (paused_) return;
    journal_.commit(ledger_.drain_transactions(), std::exchange(renames_, {}));
}

void Server::set_paused(bool paused) {
    if (paused == paused_) return;
    paused_ = paused;
    const std::string line =
        paused ? "Too many coins wait to be written down: the game is paused until the server's "
                 "ledger can be written again."
               : "The ledger is written again: the game goes on.";
    log_(paused ? LogLevel::kError : LogLevel::kInfo, line);
    for (const auto& [id, session] : sessions_) {
        if (session.is_playing()) send(id, replication::ChatLine{0, line});
    }
}

void Server::admit_loaded(const std::vector<Journal::Loaded>& loaded, double now_s) {
    for (const Journal::Loaded& result : loaded) {
        Session* session = find_ticket(result.ticket);
        if (!result.record) {
            log_(LogLevel::kError, "a player's record could not be read: " + result.error);
        }
        if (!session) continue;  // left while waiting
        if (result.record) {
            admit(*session, *result.record, now_s);
        } else {
            refuse(*session, "The server cannot read your record; tell its host.", now_s);
        }
    }
}

void Server::answer_purchases() {
    while (!answers_.empty() && answers_.front().sequence <= committed_up_to_) {
        const Answer done = answers_.front();
        answers_.pop_front();
        Session* session = find(done.connection);
        if (!session) continue;  // asks again after coming back
        if (session->is_playing()) {
            arenas_[static_cast<std::size_t>(session->arena)]->match.upgrades_changed(done.player);
        }
        log_(LogLevel::kDebug, session->who() + "'s purchase is written down, request " +
                                   std::to_string(done.result.request_id));
        answer(done.connection, done.result.request_id, done.result.outcome);
    }
}

void Server::answer(net::ConnectionId connection, std::uint64_t request_id,
                    replication::PurchaseOutcome outcome) {
    send(connection, replication::PurchaseResult{request_id, outcome});
}

void Server::note_journal_health(const Journal::State& state) {
    if (state.failing && !store_failing_) {
        log_(LogLevel::kError, "the ledger cannot be written (" + state.error +
                                   "); nothing is lost yet, it is tried again, and nobody can buy "
                                   "or join meanwhile");
    } else if (!state.failing && store_failing_) {
        log_(LogLevel::kInfo, "the ledger is written again");
    }
    store_failing_ = state.failing;
}

}  // namespace fts::server
