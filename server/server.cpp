#include "server/server.h"

#include <algorithm>
#include <cassert>
#include <utility>
#include <variant>

#include "common/replication/wire.h"
#include "server/limits.h"
#include "server/match/level_plan.h"

namespace fts::server {

namespace {

net::ListenerConfig listener_config(const ServerConfig& config) {
    net::ListenerConfig listener;
    listener.key = config.key;
    listener.max_connections =
        static_cast<std::size_t>(config.arenas * config.players_per_arena) + kSpareConnections;
    return listener;
}

// Lets the ledger take over what the store holds, before a thread takes over the store.
std::unique_ptr<Store> opened(Ledger& ledger, std::unique_ptr<Store> store) {
    ledger.open(store->totals_at_open());
    return store;
}

}  // namespace

Server::Server(const ServerConfig& config, net::Transport& transport, std::unique_ptr<Store> store,
               Log log)
    : config_(config),
      log_(std::move(log)),
      journal_(opened(ledger_, std::move(store)), config.journal),
      listener_(listener_config(config), transport),
      transport_(transport),
      stages_(config.stage_clock) {
    assert(!config.levels.empty());
    assert(config.arenas >= 1 && config.arenas <= kMaxArenas);
    assert(config.players_per_arena >= 1 && config.players_per_arena <= game::kMaxPlayersPerArena);
    assert(std::ranges::find(kSnapshotRatesHz, config.snapshot_rate_hz) != kSnapshotRatesHz.end());
    const std::vector<physics::Plan> plans =
        plan_levels(config.levels, config.players_per_arena, config.tolerance);
    for (const std::string& line : describe_levels(plans)) log_(LogLevel::kInfo, line);
    MatchConfig match;
    for (const physics::Plan& plan : plans) match.solvers.push_back(plan.solver);
    match.snapshot_ticks =
        static_cast<replication::Tick>(game::kTickRateHz / config.snapshot_rate_hz);
    for (int i = 0; i < config.arenas; ++i) {
        match.arena = i;
        match.seed = config.seed + static_cast<std::uint64_t>(i);
        match.levels = config.levels;
        match.max_players = config.players_per_arena;
        arenas_.push_back(std::make_unique<Arena>(match, ledger_));
    }
}

Server::~Server() = default;

int Server::tick(double now_s) {
    stages_.enter(Stage::kReceive);
    receive(now_s);
    const int due = clock_.due(now_s);
    if (due == 0) {
        transport_.flush();
        stages_.leave();
        return 0;
    }

    for (int i = 0; i < due && !paused_; ++i) play_one_tick();
    stages_.enter(Stage::kLedger);
    settle_ledger(now_s);
    stages_.enter(Stage::kUpkeep);
    end_overdue_sessions(now_s);
    listener_.update(now_s);
    stages_.enter(Stage::kSend);
    transport_.flush();
    stages_.end_tick();
    say_what_is_wrong(now_s);
    return due;
}

void Server::receive(double now_s) {
    transport_.poll(now_s, [&](const net::Address& from, std::span<const std::uint8_t> datagram) {
        listener_.receive(from, datagram, now_s);
    });
    for (const net::Event& event : listener_.drain_events()) {
        std::visit([&](const auto& happened) { on(happened, now_s); }, event);
    }
}

void Server::play_one_tick() {
    ++ticks_;
    player_ticks_ += player_count();
    for (const auto& arena : arenas_) {
        stages_.enter(Stage::kInputs);
        apply_inputs(*arena);
        stages_.enter(Stage::kMatch);
        if (arena->match.tick().overrun) ++world_overruns_;
        stages_.enter(Stage::kMessages);
        deliver(*arena);
    }
    // Arenas take turns, so that the work of encoding spreads over the ticks.
    for (const auto& arena : arenas_) {
        if (arena->match.snapshot_is_due()) publish_snapshot(*arena);
    }
}

void Server::apply_inputs(Arena& arena) {
    for (const auto& [player, session] : arena.players) {
        arena.match.set_input(player, session->inputs.next());
    }
}

void Server::deliver(Arena& arena) {
    std::vector<std::pair<net::ConnectionId, std::string>> broken;
    const auto pass_on = [&](net::ConnectionId id, std::span<const std::uint8_t> bytes) {
        if (!send_encoded(id, bytes)) broken.emplace_back(id, "cannot keep up with the game");
    };
    for (const Outgoing& outgoing : arena.match.drain_outgoing()) {
        note_level(arena, outgoing);
        const std::vector<std::uint8_t> bytes = replication::encode(outgoing.message);
        if (!outgoing.to) {
            for (const auto& [player, session] : arena.players) pass_on(session->id, bytes);
        } else if (const auto found = arena.players.find(*outgoing.to);
                   found != arena.players.end()) {
            pass_on(found->second->id, bytes);
        }
    }
    // What is reliable must not have gaps: who cannot take a message is told to come again.
    for (const auto& [id, detail] : broken) kick(id, net::DisconnectReason::kKicked, detail);
}

void Server::note_level(const Arena& arena, const Outgoing& outgoing) {
    const auto* level = std::get_if<replication::LevelStarted>(&outgoing.message);
    if (!level || outgoing.to) return;
    log_(LogLevel::kInfo, "arena " + std::to_string(arena.number) + " begins level " +
                              std::to_string(level->number) + " (" + level->name +
                              "), players: " + std::to_string(arena.players.size()));
}

void Server::publish_snapshot(Arena& arena) {
    if (arena.players.empty()) return;
    stages_.enter(Stage::kSnapshots);
    replication::Snapshot snapshot = arena.match.snapshot();
    arena.match.clear_hits();
    if (snapshot.tick <= arena.feed.newest_tick()) return;
    arena.feed.publish(std::move(snapshot));
    for (const auto& [player, session] : arena.players) send_snapshot(arena, *session);
    stages_.enter(Stage::kSend);
    transport_.flush();
}

// Between the courier of one client and its connection.
class Server::SnapshotLink final : public SnapshotCourier::Link {
  public:
    SnapshotLink(Server& server, Session& session)
        : server_(server), session_(session), input_slack_(session.inputs.take_slack()) {}

