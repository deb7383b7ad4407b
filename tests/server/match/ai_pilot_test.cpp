#include <set>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "common/game/movement.h"
#include "common/game/rules.h"
#include "server/ai/pilot.h"

namespace fts::server::ai {
namespace {

using game::Behaviour;
using game::Difficulty;
using physics::Vec2d;

const physics::Platform kPlatforms[] = {physics::Disc{10.0}, physics::Rectangle{{14.0, 6.0}},
                                        physics::Ring{4.0, 12.0}};

SeenBall seen(std::uint16_t id, Vec2d position, bool is_player) {
    return {.id = id,
            .is_player = is_player,
            .behaviour = Behaviour::kChaser,
            .position_m = position,
            .velocity_mps = Vec2d::Zero(),
            .radius_m = 0.5,
            .mass_kg = 1.0};
}

TEST(Skills, grow_with_difficulty) {
    for (int i = 1; i <= static_cast<int>(Difficulty::kExpert); ++i) {
        const Skill& worse = skill_of(static_cast<Difficulty>(i - 1));
        const Skill& better = skill_of(static_cast<Difficulty>(i));
        EXPECT_LT(better.reaction_ms, worse.reaction_ms);
        EXPECT_LT(better.decides_every_ms, worse.decides_every_ms);
        EXPECT_LT(better.aim_noise_deg, worse.aim_noise_deg);
        EXPECT_GT(better.look_ahead_s, worse.look_ahead_s);
        EXPECT_LT(static_cast<std::size_t>(ticks_of_ms(worse.reaction_ms)), Memory::kFrames);
    }
}

TEST(Pilot, sees_the_world_as_it_was_a_reaction_time_ago) {
    for (int i = 0; i <= static_cast<int>(Difficulty::kExpert); ++i) {
        const auto difficulty = static_cast<Difficulty>(i);
        const int delay = ticks_of_ms(skill_of(difficulty).reaction_ms);
        const int period = ticks_of_ms(skill_of(difficulty).decides_every_ms);
        Pilot pilot(Behaviour::kBruiser, difficulty, 5);
        Memory memory;
        // The player is on the left, and at tick 100 it is on the right at once.
        int turned_at = 0;
        for (int tick = 0; tick < 200 && turned_at == 0; ++tick) {
            const Vec2d player{tick < 100 ? -6.0 : 6.0, 0.0};
            const auto command = pilot.command(1, game::stats_for({}), kPlatforms[0], memory);
            if (command.thrust_x > 0) turned_at = tick;
            memory.remember({seen(1, {0.0, 0.0}, false), seen(2, player, true)});
        }
        EXPECT_GT(turned_at, 100 + delay);
        EXPECT_LE(turned_at, 100 + delay + 1 + period);
    }
}

TEST(Pilot, holds_its_decision_until_the_next_one) {
    for (int i = 0; i <= static_cast<int>(Difficulty::kExpert); ++i) {
        const auto difficulty = static_cast<Difficulty>(i);
        Pilot pilot(Behaviour::kChaser, difficulty, 9);
        Memory memory;
        memory.remember({seen(1, {0.0, 0.0}, false), seen(2, {6.0, 0.0}, true)});
        game::InputCommand last;
        int changed_at = -1000;
        for (int tick = 0; tick < 60 * 60; ++tick) {
            const auto command = pilot.command(1, game::stats_for({}), kPlatforms[0], memory);
            if (command == last) continue;
            EXPECT_GE(tick - changed_at, ticks_of_ms(skill_of(difficulty).decides_every_ms));
            changed_at = tick;
            last = command;
        }
        EXPECT_GT(changed_at, 60 * 30) << "it should aim anew now and then";
    }
}

TEST(Pilot, keeps_to_what_it_does_while_it_wants_nearly_the_same) {
    for (int i = 0; i <= static_cast<int>(Difficulty::kExpert); ++i) {
        const auto difficulty = static_cast<Difficulty>(i);
        const Skill& skill = skill_of(difficulty);
        // How often it changes its mind in a minute after a player who keeps turning.
        const auto changes = [&](double turning_deg_per_s) {
            Pilot pilot(Behaviour::kBruiser, difficulty, 3);
            Memory memory;
            game::InputCommand last;
            int count = 0;
            for (int tick = 0; tick < 60 * 60; ++tick) {
                const double angle = turning_deg_per_s * tick / 60.0 * 3.14159265 / 180.0;
                const Vec2d player = Vec2d(std::cos(angle), std::sin(angle)) * 6.0;
                memory.remember({seen(1, {0.0, 0.0}, false), seen(2, player, true)});
                const auto command = pilot.command(1, game::stats_for({}), kPlatforms[0], memory);
                count += command == last ? 0 : 1;
                last = command;
            }
            return count;
        };
        EXPECT_LE(changes(0.0), 61);
        EXPECT_GT(changes(0.0), 6);
        EXPECT_LE(changes(0.5 * skill.aim_noise_deg), 61);
        EXPECT_GT(changes(20.0 * skill.aim_noise_deg), 120);
    }
}

TEST(Pilot, steers_in_no_more_directions_than_its_aim_can_tell_apart) {
    for (int i = 0; i <= static_cast<int>(Difficulty::kExpert); ++i) {
        const auto difficulty = static_cast<Difficulty>(i);
        Pilot pilot(Behaviour::kBruiser, difficulty, 8);
        Memory memory;
        std::set<std::pair<int, int>> directions;
        for (int tick = 0; tick < 60 * 600; ++tick) {
            const Vec2d player = Vec2d(std::cos(0.01 * tick), std::sin(0.01 * tick)) * 6.0;
            memory.remember({seen(1, {0.0, 0.0}, false), seen(2, player, true)});
            const auto command = pilot.command(1, game::stats_for({}), kPlatforms[0], memory);
            if (command != game::InputCommand{}) {
                directions.insert({command.thrust_x, command.thrust_y});
            }
        }
        const double apart_deg = 360.0 / static_cast<double>(directions.size());
        EXPECT_LE(apart_deg, 2.0 * skill_of(difficulty).aim_noise_deg);
        EXPECT_GT(apart_deg, 0.9 * skill_of(difficulty).aim_noise_deg);
        for (const auto& [x, y] : directions) EXPECT_TRUE(directions.contains({-y, x}));
    }
}

TEST(Pilot, aims_with_the_noise_of_its_difficulty) {
    for (int i = 0; i <= static_cast<int>(Difficulty::kExpert); ++i) {
        const auto difficulty = static_cast<Difficulty>(i);
        Pilot pilot(Behaviour::kBruiser, difficulty, 21);
        Memory memory;
        memory.remember({seen(1, {0.0, 0.0}, false), seen(2, {6.0, 0.0}, true)});
        double sum2 = 0.0;
        int count = 0;
        for (int tick = 0; tick < 24 * 2000; ++tick) {
            const auto command = pilot.command(1, game::stats_for({}), kPlatforms[0], memory);
            if (tick < 60) continue;
            const double angle =
                std::atan2(command.thrust_y, command.thrust_x) * 180.0 / 3.14159265;
            sum2 += angle * angle;
            ++count;
        }
        const double noise = skill_of(difficulty).aim_noise_deg;
        EXPECT_NEAR(std::sqrt(sum2 / count), noise, 0.1 * noise + 0.2);
    }
}

TEST(Pilot, gives_the_same_commands_for_the_same_seed) {
    Pilot first(Behaviour::kChaser, Difficulty::kNovice, 4);
    Pilot second(Behaviour::kChaser, Difficulty::kNovice, 4);
    Memory memory;
    for (int tick = 0; tick < 600; ++tick) {
        memory.remember({seen(1, {0.01 * tick, 0.0}, false), seen(2, {6.0, -3.0}, true)});
        EXPECT_EQ(first.command(1, game::stats_for({}), kPlatforms[1], memory),
                  second.command(1, game::stats_for({}), kPlatforms[1], memory));
    }
}

using Soloist = std::tuple<int, int, int>;  // behaviour, difficulty, platform
class AloneOnAPlatform : public ::testing::TestWithParam<Soloist> {
  protected:
    // Alone, or after a player who runs in circles close to the edge and cannot be touched.
    void expect_to_stay(bool with_bait) {
        const auto [behaviour, difficulty, platform_index] = GetParam();
        const physics::Platform& platform = kPlatforms[platform_index];
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            game::BallStats stats = game::stats_for({});
            stats.thrust_n = 6.0;
            stats.top_speed_mps = 6.0;
            physics::Scene scene;
            scene.platform = platform;
            physics::World<double> world(scene);
            const auto id = *world.add({.position_m = {5.0, 1.0}, .velocity_mps = {2.0, 2.0}});
            Pilot pilot(static_cast<Behaviour>(behaviour), static_cast<Difficulty>(difficulty),
                        seed);
            Memory memory;
            game::DashState dash;
            for (int tick = 0; tick < 60 * 60; ++tick) {
                const auto body = world.body(id);
                Frame frame{seen(1, body.position_m, false)};
                frame[0].velocity_mps = body.velocity_mps;
                if (with_bait) frame.push_back(bait(platform, tick));
                memory.remember(frame);
                const auto command = pilot.command(1, stats, platform, memory);
                const game::Handling handling = game::handling_of(stats);
                world.set_control(id, game::control_for(handling, command));
                if (game::advance_dash(dash, stats, command, game::kTickRateHz)) {
                    world.set_velocity(id, body.velocity_mps + game::dash_for(handling, command));
                }
                world.step(game::kTickDurationS);
                ASSERT_TRUE(world.contains(id)) << "fell at tick " << tick;
                ASSERT_LE(world.body(id).velocity_mps.norm(),
                          stats.top_speed_mps + stats.dash_speed_mps + 1e-9);
            }
        }
    }

  private:
    static SeenBall bait(const physics::Platform& platform, int tick) {
        const double angle = tick * 0.01;
        const Vec2d far = Vec2d(std::cos(angle), std::sin(angle)) * 100.0;
        const Vec2d edge = physics::nearest_edge_point_m(platform, far);
        return seen(2, edge * 0.9, true);
    }
};

TEST_P(AloneOnAPlatform, it_does_not_fall_in_a_minute) {
    expect_to_stay(false);
}
TEST_P(AloneOnAPlatform, it_does_not_follow_a_bait_over_the_edge) {
    expect_to_stay(true);
}

INSTANTIATE_TEST_SUITE_P(All, AloneOnAPlatform,
                         ::testing::Combine(::testing::Range(0, 6), ::testing::Range(1, 5),
                                            ::testing::Range(0, 3)));

}  // namespace
}  // namespace fts::server::ai
