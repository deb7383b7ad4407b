// Laws that hold in every tick of any match, however people come, go, play and buy.
#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "common/replication/arena_replay.h"
#include "server/match/random.h"
#include "tests/server/match/match_bench.h"

namespace fts::server {
namespace {

using game::Behaviour;
using game::Difficulty;
using physics::Vec2d;

constexpr int kPeople = 6;
constexpr int kPocketMoney = 60;
constexpr int kTicks = 60 * 150;

// On all three platforms; the seed says on which the campaign begins.
std::vector<game::Level> busy_levels(std::uint64_t seed) {
    std::vector<game::Level> levels = {
        quiet_level(1, physics::Disc{6.0}),
        quiet_level(2, physics::Rectangle{{7.0, 4.0}}),
        quiet_level(3, physics::Ring{2.5, 8.0}),
    };
    levels[0].ai = {
        {.behaviour = Behaviour::kChaser, .difficulty = Difficulty::kNovice, .count = 3},
        {.behaviour = Behaviour::kCoward, .difficulty = Difficulty::kEasy}};
    levels[1].ai = {{.behaviour = Behaviour::kBruiser,
                     .difficulty = Difficulty::kHard,
                     .mass_kg = 3.0,
                     .thrust_n = 20.0},
                    {.behaviour = Behaviour::kHerd, .difficulty = Difficulty::kNormal, .count = 4}};
    levels[2].ai = {
        {.behaviour = Behaviour::kInterceptor, .difficulty = Difficulty::kExpert, .count = 3},
        {.behaviour = Behaviour::kEdgeGuard, .difficulty = Difficulty::kNormal, .count = 2}};
    for (auto& level : levels) {
        level.field_coins = 6;
        level.time_limit_s = 25.0;
    }
    std::rotate(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(seed % 3),
                levels.end());
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i].number = static_cast<int>(i) + 1;
    return levels;
}

// People who come, go, steer at random or ram the AI balls, shop and get ready.
class Crowd {
  public:
    Crowd(MatchBench& bench, std::uint64_t seed) : bench_(bench), random_(seed) {}

    void act() {
        for (int person = 1; person <= kPeople; ++person) act(person);
    }
    // Coins that everybody's score lines say they should hold.
    std::map<int, std::int64_t> expected_coins() const {
        std::map<int, std::int64_t> expected;
        for (const auto& [player, person] : person_of_) expected[person] = kPocketMoney;
        for (const ScoreLine& line : bench_.match.scoreboard())
            expected[person_of_.at(line.player)] += line.coins_earned - line.coins_dropped;
        for (const auto& [person, coins] : spent_) expected[person] -= coins;
        return expected;
    }

  private:
    void act(int person) {
        const auto here = here_.find(person);
        if (here == here_.end()) {
            if (random_.below(400) != 0) return;
            const PlayerId player = bench_.join(person, kPocketMoney);
            here_[person] = player;
            person_of_[player] = person;
            return;
        }
        if (random_.below(3000) == 0) {
            bench_.match.leave(here->second);
            here_.erase(here);
            return;
        }
        if (person % 2 == 0) {
            bench_.match.set_input(here->second,
                                   ram(bench_.match.snapshot(), here->second, Prey::kAi));
        } else if (random_.below(20) == 0) {
            bench_.match.set_input(here->second,
                                   {.thrust_x = static_cast<std::int8_t>(random_.next()),
                                    .thrust_y = static_cast<std::int8_t>(random_.next()),
                                    .brake = random_.below(4) == 0,
                                    .dash = random_.below(2) == 0});
        }
        if (!bench_.match.shop_is_open()) return;
        if (random_.below(200) == 0) bench_.match.set_ready(here->second);
        if (random_.below(100) == 0) buy(person, here->second);
    }
    void buy(int person, PlayerId player) {
        const auto stat = static_cast<game::Stat>(random_.below(game::kStatCount));
        const int tier = bench_.ledger.tiers(key_of(person))[static_cast<std::size_t>(stat)];
        const auto done = bench_.ledger.buy(key_of(person), ++last_request_, stat, tier);
        if (done.outcome != BuyOutcome::kBought) return;
        spent_[person] += *game::price_coins(tier);
        bench_.match.upgrades_changed(player);
    }

