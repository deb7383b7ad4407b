#include "client/core/session.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "client/core/arena_mirror.h"
#include "client/core/end_words.h"
#include "client/core/input_pacer.h"
#include "client/core/input_queue.h"
#include "client/core/own_ball_prediction.h"
#include "client/core/server_clock.h"
#include "common/game/rules.h"
#include "common/replication/snapshot_receiver.h"
#include "common/replication/wire.h"

namespace fts::client {
namespace {

using replication::Snapshot;

// Rates that a server may announce; anything else is a broken one.
constexpr int kMaxRateHz = 1000;
// Share that one snapshot has in the running loss: a memory of about two seconds at 30 Hz.
constexpr double kLossShare = 1.0 / 60.0;
// What is found on looking came at some moment since the last look, on average half way. A longer
// pause than this is our own and says nothing of when it came.
constexpr double kLongestLookS = 1.0 / 30.0;

// Unique among all purchases of a player for ever, without a memory of earlier ones.
std::uint64_t random_request_id() {
    std::random_device entropy;
    const std::uint64_t high = entropy(), low = entropy();
    return ((high << 32U) | low) >> 1U | 1U;
}

std::optional<Notice::Kind> notice_kind_of(const replication::ServerMessage& message) {
    using Kind = Notice::Kind;
    if (std::holds_alternative<replication::LevelStarted>(message)) return Kind::kLevelStarted;
    if (std::holds_alternative<replication::LevelEnded>(message)) return Kind::kLevelEnded;
    if (std::holds_alternative<replication::KnockOff>(message)) return Kind::kKnockOff;
    if (std::holds_alternative<replication::PurchaseResult>(message)) return Kind::kPurchase;
    if (std::holds_alternative<replication::ChatLine>(message)) return Kind::kChat;
    if (std::holds_alternative<replication::CollisionReport>(message)) return Kind::kOwnHit;
    return std::nullopt;
}

}  // namespace

struct Session::Impl {
    Impl(const SessionConfig& session_config, net::Transport& session_transport)
        : config(session_config),
          transport(session_transport),
          dialer({config.key, config.server, config.protocol_version, config.pinned_server_key},
                 transport),
          receiver(config.replays ? config.replays
                                  : std::make_shared<replication::SharedReplay>()) {}

    void look(double now_s);
    void receive_datagrams(double now_s);
    void handle(const net::Event& event, double now_s);
    void handle_message(const std::vector<std::uint8_t>& bytes, double now_s);
    void handle_snapshot_part(const std::vector<std::uint8_t>& bytes, double now_s);
    void take_input_timing(const replication::SnapshotPacket& packet, double now_s);
    void take_snapshot(replication::SnapshotReceiver::Received received);
    replication::Tick whole_ticks_per_snapshot() const;
    void predict(View& view, double now_s);
    LinkView count_frame(double drawn_s, double now_s);
    void count_missed_before(replication::Tick tick);
    void welcome(const replication::Welcome& message, double now_s);
    void send_due_inputs(double now_s);
    void send(const replication::ClientMessage& message);
    void notice(Notice::Kind kind, const replication::ServerMessage& message);
    void end(const net::Disconnected& what);

    SessionConfig config;
    net::Transport& transport;
    net::Dialer dialer;
    Status status = Status::kConnecting;
    std::string ended_because;
    net::DisconnectReason end_reason = net::DisconnectReason::kClosed;
    std::optional<net::PublicKey> server_key;

    replication::SnapshotReceiver receiver;
    ArenaMirror arena;
    ServerClock clock;
    const replication::SnapshotReceiver::CourseOf courses = [this](int level) {
        return arena.course_of(level);
    };
    replication::Tick heard_tick = 0;
    std::uint32_t acked_input = 0;           // by the packet that came last
    double looked_s = 0.0, arrival_s = 0.0;  // last, and what that makes of what has now come
    double ticks_per_snapshot = double(game::kTickRateHz) / game::kSnapshotRateHz;

    InputQueue inputs;
    InputPacer pacer;
    game::InputCommand held_input;
    OwnBallPrediction prediction;
    bool shows_prediction = true;
    double input_slack_s = 0.0;
    std::uint64_t next_request_id = random_request_id();

