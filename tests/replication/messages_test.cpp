// Every message there and back, field by field.
#include <string>
#include <type_traits>

#include <gtest/gtest.h>

#include "common/replication/delta.h"
#include "common/replication/wire.h"

namespace fts::replication {
namespace {

template <typename T>
constexpr bool kIsFromClient = std::is_constructible_v<ClientMessage, T>;

// What comes out at the other end.
template <typename T>
T through_the_wire(const T& message) {
    if constexpr (kIsFromClient<T>) {
        const auto back = decode_client_message(encode(ClientMessage(message)));
        EXPECT_TRUE(back && std::holds_alternative<T>(*back));
        return back && std::holds_alternative<T>(*back) ? std::get<T>(*back) : T{};
    } else {
        const auto back = decode_server_message(encode(ServerMessage(message)));
        EXPECT_TRUE(back && std::holds_alternative<T>(*back));
        return back && std::holds_alternative<T>(*back) ? std::get<T>(*back) : T{};
    }
}

TEST(Messages, JoinRequest) {
    const JoinRequest back = through_the_wire(JoinRequest{"Zo\xC3\xAB", 3});
    EXPECT_EQ(back.name, "Zo\xC3\xAB");
    EXPECT_EQ(back.arena, 3);
    EXPECT_EQ(through_the_wire(JoinRequest{}).arena, -1);
}

TEST(Messages, BuyRequest) {
    for (std::size_t stat = 0; stat < game::kStatCount; ++stat) {
        const auto wanted = static_cast<game::Stat>(stat);
        const BuyRequest back = through_the_wire(BuyRequest{0xFEDCBA9876543210, wanted, 6});
        EXPECT_EQ(back.request_id, 0xFEDCBA9876543210);
        EXPECT_EQ(back.stat, wanted);
        EXPECT_EQ(back.tier, 6);
    }
}

TEST(Messages, ChatAndReady) {
    EXPECT_EQ(through_the_wire(ChatRequest{"gg"}).text, "gg");
    through_the_wire(ReadyRequest{});
    const ChatLine line = through_the_wire(ChatLine{65535, "gg"});
    EXPECT_EQ(line.player_id, 65535);
    EXPECT_EQ(line.text, "gg");
}

TEST(Messages, Welcome) {
    const Welcome back = through_the_wire(Welcome{7, 2, 60, 30, "Friday night"});
    EXPECT_EQ(back.player_id, 7);
    EXPECT_EQ(back.arena, 2);
    EXPECT_EQ(back.tick_rate_hz, 60);
    EXPECT_EQ(back.snapshot_rate_hz, 30);
    EXPECT_EQ(back.server_name, "Friday night");
}

TEST(Messages, JoinRefused) {
    EXPECT_EQ(through_the_wire(JoinRefused{"The server is full."}).reason, "The server is full.");
}

TEST(Messages, LevelStartedOnEveryPlatform) {
    LevelStarted level{.number = 3,
                       .level_count = 9,
                       .name = "Ring",
                       .hint = "Mind the hole.",
                       .platform = physics::Ring{1.25, 12.5},
                       .ai_balls = 8,
                       .solver = {physics::SolverKind::kDiscrete, 4}};
    LevelStarted back = through_the_wire(level);
    EXPECT_EQ(back.number, 3);
    EXPECT_EQ(back.level_count, 9);
    EXPECT_EQ(back.name, "Ring");
    EXPECT_EQ(back.hint, "Mind the hole.");
    EXPECT_EQ(back.ai_balls, 8);
    EXPECT_EQ(back.solver.kind, physics::SolverKind::kDiscrete);
    EXPECT_EQ(back.solver.substeps, 4U);
    EXPECT_EQ(std::get<physics::Ring>(back.platform).inner_radius_m, 1.25);
    EXPECT_EQ(std::get<physics::Ring>(back.platform).outer_radius_m, 12.5);

    level.platform = physics::Disc{0.1};
    back = through_the_wire(level);
    EXPECT_EQ(std::get<physics::Disc>(back.platform).radius_m, 0.1);

    level.platform = physics::Rectangle{{8.0, 6.5}};
    back = through_the_wire(level);
    EXPECT_EQ(std::get<physics::Rectangle>(back.platform).half_extents_m, physics::Vec2d(8.0, 6.5));
}

TEST(Messages, LevelEnded) {
    for (const LevelOutcome outcome : {LevelOutcome::kCleared, LevelOutcome::kLost,
                                       LevelOutcome::kTimeUp, LevelOutcome::kCampaignComplete}) {
        const LevelEnded back = through_the_wire(LevelEnded{4, outcome, 17});
        EXPECT_EQ(back.number, 4);
        EXPECT_EQ(back.outcome, outcome);
        EXPECT_EQ(back.coins_earned, 17);
    }
}

TEST(Messages, Roster) {
    Roster roster;
    roster.players = {{1, "Ada", 0, 1, 2, 3, 4, 5, false},
                      {9, "", 255, 10, 0, 0, 0, 2'000'000'000, true}};
    const Roster back = through_the_wire(roster);
    ASSERT_EQ(back.players.size(), 2U);
    const PlayerInfo &ada = back.players[0], &other = back.players[1];
    EXPECT_EQ(ada.player_id, 1);
    EXPECT_EQ(ada.name, "Ada");
    EXPECT_EQ(ada.colour, 0);
    EXPECT_EQ(ada.knock_offs, 1);
    EXPECT_EQ(ada.assists, 2);
    EXPECT_EQ(ada.falls, 3);
    EXPECT_EQ(ada.lives, 4);
    EXPECT_EQ(ada.coins, 5);
    EXPECT_FALSE(ada.ready);
    EXPECT_EQ(other.colour, 255);
    EXPECT_EQ(other.coins, 2'000'000'000);
    EXPECT_TRUE(other.ready);
}

TEST(Messages, Wallet) {
    const game::Tiers tiers = {0, 1, 2, 3, 6, 5};
    const Wallet back = through_the_wire(Wallet{123, tiers});
    EXPECT_EQ(back.coins, 123);
    EXPECT_EQ(back.tiers, tiers);
}

TEST(Messages, PurchaseResult) {
    for (int i = 0; i <= static_cast<int>(PurchaseOutcome::kStoreFailed); ++i) {
        const auto outcome = static_cast<PurchaseOutcome>(i);
        const PurchaseResult back = through_the_wire(PurchaseResult{~0ULL, outcome});
        EXPECT_EQ(back.request_id, ~0ULL);
        EXPECT_EQ(back.outcome, outcome);
    }
}

TEST(Messages, KnockOff) {
    const KnockOff back = through_the_wire(KnockOff{77, 5, {{1, 3, false}, {2, 1, true}}});
    EXPECT_EQ(back.victim_ball, 77);
    EXPECT_EQ(back.victim_player, 5);
    ASSERT_EQ(back.shares.size(), 2U);
    EXPECT_EQ(back.shares[0].player_id, 1);
    EXPECT_EQ(back.shares[0].coins, 3);
    EXPECT_FALSE(back.shares[0].assist);
    EXPECT_EQ(back.shares[1].player_id, 2);
    EXPECT_TRUE(back.shares[1].assist);
    EXPECT_TRUE(through_the_wire(KnockOff{77, 0, {}}).shares.empty());
}

TEST(Messages, CollisionReportKeepsEveryBitOfItsDoubles) {
    CollisionReport report;
    report.tick = 4'000'000'000;
    report.time_in_tick_s = 1.0 / 97;
    report.own = {1, 2, 1.0 / 3, 0.1, {1.0 / 7, -1e-300}, {1e300, -0.0}, {0.1 + 0.2, 5e-324}};
    report.other = {3, 0, 2.0 / 3, 0.7, {4, 5}, {6, 7}, {8, 9}};
    report.normal = {0.6, -0.8};
    report.impulse_ns = 1.0 / 11;
    report.contacts_at_once = 3;
    const CollisionReport back = through_the_wire(report);
    EXPECT_EQ(back.tick, report.tick);
    EXPECT_EQ(back.time_in_tick_s, report.time_in_tick_s);
    EXPECT_EQ(back.normal, report.normal);
    EXPECT_EQ(back.impulse_ns, report.impulse_ns);
    EXPECT_EQ(back.contacts_at_once, report.contacts_at_once);
    for (const auto side : {&CollisionReport::own, &CollisionReport::other}) {
        const CollisionReport::Side &sent = report.*side, &got = back.*side;
        EXPECT_EQ(got.ball, sent.ball);
        EXPECT_EQ(got.player_id, sent.player_id);
        EXPECT_EQ(got.mass_kg, sent.mass_kg);
        EXPECT_EQ(got.radius_m, sent.radius_m);
        EXPECT_EQ(got.position_m, sent.position_m);
        EXPECT_EQ(got.velocity_before_mps, sent.velocity_before_mps);
        EXPECT_EQ(got.velocity_after_mps, sent.velocity_after_mps);
    }
    EXPECT_TRUE(std::signbit(back.own.velocity_before_mps.y()));
}

TEST(Messages, KeyframePartsArePartsWithoutABaselineAndNothingElse) {
    Snapshot now;
    now.tick = 50;
    now.balls = {{.id = 3, .x = 5, .y = 7, .radius = 9, .mass = 11}};
    const KeyframePart part{encode_delta({}, now, kMaxKeyframePartBytes).front()};
    EXPECT_EQ(through_the_wire(part).part, part.part);
    EXPECT_TRUE(encode(ServerMessage(KeyframePart{})).empty());
    Snapshot before = now;
    before.tick = 48;
    EXPECT_TRUE(encode(ServerMessage(
                           KeyframePart{encode_delta(before, now, kMaxKeyframePartBytes).front()}))
                    .empty());
    KeyframePart long_part = part;
    long_part.part.resize(kMaxKeyframePartBytes + 1);
    EXPECT_TRUE(encode(ServerMessage(long_part)).empty());
}

}  // namespace
}  // namespace fts::replication