    MatchBench& bench_;
    Random random_;
    std::map<int, PlayerId> here_;
    std::map<PlayerId, int> person_of_;
    std::map<int, std::int64_t> spent_;
    std::uint64_t last_request_ = 0;
};

void expect_sound(const replication::Snapshot& snapshot, const game::Level& level) {
    ASSERT_TRUE(is_canonical(snapshot));
    constexpr double kRoundingM = 2.0 * replication::kPositionStepM;
    for (std::size_t i = 0; i < snapshot.balls.size(); ++i) {
        const auto& a = snapshot.balls[i];
        ASSERT_GE(physics::distance_to_edge_m(level.platform, position_of(a)), -kRoundingM);
        for (std::size_t j = i + 1; j < snapshot.balls.size(); ++j) {
            const auto& b = snapshot.balls[j];
            const double touching_m = (a.radius + b.radius) * replication::kRadiusStepM;
            ASSERT_GE((position_of(a) - position_of(b)).norm(), touching_m - 2.0 * kRoundingM);
        }
    }
}

class RandomMatch : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomMatch, keeps_books_balls_and_snapshots_sound_in_every_tick) {
    SCOPED_TRACE("seed " + std::to_string(GetParam()));
    const auto levels = busy_levels(GetParam());
    MatchBench bench(levels, GetParam());
    Crowd crowd(bench, GetParam() + 1000);
    std::uint64_t overruns = 0;
    std::map<std::uint16_t, std::uint32_t> last_seen;
    std::set<std::uint16_t> present;
    for (int tick = 0; tick < kTicks; ++tick) {
        crowd.act();
        overruns += bench.match.tick().overrun;
        bench.match.drain_outgoing();
        const auto snapshot = bench.match.snapshot();
        ASSERT_NO_FATAL_FAILURE(expect_sound(
            snapshot, levels[static_cast<std::size_t>(bench.match.level_number() - 1)]))
            << "tick " << tick;

        ASSERT_TRUE(bench.ledger.totals().balanced());
        ASSERT_EQ(bench.ledger.field_coins(0), static_cast<std::int64_t>(snapshot.coins.size()));
        for (const auto& [person, coins] : crowd.expected_coins())
            ASSERT_EQ(bench.ledger.coins(key_of(person)), coins) << "tick " << tick;

        std::set<std::uint16_t> now_present;
        for (const auto& ball : snapshot.balls) {
            now_present.insert(ball.id);
            const auto seen = last_seen.find(ball.id);
            if (seen != last_seen.end() && !present.contains(ball.id)) {
                ASSERT_GT(snapshot.tick - seen->second, 600u) << "ball " << ball.id << " came back";
            }
            last_seen[ball.id] = snapshot.tick;
        }
        present = std::move(now_present);
        if (tick % 2 == 0) bench.match.clear_hits();
    }
    EXPECT_EQ(bench.match.totals().overruns, overruns);
    EXPECT_GT(bench.match.audit().ball_collisions, 100u);
    EXPECT_GT(bench.match.totals().ai_knock_offs, 5u);
    EXPECT_GT(bench.ledger.totals().spent, 0);
    EXPECT_LE(bench.match.audit().worst_energy_error, 1e-12);
    EXPECT_LE(bench.match.audit().worst_momentum_error, 1e-12);
}

TEST_P(RandomMatch, gives_the_same_snapshots_for_the_same_seed_and_calls) {
    SCOPED_TRACE("seed " + std::to_string(GetParam()));
    MatchBench first(busy_levels(GetParam()), GetParam()),
        second(busy_levels(GetParam()), GetParam());
    Crowd first_crowd(first, GetParam()), second_crowd(second, GetParam());
    std::set<std::uint64_t> hashes;
    for (int tick = 0; tick < kTicks / 3; ++tick) {
        first_crowd.act();
        second_crowd.act();
        first.match.tick();
        second.match.tick();
        const auto hash = hash_of(first.match.snapshot());
        ASSERT_EQ(hash, hash_of(second.match.snapshot())) << "tick " << tick;
        hashes.insert(hash);
    }
    EXPECT_GT(hashes.size(), 1000u);
}

