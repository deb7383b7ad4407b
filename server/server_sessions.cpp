#include <algorithm>
#include <cassert>
#include <variant>

#include "common/replication/wire.h"
#include "server/limits.h"
#include "server/plain_text.h"
#include "server/server.h"

namespace fts::server {

namespace {

std::string name_for(const std::string& wanted, const PlayerKey& key) {
    std::string name = plain_line(wanted, game::kMaxNameBytes);
    return name.empty() ? "player " + net::short_name(key).substr(0, 4) : name;
}

}  // namespace

void Server::on(const net::Connected& event, double now_s) {
    Session& session = sessions_[event.id];
    session.id = event.id;
    session.key = event.peer;
    session.address = event.address;
    session.enter(Session::State::kGreeting, now_s);
    log_(LogLevel::kDebug, session.who() + " connected");
}

void Server::on(const net::Disconnected& event, double) {
    Session* session = find(event.id);
    if (!session) return;
    if (session->is_playing()) {
        const std::string detail = event.detail.empty() ? "" : ": " + event.detail;
        log_(LogLevel::kInfo, session->who() + " left arena " + std::to_string(session->arena) +
                                  " (" + std::string(net::name_of(event.reason)) + detail + ")");
    }
    leave_match(*session);
    sessions_.erase(event.id);
}

void Server::on(const net::ReliableMessage& event, double now_s) {
    Session* session = find(event.id);
    if (!session) return;
    if (!session->requests.allow(now_s)) {
        count("request_flood");
        return;
    }
    const auto message = replication::decode_client_message(event.bytes);
    if (!message) {
        count_malformed(*session);
        return;
    }
    std::visit([&](const auto& request) { handle(*session, request, now_s); }, *message);
}

void Server::on(const net::UnreliablePayload& event, double now_s) {
    Session* session = find(event.id);
    if (!session) return;
    if (!session->input_packets.allow(now_s)) {
        count("input_flood");
        return;
    }
    const auto packet = replication::decode_input_packet(event.bytes);
    if (!packet) {
        count_malformed(*session);
        return;
    }
    if (!session->is_playing()) {
        count("input_out_of_place");
        return;
    }
    const std::uint64_t left_out_before = session->inputs.left_out();
    const double ticks_ahead = (clock_.next_tick_s() - now_s) / game::kTickDurationS;
    if (!session->inputs.add(*packet, std::clamp(ticks_ahead, 0.0, 1.0))) {
        count_malformed(*session);
        return;
    }
    if (const std::uint64_t more = session->inputs.left_out() - left_out_before) {
        count("input_excess", more);
    }
    const replication::Tick newest =
        arenas_[static_cast<std::size_t>(session->arena)]->feed.newest_tick();
    session->courier.acknowledge(packet->acked_snapshot_tick, newest);
}

void Server::handle(Session& session, const replication::JoinRequest& request, double now_s) {
    if (session.state != Session::State::kGreeting) {
        count("join_out_of_place");
        return;
    }
    session.name = name_for(request.name, session.key);
    session.wanted_arena = request.arena;
    if (request.arena < -1 || request.arena >= config_.arenas) {
        refuse(session,
               "There is no arena " + std::to_string(request.arena) + "; this server has 0 to " +
                   std::to_string(config_.arenas - 1) + ".",
               now_s);
        return;
    }
    replace_older_sessions(session);
    // The record is to hold what an older session has earned.
    hand_over_transactions();
    const bool reachable = !store_failing_ && !paused_;
    const auto ticket = reachable ? journal_.load(session.key) : std::nullopt;
    if (!ticket) {
        refuse(session, "The server cannot reach its ledger; try again later.", now_s);
        return;
    }
    session.load_ticket = *ticket;
    session.enter(Session::State::kLoading, now_s);
}

void Server::handle(Session& session, const replication::BuyRequest& request, double) {
    using Outcome = replication::PurchaseOutcome;
    if (!session.is_playing()) {
        count("request_out_of_place");
        return;
    }
    const Match& match = arenas_[static_cast<std::size_t>(session.arena)]->match;
    const bool settled = ledger_.is_settled(session.key, request.request_id);
    if (!settled && !match.shop_is_open()) {
        return answer(session.id, request.request_id, Outcome::kShopClosed);
    }
    if (!settled && (store_failing_ || paused_)) {
        return answer(session.id, request.request_id, Outcome::kStoreFailed);
    }
    const Ledger::Purchase purchase =
        ledger_.buy(session.key, request.request_id, request.stat, request.tier);
    switch (purchase.outcome) {
        case BuyOutcome::kBought:
        case BuyOutcome::kAlreadyBought: {
            // Only while the store fails can they become many; who repeats a request then may wait.
            if (purchase.outcome == BuyOutcome::kAlreadyBought &&
                answers_.size() >= kMaxWaitingAnswers) {
                return count("answer_not_kept");
            }
            const Outcome outcome = purchase.outcome == BuyOutcome::kBought
                                        ? Outcome::kBought
                                        : Outcome::kAlreadyBought;
            answers_.push_back({purchase.sequence, session.id, session.player,
                                replication::PurchaseResult{request.request_id, outcome}});
            return;
        }
        case BuyOutcome::kTooExpensive:
            return answer(session.id, request.request_id, Outcome::kTooExpensive);
        case BuyOutcome::kLastTier:
            return answer(session.id, request.request_id, Outcome::kLastTier);
        case BuyOutcome::kStalePrice:
            return answer(session.id, request.request_id, Outcome::kStalePrice);
    }
}

void Server::handle(Session& session, const replication::ChatRequest& request, double now_s) {
    if (!session.is_playing()) {
        count("request_out_of_place");
        return;
    }
    if (!session.chat_lines.allow(now_s)) {
        count("chat_flood");
        send(session.id, replication::ChatLine{0, "You are writing too fast; that was not sent."});
        return;
    }
    const std::string text = plain_line(request.text, game::kMaxChatBytes);
    if (text.empty()) return;
    arenas_[static_cast<std::size_t>(session.arena)]->match.chat(session.player, text);
}

void Server::handle(Session& session, const replication::ReadyRequest&, double) {
    if (!session.is_playing()) {
        count("request_out_of_place");
        return;
    }
    arenas_[static_cast<std::size_t>(session.arena)]->match.set_ready(session.player);
}

void Server::replace_older_sessions(const Session& newer) {
    std::vector<net::ConnectionId> older;
    for (const auto& [id, session] : sessions_) {
        if (id != newer.id && session.key == newer.key) older.push_back(id);
    }
    for (const net::ConnectionId id : older) {
        kick(id, net::DisconnectReason::kKicked, "the same player joined again from elsewhere");
    }
}

void Server::admit(Session& session, const PlayerRecord& record, double now_s) {
    const std::optional<int> place = arena_with_room(session.wanted_arena);
    if (!place) {
        refuse(session,
               session.wanted_arena < 0
                   ? "The server is full; try again later."
                   : "Arena " + std::to_string(session.wanted_arena) + " is full; try another one.",
               now_s);
        return;
    }
    Arena& arena = *arenas_[static_cast<std::size_t>(*place)];
    ledger_.load(record);
    const std::optional<PlayerId> player = arena.match.join(session.key, session.name);
    assert(player);
    session.arena = *place;
    session.player = *player;
    session.courier = SnapshotCourier(config_.client_bytes_per_s);
    session.enter(Session::State::kPlaying, now_s);
    arena.players[*player] = &session;
    if (record.name != session.name) renames_.push_back({session.key, session.name});
    ++joins_;
    log_(LogLevel::kInfo, session.who() + " joined arena " + std::to_string(*place) + " with " +
                              std::to_string(record.coins) + " coins");

    send(session.id, replication::Welcome{*player, *place, game::kTickRateHz,
                                          config_.snapshot_rate_hz, config_.name});
    for (const replication::ServerMessage& message : arena.match.briefing(*player)) {
        send(session.id, message);
    }
}

// The fullest arena that still has room, so that people meet.
std::optional<int> Server::arena_with_room(int wanted) const {
    std::optional<int> best;
    for (int i = 0; i < config_.arenas; ++i) {
        const Match& match = arenas_[static_cast<std::size_t>(i)]->match;
        if (!match.has_room() || (wanted >= 0 && i != wanted)) continue;
        if (!best ||
            match.player_count() > arenas_[static_cast<std::size_t>(*best)]->match.player_count()) {
            best = i;
        }
    }
    return best;
}

void Server::refuse(Session& session, const std::string& reason, double now_s) {
    log_(LogLevel::kInfo, session.who() + " was not admitted: " + reason);
    count("join_refused");
    session.enter(Session::State::kRefused, now_s);
    send(session.id, replication::JoinRefused{reason});
}

void Server::count_malformed(Session& session) {
    count("malformed_payload");
    if (++session.malformed_payloads < kMaxMalformedPayloads) return;
    kick(session.id, net::DisconnectReason::kKicked,
         "sent " + std::to_string(kMaxMalformedPayloads) + " packets that made no sense");
}

void Server::leave_match(Session& session) {
    if (!session.is_playing()) return;
    Arena& arena = *arenas_[static_cast<std::size_t>(session.arena)];
    arena.match.leave(session.player);
    arena.players.erase(session.player);
    ledger_.unload(session.key);
    session.state = Session::State::kRefused;
}

void Server::kick(net::ConnectionId id, net::DisconnectReason reason, const std::string& detail) {
    Session* session = find(id);
    if (!session) return;
    if (session->is_playing()) {
        count("kicked");
        log_(LogLevel::kInfo, session->who() + " was disconnected: " + detail);
    }
    leave_match(*session);
    listener_.disconnect(id, reason, detail);
    sessions_.erase(id);
}

}  // namespace fts::server
