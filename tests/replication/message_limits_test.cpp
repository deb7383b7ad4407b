// What is refused: at the sending end no bytes are made of it, at the receiving end it is nothing.
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "common/replication/utf8.h"
#include "common/replication/wire.h"
#include "tests/replication/random_snapshots.h"

namespace fts::replication {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <typename Message>
bool travels(const Message& message) {
    if constexpr (std::is_constructible_v<ClientMessage, Message>) {
        return !encode(ClientMessage(message)).empty();
    } else {
        return !encode(ServerMessage(message)).empty();
    }
}

Bytes field(std::uint8_t number, const Bytes& content) {
    Bytes bytes = {static_cast<std::uint8_t>(number << 3 | 2),
                   static_cast<std::uint8_t>(content.size())};
    bytes.insert(bytes.end(), content.begin(), content.end());
    return bytes;
}

CollisionReport sound_report() {
    CollisionReport report;
    report.own = {1, 1, 1.0, 0.5, {0, 0}, {1, 0}, {0, 0}};
    report.other = {2, 0, 1.0, 0.5, {1, 0}, {0, 0}, {1, 0}};
    report.impulse_ns = 1.0;
    return report;
}

TEST(MessageLimits, TextsAreUtf8) {
    EXPECT_TRUE(is_utf8(""));
    EXPECT_TRUE(
        is_utf8("Gr\xC3\xB6\xC3\x9F"
                "e \xE2\x82\xAC \xF0\x9F\x8E\xB1 \xF4\x8F\xBF\xBF"));
    EXPECT_TRUE(is_utf8(std::string_view("\0\n", 2)));
    for (const std::string_view text :
         {"\x80", "\xC3", "\xC3(", "\xC0\xAF", "\xE0\x80\x80", "\xE2\x82", "\xED\xA0\x80",
          "\xF0\x80\x80\x80", "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80", "\xFF"}) {
        EXPECT_FALSE(is_utf8(text)) << ::testing::PrintToString(text);
        EXPECT_FALSE(travels(ChatRequest{std::string(text)}));
        EXPECT_FALSE(travels(JoinRequest{std::string(text), 0}));
        EXPECT_FALSE(travels(JoinRefused{std::string(text)}));
    }
}

TEST(MessageLimits, MalformedTextThatArrivesIsNothing) {
    const Bytes fine = field(3, field(1, {'h', 'i'}));
    ASSERT_TRUE(decode_client_message(fine));
    EXPECT_FALSE(decode_client_message(field(3, field(1, {'h', 0xFF}))));
}

TEST(MessageLimits, TextsAreNoLongerThanTheirLimits) {
    const auto text = [](std::size_t bytes) { return std::string(bytes, 'x'); };
    EXPECT_TRUE(travels(ChatRequest{text(game::kMaxChatBytes)}));
    EXPECT_FALSE(travels(ChatRequest{text(game::kMaxChatBytes + 1)}));
    EXPECT_TRUE(travels(JoinRequest{text(kMaxTextBytes), 0}));
    EXPECT_FALSE(travels(JoinRequest{text(kMaxTextBytes + 1), 0}));
    EXPECT_TRUE(travels(ChatLine{0, text(kMaxTextBytes)}));
    EXPECT_FALSE(travels(ChatLine{0, text(kMaxTextBytes + 1)}));
    PlayerInfo player;
    player.player_id = 1;
    player.name = text(game::kMaxNameBytes);
    EXPECT_TRUE(travels(Roster{{player}}));
    player.name = text(game::kMaxNameBytes + 1);
    EXPECT_FALSE(travels(Roster{{player}}));
}

TEST(MessageLimits, NumbersStayInTheirRanges) {
    EXPECT_FALSE(travels(JoinRequest{"a", -2}));
    EXPECT_FALSE(travels(JoinRequest{"a", 256}));
    EXPECT_FALSE(travels(BuyRequest{1, game::Stat::kMass, game::kMaxTier + 1}));
    EXPECT_FALSE(travels(BuyRequest{1, game::Stat::kMass, -1}));
    EXPECT_FALSE(travels(BuyRequest{1, static_cast<game::Stat>(6), 0}));
    EXPECT_FALSE(travels(Welcome{0, 0, 60, 30, ""})) << "nobody";
    EXPECT_FALSE(travels(Welcome{1, -1, 60, 30, ""}));
    EXPECT_FALSE(travels(Welcome{1, 0, 0, 30, ""}));
    EXPECT_FALSE(travels(Welcome{1, 0, 60, 1001, ""}));
    EXPECT_FALSE(travels(LevelEnded{1, static_cast<LevelOutcome>(4), 0}));
    EXPECT_FALSE(travels(LevelEnded{1, LevelOutcome::kLost, -1}));
    EXPECT_FALSE(travels(PurchaseResult{1, static_cast<PurchaseOutcome>(7)}));
    EXPECT_FALSE(travels(Wallet{-1, {}}));
    EXPECT_FALSE(travels(Wallet{0, {0, 0, 0, 0, 0, game::kMaxTier + 1}}));
    EXPECT_FALSE(travels(KnockOff{1, 0, {{1, -1, false}}}));
}

TEST(MessageLimits, RostersAreSortedAndOfPlayersThatAnArenaCanHold) {
    Roster roster;
    for (std::size_t i = 1; i <= kMaxPlayersInMessage; ++i) {
        PlayerInfo player;
        player.player_id = static_cast<std::uint16_t>(0xFFFF - kMaxPlayersInMessage + i);
        player.name = std::string(game::kMaxNameBytes, 'W');
        player.colour = 255;
        player.knock_offs = player.assists = player.falls = player.lives = player.coins =
            std::numeric_limits<int>::max();
        player.ready = true;
        roster.players.push_back(player);
    }
    const Bytes bytes = encode(ServerMessage(roster));
    EXPECT_FALSE(bytes.empty()) << "the greatest roster fits a message";
    EXPECT_LE(bytes.size(), kMaxPlayersInMessage * kMaxPlayerInfoBytes + 3);

    std::swap(roster.players[3], roster.players[4]);
    EXPECT_FALSE(travels(roster));
    std::swap(roster.players[3], roster.players[4]);
    roster.players.insert(roster.players.begin(), PlayerInfo{});
    EXPECT_FALSE(travels(roster)) << "player 0";
    roster.players.front().player_id = 1;
    EXPECT_FALSE(travels(roster)) << "one too many";
}

TEST(MessageLimits, KnockOffSharesAreLimited) {
    KnockOff knock_off;
    knock_off.shares.resize(kMaxPlayersInMessage);
    EXPECT_TRUE(travels(knock_off));
    knock_off.shares.emplace_back();
    EXPECT_FALSE(travels(knock_off));
}

TEST(MessageLimits, PlatformsHaveFiniteSizesAboveZero) {
    const auto platform_travels = [](const physics::Platform& platform) {
        LevelStarted level;
        level.platform = platform;
        return travels(level);
    };
    for (const double bad : {0.0, -1.0, kInfinity, kNan}) {
        SCOPED_TRACE(bad);
        EXPECT_FALSE(platform_travels(physics::Disc{bad}));
        EXPECT_FALSE(platform_travels(physics::Rectangle{{bad, 1.0}}));
        EXPECT_FALSE(platform_travels(physics::Rectangle{{1.0, bad}}));
        EXPECT_FALSE(platform_travels(physics::Ring{bad, 5.0}));
        EXPECT_FALSE(platform_travels(physics::Ring{1.0, bad}));
    }
    EXPECT_TRUE(platform_travels(physics::Ring{1.0, 5.0}));
    EXPECT_FALSE(platform_travels(physics::Ring{5.0, 5.0}));
}

TEST(MessageLimits, CollisionReportsAreFiniteAndOfRealBalls) {
    ASSERT_TRUE(travels(sound_report()));
    for (const double bad : {kInfinity, -kInfinity, kNan}) {
        SCOPED_TRACE(bad);
        CollisionReport report = sound_report();
        report.own.position_m.y() = bad;
        EXPECT_FALSE(travels(report));
        report = sound_report();
        report.other.velocity_after_mps.x() = bad;
        EXPECT_FALSE(travels(report));
        report = sound_report();
        report.impulse_ns = bad;
        EXPECT_FALSE(travels(report));
        report = sound_report();
        report.time_in_tick_s = bad;
        EXPECT_FALSE(travels(report));
        report = sound_report();
        report.normal.x() = bad;
        EXPECT_FALSE(travels(report));
    }
    CollisionReport report = sound_report();
    report.other.mass_kg = 0;
    EXPECT_FALSE(travels(report));
    report = sound_report();
    report.normal *= 2;
    EXPECT_FALSE(travels(report));
    report = sound_report();
    report.contacts_at_once = 0;
    EXPECT_FALSE(travels(report));
}

TEST(MalformedMessages, AreNothing) {
    EXPECT_FALSE(decode_client_message({})) << "no message at all";
    EXPECT_FALSE(decode_server_message({}));
    EXPECT_FALSE(decode_client_message(field(15, {}))) << "a message nobody knows";
    EXPECT_FALSE(decode_server_message(field(15, {})));
    EXPECT_FALSE(decode_client_message(field(2, {}))) << "a purchase of nothing";
    EXPECT_FALSE(decode_client_message(field(2, {0x10, 99}))) << "of an unknown stat";
    EXPECT_TRUE(decode_client_message(field(2, {0x10, 1})));
    EXPECT_FALSE(decode_server_message(field(3, {}))) << "a level without a platform";
    EXPECT_FALSE(decode_server_message(field(3, field(5, {})))) << "a platform without a shape";
    EXPECT_FALSE(decode_server_message(field(10, {}))) << "a collision of nothing";
    EXPECT_FALSE(decode_server_message(field(6, field(2, {1, 2, 3})))) << "half the stats";
}

TEST(MalformedMessages, LargerThanTheLimitAreNotEvenLookedAt) {
    Bytes ready = field(4, {});
    ASSERT_TRUE(decode_client_message(ready));
    const Bytes unknown_field = field(14, Bytes(100, 'x'));
    while (ready.size() + unknown_field.size() <= kMaxControlMessageBytes) {
        ready.insert(ready.end(), unknown_field.begin(), unknown_field.end());
    }
    EXPECT_TRUE(decode_client_message(ready)) << "what is unknown beside a message is passed over";
    ready.insert(ready.end(), unknown_field.begin(), unknown_field.end());
    EXPECT_FALSE(decode_client_message(ready));
}

TEST(MalformedMessages, CutShortOrWithAByteChangedAreNothingOrSound) {
    Roster roster;
    roster.players = {{1, "Ada", 0, 1, 2, 3, 4, 5, false}, {9, "Bob", 255, 10, 0, 0, 0, 2, true}};
    LevelStarted level;
    level.platform = physics::Ring{1, 2};
    testing::Rng rng(21);
    for (const ServerMessage& message :
         {ServerMessage(roster), ServerMessage(level), ServerMessage(sound_report()),
          ServerMessage(Wallet{5, {1, 2, 3, 4, 5, 6}})}) {
        const Bytes bytes = encode(message);
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            EXPECT_FALSE(decode_server_message(std::span(bytes).first(i))) << i;
            for (int k = 0; k < 20; ++k) {
                Bytes changed = bytes;
                changed[i] = static_cast<std::uint8_t>(rng());
                const auto value = decode_server_message(changed);
                if (value) {
                    EXPECT_FALSE(encode(*value).empty()) << i;
                }
            }
        }
    }
}

}  // namespace
}  // namespace fts::replication