// What a client does: runs on from a snapshot that it holds, by what it is told.
TEST_P(RandomMatch, is_replayed_to_the_last_bit_from_any_snapshot_of_its_level) {
    SCOPED_TRACE("seed " + std::to_string(GetParam()));
    const auto levels = busy_levels(GetParam());
    MatchBench bench(levels, GetParam());
    const MatchConfig rules;
    Crowd crowd(bench, GetParam() + 2000);
    std::deque<replication::Snapshot> held;
    int replayed = 0;
    for (int tick = 0; tick < kTicks; ++tick) {
        crowd.act();
        bench.match.tick();
        bench.match.drain_outgoing();
        const replication::Snapshot truth = bench.match.snapshot();
        if (!bench.match.snapshot_is_due() || truth.phase == game::Phase::kWaiting) continue;
        if (!held.empty() && truth.tick <= held.back().tick) continue;
        const EventLog& log = bench.match.events();
        while (!held.empty() && !log.reaches_back_to(held.front().tick)) held.pop_front();
        if (held.size() > 8) held.pop_front();
        if (!held.empty()) {
            const replication::Snapshot& baseline = held.front();
            const auto& level = levels[static_cast<std::size_t>(bench.match.level_number() - 1)];
            const replication::Snapshot outcome = replication::replay(
                replication::course_of(level.platform, {}), baseline, truth.tick,
                rules.snapshot_ticks, log.between(baseline.tick, truth.tick));
            ASSERT_EQ(replication::outcome_digest_of(outcome),
                      replication::outcome_digest_of(truth))
                << "from tick " << baseline.tick << " to " << truth.tick;
            ++replayed;
        }
        held.push_back(truth);
    }
    EXPECT_GT(replayed, kTicks / 4);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomMatch, ::testing::Values(1u, 2u, 3u));

TEST(MatchLaws, another_seed_is_another_match) {
    MatchBench first(busy_levels(0), 1), second(busy_levels(0), 2);
    first.join(1);
    second.join(1);
    EXPECT_NE(hash_of(first.match.snapshot()), hash_of(second.match.snapshot()));
}

TEST(MatchLaws, a_packed_arena_of_the_largest_kind_simulates_every_tick_whole) {
    auto level = quiet_level(1, physics::Disc{16.0}, 1);
    level.ai[0] = {.behaviour = Behaviour::kBruiser,
                   .difficulty = Difficulty::kExpert,
                   .count = 150,
                   .mass_kg = 0.5,
                   .thrust_n = 30.0,
                   .top_speed_mps = 12.0};
    MatchBench bench({level}, 1, game::kMaxPlayersPerArena);
    std::vector<PlayerId> players;
    for (int person = 1; person <= game::kMaxPlayersPerArena; ++person)
        players.push_back(bench.join(person));
    double unspent_s = 0.0;
    for (int tick = 0; tick < 60 * 6; ++tick) {
        for (const auto& ball : bench.match.snapshot().balls)
            if (ball.player_id != 0)
                bench.match.set_input(ball.player_id, game::command_toward(-position_of(ball)));
        unspent_s += bench.match.tick().unspent_time_s;
        bench.match.drain_outgoing();
    }
    EXPECT_EQ(unspent_s, 0.0);
    EXPECT_EQ(bench.match.totals().overruns, 0u);
    EXPECT_GT(bench.match.audit().ball_collisions, 1000u);
    EXPECT_LE(bench.match.snapshot().hits.size(), 64u);
    EXPECT_GT(bench.match.totals().hits_left_out, 0u);
}

}  // namespace
}  // namespace fts::server