    std::deque<Notice> notices;
    double recent_loss = 0.0;
    SessionStats stats;
};

void Session::Impl::look(double now_s) {
    const double since_s = std::max(looked_s, now_s - kLongestLookS);
    arrival_s = std::max(arrival_s, 0.5 * (since_s + now_s));
    looked_s = now_s;
}

void Session::Impl::receive_datagrams(double now_s) {
    transport.poll(now_s, [&](const net::Address& from, std::span<const std::uint8_t> datagram) {
        if (status != Status::kEnded) dialer.receive(from, datagram, now_s);
    });
}

void Session::Impl::handle(const net::Event& event, double now_s) {
    if (status == Status::kEnded) return;
    if (const auto* connected = std::get_if<net::Connected>(&event)) {
        server_key = connected->peer;
        status = Status::kJoining;
        send(replication::JoinRequest{config.name, config.arena});
    } else if (const auto* gone = std::get_if<net::Disconnected>(&event)) {
        end(*gone);
    } else if (const auto* message = std::get_if<net::ReliableMessage>(&event)) {
        handle_message(message->bytes, now_s);
    } else if (const auto* payload = std::get_if<net::UnreliablePayload>(&event)) {
        handle_snapshot_part(payload->bytes, now_s);
    }
}

void Session::Impl::handle_message(const std::vector<std::uint8_t>& bytes, double now_s) {
    const auto message = replication::decode_server_message(bytes);
    if (!message) {
        ++stats.messages_malformed;
        return;
    }
    if (const auto* refused = std::get_if<replication::JoinRefused>(&*message)) {
        dialer.close("not let in");
        end({0, net::DisconnectReason::kRefused, refused->reason});
        return;
    }
    if (const auto* hello = std::get_if<replication::Welcome>(&*message)) {
        welcome(*hello, now_s);
        return;
    }
    if (const auto* part = std::get_if<replication::KeyframePart>(&*message)) {
        take_snapshot(receiver.receive(*part, whole_ticks_per_snapshot(), courses));
        return;
    }
    arena.apply(*message);
    if (const auto kind = notice_kind_of(*message)) notice(*kind, *message);
}

void Session::Impl::welcome(const replication::Welcome& message, double now_s) {
    const auto plausible = [](int rate_hz) { return rate_hz > 0 && rate_hz <= kMaxRateHz; };
    if (!plausible(message.tick_rate_hz) || !plausible(message.snapshot_rate_hz)) {
        const std::string detail = "tick rate " + std::to_string(message.tick_rate_hz) +
                                   " Hz, snapshot rate " +
                                   std::to_string(message.snapshot_rate_hz) + " Hz";
        dialer.close(detail);
        end({0, net::DisconnectReason::kProtocolError, detail});
        return;
    }
    arena.apply(message);
    ticks_per_snapshot = double(message.tick_rate_hz) / message.snapshot_rate_hz;
    if (status == Status::kJoining) {
        status = Status::kPlaying;
        pacer.start(now_s);
    }
}

void Session::Impl::handle_snapshot_part(const std::vector<std::uint8_t>& bytes, double now_s) {
    const auto packet = replication::decode_snapshot_packet(bytes);
    if (!packet) {
        ++stats.snapshots_malformed;
        return;
    }
    inputs.acknowledge(packet->acked_input_sequence);
    const replication::Tick tick = replication::tick_of(*packet);
    const bool tells_of_now = packet->kind != replication::SnapshotPacket::Kind::kEarlierEvents;
    if (tells_of_now && tick != heard_tick) {
        clock.hear(double(tick) / arena.tick_rate_hz(), arrival_s);
        if (tick > heard_tick) take_input_timing(*packet, now_s);
        heard_tick = tick;
    }
    acked_input = packet->acked_input_sequence;
    take_snapshot(receiver.receive(*packet, whole_ticks_per_snapshot(), courses));
}

replication::Tick Session::Impl::whole_ticks_per_snapshot() const {
    return static_cast<replication::Tick>(std::max(1LL, std::llround(ticks_per_snapshot)));
}

void Session::Impl::take_input_timing(const replication::SnapshotPacket& packet, double now_s) {
    if (packet.acked_input_sequence == 0) return;
    input_slack_s = 0.0;
    if (packet.input_slack == replication::kNoInputWaited) {
        ++stats.inputs_late;
        return;
    }
    input_slack_s = packet.input_slack * replication::kInputSlackStepTicks / arena.tick_rate_hz();
    pacer.observe(packet.acked_input_sequence, input_slack_s, now_s);
}

void Session::Impl::count_missed_before(replication::Tick tick) {
    if (!arena.has_snapshot()) return;
    const double intervals = (tick - arena.newest_tick()) / ticks_per_snapshot;
    const auto missed = std::max<std::int64_t>(0, std::llround(intervals) - 1);
    stats.snapshots_missed += static_cast<std::uint64_t>(missed);
    const double kept = std::pow(1.0 - kLossShare, static_cast<double>(missed));
    recent_loss = (1.0 - (1.0 - recent_loss) * kept) * (1.0 - kLossShare);
}

// What is older than what is shown already is only held, to go on from.
void Session::Impl::take_snapshot(replication::SnapshotReceiver::Received received) {
    if (!received.snapshot) return;
    const Snapshot& snapshot = *received.snapshot;
    if (arena.has_snapshot() && snapshot.tick <= arena.newest_tick()) return;
    count_missed_before(snapshot.tick);
    ++(received.exact ? stats.snapshots_received : stats.snapshots_sketched);
    if (snapshot.tick == heard_tick) {
        clock.observe(double(snapshot.tick) / arena.tick_rate_hz(), arrival_s);
    }
    const auto course = config.predicts_own_ball ? arena.course_of(snapshot.level) : std::nullopt;
    if (course) prediction.rebase(*course, snapshot, arena.own_player_id(), acked_input);
    std::erase_if(received.controls,
                  [&](const auto& event) { return event.tick <= arena.newest_tick(); });
    arena.add(std::move(received.snapshot), std::move(received.controls));
}

void Session::Impl::send_due_inputs(double now_s) {
    if (status != Status::kPlaying) return;
    const InputPacer::Due due = pacer.due(now_s, 1.0 / arena.tick_rate_hz());
    if (due.inputs == 0) return;
    stats.inputs_skipped += due.skipped;
    for (int i = 0; i < due.inputs; ++i) {
        inputs.push(held_input);
        ++stats.inputs_sent;
        if (!config.predicts_own_ball) continue;
        prediction.push(held_input, game::stats_for(arena.tiers()), arena.tick_rate_hz(), now_s);
    }
    dialer.send_unreliable(replication::encode(inputs.packet(receiver.held_tick())));
}

void Session::Impl::send(const replication::ClientMessage& message) {
    if (!dialer.send_reliable(replication::encode(message))) ++stats.messages_unsent;
}

void Session::Impl::notice(Notice::Kind kind, const replication::ServerMessage& message) {
    if (notices.size() == kMaxPendingNotices) {
        notices.pop_front();
        ++stats.notices_dropped;
    }
    notices.push_back({kind, message});
    if (auto* line = std::get_if<replication::ChatLine>(&notices.back().message)) {
        line->text = printable(line->text, game::kMaxChatBytes);
    }
}

void Session::Impl::end(const net::Disconnected& what) {
    status = Status::kEnded;
    end_reason = what.reason;
    ended_because = words_for(what, config.server, config.protocol_version, net::kDefaultTimeoutS);
}

Session::Session(const SessionConfig& config, net::Transport& transport)
    : impl_(std::make_unique<Impl>(config, transport)) {}
Session::~Session() = default;

void Session::update(double now_s) {
    impl_->look(now_s);
    impl_->receive_datagrams(now_s);
    if (impl_->status == Status::kEnded) return;
    impl_->dialer.update(now_s);
    for (const net::Event& event : impl_->dialer.drain_events()) impl_->handle(event, now_s);
    impl_->send_due_inputs(now_s);
    impl_->transport.flush();
}

void Session::show_prediction(bool shown) {
    impl_->shows_prediction = shown;
}

void Session::set_input(const game::InputCommand& input) {
    impl_->held_input = input;
}

std::uint64_t Session::buy(game::Stat stat) {
    const std::uint64_t id = impl_->next_request_id++;
    if (impl_->status == Status::kPlaying) {
        const int tier = impl_->arena.tiers()[static_cast<std::size_t>(stat)];
        impl_->send(replication::BuyRequest{id, stat, tier});
    }
    return id;
}

void Session::chat(const std::string& text) {
    if (impl_->status == Status::kPlaying) impl_->send(replication::ChatRequest{text});
}

void Session::ready() {
    if (impl_->status == Status::kPlaying) impl_->send(replication::ReadyRequest{});
}

void Session::leave(double now_s) {
    if (impl_->status == Status::kEnded) return;
    impl_->dialer.close("left");
    // Lets a transport that holds datagrams back move the goodbye on.
    impl_->receive_datagrams(now_s);
    impl_->status = Status::kEnded;
    impl_->end_reason = net::DisconnectReason::kClosed;
    impl_->ended_because = "You left " + net::to_string(impl_->config.server) + ".";
}

Status Session::status() const {
    return impl_->status;
}
const std::string& Session::ended_because() const {
    return impl_->ended_because;
}
net::DisconnectReason Session::end_reason() const {
    return impl_->end_reason;
}
std::optional<net::PublicKey> Session::server_key() const {
    return impl_->server_key;
}

void Session::Impl::predict(View& view, double now_s) {
    if (!config.predicts_own_ball) return;
    const auto pose = prediction.pose(now_s);
    if (!pose || !view.own_ball || !shows_prediction) return;
    BallView& own = view.balls[*view.own_ball];
    view.own_by_server_m = own.position_m;
    own.position_m = pose->position_m;
    own.velocity_mps = pose->velocity_mps;
    own.thrust = game::thrust_of(held_input);
    own.braking = held_input.brake;
}

LinkView Session::Impl::count_frame(double drawn_s, double now_s) {
    const bool drawing = clock.started();
    const net::LinkStats net_link = dialer.stats();
    LinkView link;
    link.rtt_s = net_link.rtt_s;
    link.loss = std::max(net_link.loss, recent_loss);
    link.interpolation_delay_s = drawing ? std::max(0.0, clock.delay_s(now_s)) : 0.0;
    link.input_slack_s = input_slack_s;
    link.starved = drawing && drawn_s * arena.tick_rate_hz() > arena.newest_tick();
    if (drawing && status == Status::kPlaying) {
        ++stats.frames;
        if (link.starved) ++stats.frames_starved;
    }
    return link;
}

View Session::view(double now_s) {
    Impl& self = *impl_;
    const double drawn_s = self.clock.started() ? self.clock.draw_time_s(now_s) : 0.0;
    View view = self.arena.view_at(drawn_s);
    self.predict(view, now_s);
    view.link = self.count_frame(drawn_s, now_s);
    return view;
}

Glance Session::glance(double now_s) {
    Impl& self = *impl_;
    const double drawn_s = self.clock.started() ? self.clock.draw_time_s(now_s) : 0.0;
    Glance glance = self.arena.glance_at(drawn_s);
    glance.link = self.count_frame(drawn_s, now_s);
    if (glance.newest) {
        const double newest_s = double(glance.newest->tick) / self.arena.tick_rate_hz();
        glance.age_s = std::max(0.0, self.clock.estimate_s(now_s) - newest_s);
    }
    return glance;
}

std::vector<Notice> Session::drain_notices() {
    std::vector<Notice> drained(impl_->notices.begin(), impl_->notices.end());
    impl_->notices.clear();
    return drained;
}

SessionStats Session::stats() const {
    SessionStats stats = impl_->stats;
    const replication::SnapshotReceiver::Counts counts = impl_->receiver.counts();
    stats.snapshots_late = counts.late;
    stats.snapshots_malformed += counts.malformed;
    stats.snapshots_unlike = counts.unlike;
    stats.inputs_given_up = impl_->inputs.given_up_count();
    stats.hits_dropped = impl_->arena.hits_dropped_count();
    stats.delay_limited = impl_->clock.delay_limited_count();
    stats.clock_steps = impl_->clock.step_count();
    stats.link = impl_->dialer.stats();
    return stats;
}

}  // namespace fts::client
