#include "common/replication/wire.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include "arena.pb.h"
#include "common/replication/delta.h"
#include "common/replication/utf8.h"

namespace fts::replication {
namespace {

namespace pb = fts::arena;

constexpr std::uint32_t kMaxId = std::numeric_limits<std::uint16_t>::max();
constexpr std::uint32_t kMaxArena = std::numeric_limits<std::uint8_t>::max();
constexpr std::uint32_t kMaxInt = std::numeric_limits<int>::max();
constexpr std::uint32_t kMaxRateHz = 1000;
constexpr double kUnitTolerance = 1e-6;

// ---- values to Protobuf
// ----------------------------------------------------------------------------

// A negative number becomes one that the range checks of decoding refuse.
std::uint32_t number(int value) {
    return static_cast<std::uint32_t>(value);
}

// Protobuf enums leave 0 for "not said".
template <typename Proto, typename Enum>
Proto shifted(Enum value) {
    return static_cast<Proto>(static_cast<int>(value) + 1);
}

void put(const physics::Vec2d& vector, pb::Vector& out) {
    out.set_x(vector.x());
    out.set_y(vector.y());
}

void put(const physics::Disc& disc, pb::Platform& out) {
    out.mutable_disc()->set_radius_m(disc.radius_m);
}
void put(const physics::Rectangle& rectangle, pb::Platform& out) {
    put(rectangle.half_extents_m, *out.mutable_rectangle()->mutable_half_extents_m());
}
void put(const physics::Ring& ring, pb::Platform& out) {
    out.mutable_ring()->set_inner_radius_m(ring.inner_radius_m);
    out.mutable_ring()->set_outer_radius_m(ring.outer_radius_m);
}

void put(const JoinRequest& message, pb::ClientMessage& out) {
    out.mutable_join_request()->set_name(message.name);
    out.mutable_join_request()->set_arena(message.arena);
}
void put(const BuyRequest& message, pb::ClientMessage& out) {
    pb::BuyRequest& request = *out.mutable_buy_request();
    request.set_request_id(message.request_id);
    request.set_stat(shifted<pb::Stat>(message.stat));
    request.set_tier(number(message.tier));
}
void put(const ChatRequest& message, pb::ClientMessage& out) {
    out.mutable_chat_request()->set_text(message.text);
}
void put(const ReadyRequest&, pb::ClientMessage& out) {
    out.mutable_ready_request();
}

void put(const Welcome& message, pb::ServerMessage& out) {
    pb::Welcome& welcome = *out.mutable_welcome();
    welcome.set_player_id(message.player_id);
    welcome.set_arena(number(message.arena));
    welcome.set_tick_rate_hz(number(message.tick_rate_hz));
    welcome.set_snapshot_rate_hz(number(message.snapshot_rate_hz));
    welcome.set_server_name(message.server_name);
}
void put(const JoinRefused& message, pb::ServerMessage& out) {
    out.mutable_join_refused()->set_reason(message.reason);
}
void put(const LevelStarted& message, pb::ServerMessage& out) {
    pb::LevelStarted& level = *out.mutable_level_started();
    level.set_number(number(message.number));
    level.set_level_count(number(message.level_count));
    level.set_name(message.name);
    level.set_hint(message.hint);
    std::visit([&](const auto& shape) { put(shape, *level.mutable_platform()); }, message.platform);
    level.set_ai_balls(number(message.ai_balls));
    level.set_solver(shifted<pb::Solver>(message.solver.kind));
    level.set_substeps(message.solver.substeps);
}
void put(const LevelEnded& message, pb::ServerMessage& out) {
    pb::LevelEnded& level = *out.mutable_level_ended();
    level.set_number(number(message.number));
    level.set_outcome(shifted<pb::LevelOutcome>(message.outcome));
    level.set_coins_earned(number(message.coins_earned));
}
void put(const Roster& message, pb::ServerMessage& out) {
    pb::Roster& roster = *out.mutable_roster();
    for (const PlayerInfo& player : message.players) {
        pb::PlayerInfo& info = *roster.add_players();
        info.set_player_id(player.player_id);
        info.set_name(player.name);
        info.set_colour(player.colour);
        info.set_knock_offs(number(player.knock_offs));
        info.set_assists(number(player.assists));
        info.set_falls(number(player.falls));
        info.set_lives(number(player.lives));
        info.set_coins(number(player.coins));
        info.set_ready(player.ready);
    }
}
void put(const Wallet& message, pb::ServerMessage& out) {
    out.mutable_wallet()->set_coins(number(message.coins));
    out.mutable_wallet()->set_tiers(message.tiers.data(), message.tiers.size());
}
void put(const PurchaseResult& message, pb::ServerMessage& out) {
    pb::PurchaseResult& result = *out.mutable_purchase_result();
    result.set_request_id(message.request_id);
    result.set_outcome(shifted<pb::PurchaseOutcome>(message.outcome));
}
void put(const ChatLine& message, pb::ServerMessage& out) {
    out.mutable_chat_line()->set_player_id(message.player_id);
    out.mutable_chat_line()->set_text(message.text);
}
void put(const KnockOff& message, pb::ServerMessage& out) {
    pb::KnockOff& knock_off = *out.mutable_knock_off();
    knock_off.set_victim_ball(message.victim_ball);
    knock_off.set_victim_player(message.victim_player);
    for (const KnockOff::Share& from : message.shares) {
        pb::KnockOff::Share& share = *knock_off.add_shares();
        share.set_player_id(from.player_id);
        share.set_coins(number(from.coins));
        share.set_assist(from.assist);
    }
}
void put(const CollisionReport::Side& side, pb::CollisionReport::Side& out) {
    out.set_ball(side.ball);
    out.set_player_id(side.player_id);
    out.set_mass_kg(side.mass_kg);
    out.set_radius_m(side.radius_m);
    put(side.position_m, *out.mutable_position_m());
    put(side.velocity_before_mps, *out.mutable_velocity_before_mps());
    put(side.velocity_after_mps, *out.mutable_velocity_after_mps());
}
void put(const CollisionReport& message, pb::ServerMessage& out) {
    pb::CollisionReport& report = *out.mutable_collision_report();
    report.set_tick(message.tick);
    report.set_time_in_tick_s(message.time_in_tick_s);
    put(message.own, *report.mutable_own());
    put(message.other, *report.mutable_other());
    put(message.normal, *report.mutable_normal());
    report.set_impulse_ns(message.impulse_ns);
    report.set_contacts_at_once(message.contacts_at_once);
}
void put(const KeyframePart& message, pb::ServerMessage& out) {
    out.mutable_keyframe_part()->set_part(message.part.data(), message.part.size());
}

// ---- Protobuf to values; false when a value is not acceptable
// -------------------------------------

template <typename Integer>
bool take(std::uint32_t from, std::uint32_t greatest, Integer& out) {
    if (from > greatest) return false;
    out = static_cast<Integer>(from);
    return true;
}

bool take(const std::string& from, std::size_t max_bytes, std::string& out) {
    if (from.size() > max_bytes || !is_utf8(from)) return false;
    out = from;
    return true;
}

template <typename Enum>
bool take_enum(int from, Enum last, Enum& out) {
    if (from < 1 || from > static_cast<int>(last) + 1) return false;
    out = static_cast<Enum>(from - 1);
    return true;
}

bool take_finite(double from, double& out) {
    out = from;
    return std::isfinite(from);
}
bool take_size(double from, double& out) {
    return take_finite(from, out) && from > 0;
}

bool take(const pb::Vector& from, physics::Vec2d& out) {
    return take_finite(from.x(), out.x()) && take_finite(from.y(), out.y());
}

bool take(const pb::Platform& from, physics::Platform& out) {
    switch (from.shape_case()) {
        case pb::Platform::kDisc:
            return take_size(from.disc().radius_m(), out.emplace<physics::Disc>().radius_m);
        case pb::Platform::kRectangle: {
            const pb::Vector& half_extents_m = from.rectangle().half_extents_m();
            physics::Vec2d& half = out.emplace<physics::Rectangle>().half_extents_m;
            return take_size(half_extents_m.x(), half.x()) &&
                   take_size(half_extents_m.y(), half.y());
        }
        case pb::Platform::kRing: {
            auto& ring = out.emplace<physics::Ring>();
            return take_size(from.ring().inner_radius_m(), ring.inner_radius_m) &&
                   take_size(from.ring().outer_radius_m(), ring.outer_radius_m) &&
                   ring.inner_radius_m < ring.outer_radius_m;
        }
        case pb::Platform::SHAPE_NOT_SET:
            break;
    }
    return false;
}

bool take(const pb::JoinRequest& from, JoinRequest& out) {
    out.arena = from.arena();
    return out.arena >= -1 && out.arena <= static_cast<int>(kMaxArena) &&
           take(from.name(), kMaxTextBytes, out.name);
}
bool take(const pb::BuyRequest& from, BuyRequest& out) {
    out.request_id = from.request_id();
    return take_enum(from.stat(), game::Stat::kMagnet, out.stat) &&
           take(from.tier(), game::kMaxTier, out.tier);
}
bool take(const pb::ChatRequest& from, ChatRequest& out) {
    return take(from.text(), game::kMaxChatBytes, out.text);
}
bool take(const pb::ReadyRequest&, ReadyRequest&) {
    return true;
}

bool take(const pb::Welcome& from, Welcome& out) {
    return take(from.player_id(), kMaxId, out.player_id) && out.player_id > 0 &&
           take(from.arena(), kMaxArena, out.arena) &&
           take(from.tick_rate_hz(), kMaxRateHz, out.tick_rate_hz) && out.tick_rate_hz > 0 &&
           take(from.snapshot_rate_hz(), kMaxRateHz, out.snapshot_rate_hz) &&
           out.snapshot_rate_hz > 0 && take(from.server_name(), kMaxTextBytes, out.server_name);
}
bool take(const pb::JoinRefused& from, JoinRefused& out) {
    return take(from.reason(), kMaxTextBytes, out.reason);
}
bool take(const pb::LevelStarted& from, LevelStarted& out) {
    return take(from.number(), kMaxId, out.number) &&
           take(from.level_count(), kMaxId, out.level_count) &&
           take(from.name(), kMaxTextBytes, out.name) &&
           take(from.hint(), kMaxTextBytes, out.hint) && take(from.platform(), out.platform) &&
           take(from.ai_balls(), kMaxId, out.ai_balls) &&
           take_enum(from.solver(), physics::SolverKind::kEvent, out.solver.kind) &&
           take(from.substeps(), physics::kMaxSubsteps, out.solver.substeps) &&
           out.solver.substeps > 0;
}
bool take(const pb::LevelEnded& from, LevelEnded& out) {
    return take(from.number(), kMaxId, out.number) &&
           take_enum(from.outcome(), LevelOutcome::kCampaignComplete, out.outcome) &&
           take(from.coins_earned(), kMaxInt, out.coins_earned);
}
bool take(const pb::PlayerInfo& from, PlayerInfo& out) {
    out.ready = from.ready();
    return take(from.player_id(), kMaxId, out.player_id) && out.player_id > 0 &&
           take(from.name(), game::kMaxNameBytes, out.name) &&
           take(from.colour(), std::numeric_limits<std::uint8_t>::max(), out.colour) &&
           take(from.knock_offs(), kMaxInt, out.knock_offs) &&
           take(from.assists(), kMaxInt, out.assists) && take(from.falls(), kMaxInt, out.falls) &&
           take(from.lives(), kMaxInt, out.lives) && take(from.coins(), kMaxInt, out.coins);
}
bool take(const pb::Roster& from, Roster& out) {
    if (static_cast<std::size_t>(from.players_size()) > kMaxPlayersInMessage) return false;
    for (const pb::PlayerInfo& info : from.players()) {
        PlayerInfo player;
        if (!take(info, player)) return false;
        const bool ascends = out.players.empty() || out.players.back().player_id < player.player_id;
        if (!ascends) return false;
        out.players.push_back(std::move(player));
    }
    return true;
}
bool take(const pb::Wallet& from, Wallet& out) {
    if (from.tiers().size() != out.tiers.size()) return false;
    std::memcpy(out.tiers.data(), from.tiers().data(), out.tiers.size());
    return game::valid(out.tiers) && take(from.coins(), kMaxInt, out.coins);
}
bool take(const pb::PurchaseResult& from, PurchaseResult& out) {
    out.request_id = from.request_id();
    return take_enum(from.outcome(), PurchaseOutcome::kStoreFailed, out.outcome);
}
bool take(const pb::ChatLine& from, ChatLine& out) {
    return take(from.player_id(), kMaxId, out.player_id) &&
           take(from.text(), kMaxTextBytes, out.text);
}
bool take(const pb::KnockOff& from, KnockOff& out) {
    if (static_cast<std::size_t>(from.shares_size()) > kMaxPlayersInMessage) return false;
    for (const pb::KnockOff::Share& share : from.shares()) {
        KnockOff::Share& to = out.shares.emplace_back();
        to.assist = share.assist();
        if (!take(share.player_id(), kMaxId, to.player_id)) return false;
        if (!take(share.coins(), kMaxInt, to.coins)) return false;
    }
    return take(from.victim_ball(), kMaxId, out.victim_ball) &&
           take(from.victim_player(), kMaxId, out.victim_player);
}
bool take(const pb::CollisionReport::Side& from, CollisionReport::Side& out) {
    return take(from.ball(), kMaxId, out.ball) && take(from.player_id(), kMaxId, out.player_id) &&
           take_size(from.mass_kg(), out.mass_kg) && take_size(from.radius_m(), out.radius_m) &&
           take(from.position_m(), out.position_m) &&
           take(from.velocity_before_mps(), out.velocity_before_mps) &&
           take(from.velocity_after_mps(), out.velocity_after_mps);
}
bool take(const pb::CollisionReport& from, CollisionReport& out) {
    out.tick = from.tick();
    return take_finite(from.time_in_tick_s(), out.time_in_tick_s) && out.time_in_tick_s >= 0 &&
           take(from.own(), out.own) && take(from.other(), out.other) &&
           take(from.normal(), out.normal) && std::abs(out.normal.norm() - 1) <= kUnitTolerance &&
           take_finite(from.impulse_ns(), out.impulse_ns) && out.impulse_ns >= 0 &&
           take(from.contacts_at_once(), kMaxId, out.contacts_at_once) && out.contacts_at_once >= 1;
}
bool take(const pb::KeyframePart& from, KeyframePart& out) {
    if (from.part().size() > kMaxKeyframePartBytes) return false;
    out.part.assign(from.part().begin(), from.part().end());
    const auto header = peek_part(out.part);
    return header && header->baseline_tick == 0;
}

// ---- the two directions
// ----------------------------------------------------------------------------

template <typename Value, typename Message, typename Proto>
std::optional<Message> taken(const Proto& from) {
    Value value;
    if (!take(from, value)) return std::nullopt;
    return Message(std::move(value));
}

std::optional<ClientMessage> value_of(const pb::ClientMessage& from) {
    using Proto = pb::ClientMessage;
    switch (from.kind_case()) {
        case Proto::kJoinRequest:
            return taken<JoinRequest, ClientMessage>(from.join_request());
        case Proto::kBuyRequest:
            return taken<BuyRequest, ClientMessage>(from.buy_request());
        case Proto::kChatRequest:
            return taken<ChatRequest, ClientMessage>(from.chat_request());
        case Proto::kReadyRequest:
            return taken<ReadyRequest, ClientMessage>(from.ready_request());
        case Proto::KIND_NOT_SET:
            break;
    }
    return std::nullopt;
}

std::optional<ServerMessage> value_of(const pb::ServerMessage& from) {
    using Proto = pb::ServerMessage;
    switch (from.kind_case()) {
        case Proto::kWelcome:
            return taken<Welcome, ServerMessage>(from.welcome());
        case Proto::kJoinRefused:
            return taken<JoinRefused, ServerMessage>(from.join_refused());
        case Proto::kLevelStarted:
            return taken<LevelStarted, ServerMessage>(from.level_started());
        case Proto::kLevelEnded:
            return taken<LevelEnded, ServerMessage>(from.level_ended());
        case Proto::kRoster:
            return taken<Roster, ServerMessage>(from.roster());
        case Proto::kWallet:
            return taken<Wallet, ServerMessage>(from.wallet());
        case Proto::kPurchaseResult:
            return taken<PurchaseResult, ServerMessage>(from.purchase_result());
        case Proto::kChatLine:
            return taken<ChatLine, ServerMessage>(from.chat_line());
        case Proto::kKnockOff:
            return taken<KnockOff, ServerMessage>(from.knock_off());
        case Proto::kCollisionReport:
            return taken<CollisionReport, ServerMessage>(from.collision_report());
        case Proto::kKeyframePart:
            return taken<KeyframePart, ServerMessage>(from.keyframe_part());
        case Proto::KIND_NOT_SET:
            break;
    }
    return std::nullopt;
}

template <typename Proto>
auto decode(std::span<const std::uint8_t> bytes) -> decltype(value_of(Proto())) {
    Proto proto;
    if (bytes.size() > kMaxControlMessageBytes) return std::nullopt;
    if (!proto.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return std::nullopt;
    return value_of(proto);
}

// No bytes for what the other end would refuse.
template <typename Proto, typename Message>
std::vector<std::uint8_t> bytes_of(const Message& message) {
    Proto proto;
    std::visit([&](const auto& value) { put(value, proto); }, message);
    const std::size_t size = proto.ByteSizeLong();
    if (size > kMaxControlMessageBytes || !value_of(proto)) return {};
    std::vector<std::uint8_t> bytes(size);
    proto.SerializeToArray(bytes.data(), static_cast<int>(size));
    return bytes;
}

}  // namespace

std::vector<std::uint8_t> encode(const ClientMessage& message) {
    return bytes_of<pb::ClientMessage>(message);
}
std::vector<std::uint8_t> encode(const ServerMessage& message) {
    return bytes_of<pb::ServerMessage>(message);
}
std::optional<ClientMessage> decode_client_message(std::span<const std::uint8_t> bytes) {
    return decode<pb::ClientMessage>(bytes);
}
std::optional<ServerMessage> decode_server_message(std::span<const std::uint8_t> bytes) {
    return decode<pb::ServerMessage>(bytes);
}

}  // namespace fts::replication