    void send(replication::SnapshotPacket::Kind kind, std::span<const std::uint8_t> part) override {
        server_.stages_.enter(Stage::kSeal);
        const auto bytes = replication::encode(replication::SnapshotPacket{
            session_.inputs.applied_sequence(), input_slack_, kind, {part.begin(), part.end()}});
        if (!server_.listener_.send_unreliable(session_.id, bytes)) {
            server_.count("snapshot_not_sent");
        }
        server_.stages_.enter(Stage::kSnapshots);
    }
    bool send_reliable(std::span<const std::uint8_t> message) override {
        return server_.listener_.send_reliable(session_.id, message);
    }

  private:
    Server& server_;
    const Session& session_;
    const std::uint8_t input_slack_;
};

void Server::send_snapshot(Arena& arena, Session& session) {
    stages_.enter(Stage::kSnapshots);
    SnapshotLink link(*this, session);
    const SnapshotCourier::Sent sent =
        session.courier.deliver(arena.feed, arena.match.events(), session.player, link);
    if (sent.over_budget) count("snapshot_over_budget");
    if (sent.keyframe_given_up) count("keyframe_given_up");
}

void Server::settle_ledger(double now_s) {
    hand_over_transactions();
    const Journal::State state = journal_.drain();
    committed_up_to_ = state.committed_up_to;
    store_failures_ = state.failures;
    note_journal_health(state);
    admit_loaded(state.loaded, now_s);
    answer_purchases();
}

void Server::end_overdue_sessions(double now_s) {
    std::vector<net::ConnectionId> overdue;
    for (auto& [id, session] : sessions_) {
        const double age_s = now_s - session.state_since_s;
        switch (session.state) {
            case Session::State::kGreeting:
                if (age_s > kJoinTimeoutS) overdue.push_back(id);
                break;
            case Session::State::kLoading:
                if (age_s > kLoadTimeoutS) {
                    refuse(session, "The server cannot reach its ledger; try again later.", now_s);
                }
                break;
            case Session::State::kRefused:
                if (age_s > kRefusalLingersS) overdue.push_back(id);
                break;
            case Session::State::kPlaying:
                break;
        }
    }
    for (const net::ConnectionId id : overdue) {
        const bool refused = sessions_.at(id).state == Session::State::kRefused;
        if (!refused) count("never_joined");
        kick(id, refused ? net::DisconnectReason::kRefused : net::DisconnectReason::kKicked,
             refused ? "not admitted" : "did not ask to join");
    }
}

void Server::say_what_is_wrong(double now_s) {
    if (const auto dropped = clock_.overrun_notice(now_s)) {
        log_(LogLevel::kWarning,
             "came too late for " + std::to_string(*dropped) +
                 " ticks, which were dropped; this machine is too slow or busy");
    }
    const bool too_soon = last_world_overrun_notice_s_ &&
                          now_s < *last_world_overrun_notice_s_ + kOverrunNoticeEveryS;
    if (world_overruns_ != world_overruns_noticed_ && !too_soon) {
        log_(LogLevel::kWarning, "the event budget ran out in " +
                                     std::to_string(world_overruns_ - world_overruns_noticed_) +
                                     " ticks of play");
        world_overruns_noticed_ = world_overruns_;
        last_world_overrun_notice_s_ = now_s;
    }
    // Once: strangers choose what they send.
    const auto foreign_version = listener_.last_foreign_version();
    if (foreign_version && !has_noticed_foreign_version_) {
        log_(LogLevel::kWarning,
             "refused a client of protocol version " + std::to_string(*foreign_version) +
                 ", where this server speaks version " + std::to_string(net::kProtocolVersion) +
                 "; update the older one");
        has_noticed_foreign_version_ = true;
    }
}

std::size_t Server::player_count() const {
    std::size_t players = 0;
    for (const auto& arena : arenas_) players += arena->players.size();
    return players;
}

void Server::shut_down(double now_s, std::string_view goodbye) {
    if (!admitting_) return;
    admitting_ = false;
    for (auto& [id, session] : sessions_) leave_match(session);
    for (int arena = 0; arena < config_.arenas; ++arena) ledger_.sweep_field(arena);
    journal_.commit(ledger_.drain_transactions(), std::exchange(renames_, {}));
    unwritten_ = journal_.finish() + ledger_.pending_count();
    committed_up_to_ = journal_.drain().committed_up_to;
    answer_purchases();
    listener_.update(now_s);  // the answers leave before the goodbye
    listener_.close(goodbye);
    listener_.update(now_s);
    transport_.flush();
    sessions_.clear();
}

ServerReport Server::report() const {
    ServerReport report;
    for (std::size_t i = 0; i < arenas_.size(); ++i) {
        const Match& match = arenas_[i]->match;
        report.arenas.push_back({static_cast<int>(i), match.level_number(), match.scoreboard(),
                                 match.totals(), match.audit()});
    }
    report.coins = ledger_.totals();
    report.ticks = ticks_;
    report.clock_overruns = clock_.overruns();
    report.dropped_ticks = clock_.dropped_ticks();
    report.late_ticks = clock_.late_ticks();
    report.player_ticks = player_ticks_;
    report.stages = stages_.histograms();
    report.joins = joins_;
    report.store_failures = store_failures_;
    report.unwritten_transactions = unwritten_;
    for (const auto& [what, times] : drops_) report.drops[std::string(what)] += times;
    for (const auto& [what, times] : listener_.drops()) report.drops[std::string(what)] += times;
    for (const auto& [what, times] : transport_.drops()) report.drops[std::string(what)] += times;
    return report;
}

Session* Server::find(net::ConnectionId id) {
    const auto found = sessions_.find(id);
    return found == sessions_.end() ? nullptr : &found->second;
}

Session* Server::find_ticket(std::uint64_t ticket) {
    for (auto& [id, session] : sessions_) {
        if (session.state == Session::State::kLoading && session.load_ticket == ticket) {
            return &session;
        }
    }
    return nullptr;
}

bool Server::send(net::ConnectionId id, const replication::ServerMessage& message) {
    return send_encoded(id, replication::encode(message));
}

bool Server::send_encoded(net::ConnectionId id, std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) {  // nothing that the other end would take (wire.h)
        count("message_not_encodable");
        return true;
    }
    if (listener_.send_reliable(id, bytes)) return true;
    count("message_not_sent");
    return false;
}

}  // namespace fts::server
