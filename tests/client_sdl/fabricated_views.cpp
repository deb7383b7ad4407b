#include "tests/client_sdl/fabricated_views.h"

#include <cmath>
#include <string>

namespace fts::sdl {
namespace {

using client::View;
using physics::Vec2d;

constexpr std::uint16_t kOwnId = 1;

replication::PlayerInfo player(std::uint16_t id, const std::string& name, int knock_offs,
                               int lives) {
    replication::PlayerInfo info;
    info.player_id = id;
    info.name = name;
    info.colour = static_cast<std::uint8_t>(id - 1);
    info.knock_offs = knock_offs;
    info.lives = lives;
    return info;
}

void add_player_ball(View& view, std::uint16_t player_id, const Vec2d& position_m,
                     const Vec2d& velocity_mps, double mass_kg) {
    client::BallView ball;
    ball.id = static_cast<std::uint16_t>(view.balls.size() + 1);
    ball.position_m = position_m;
    ball.velocity_mps = velocity_mps;
    ball.radius_m = 0.5;
    ball.mass_kg = mass_kg;
    ball.is_player = true;
    ball.is_own = player_id == view.own_player_id;
    ball.player_id = player_id;
    for (const auto& info : view.players) {
        if (info.player_id != player_id) continue;
        ball.name = info.name;
        ball.colour = info.colour;
    }
    if (ball.is_own) view.own_ball = view.balls.size();
    view.balls.push_back(ball);
}

void add_ai_ball(View& view, game::Behaviour behaviour, const Vec2d& position_m,
                 const Vec2d& velocity_mps, double mass_kg, double radius_m) {
    client::BallView ball;
    ball.id = static_cast<std::uint16_t>(view.balls.size() + 1);
    ball.position_m = position_m;
    ball.velocity_mps = velocity_mps;
    ball.radius_m = radius_m;
    ball.mass_kg = mass_kg;
    ball.behaviour = behaviour;
    view.balls.push_back(ball);
}

View base_view() {
    View view;
    view.phase = game::Phase::kPlaying;
    view.phase_remaining_s = 83.4;
    view.own_player_id = kOwnId;
    view.players = {player(1, "David", 4, 3), player(2, "Ana", 6, 2),
                    player(3, "Kolmogorov", 1, 0)};
    view.coins_held = 47;
    view.tiers = {2, 1, 0, 3, 0, 6};
    view.level.number = 3;
    view.level.level_count = 10;
    view.level.name = "Long table";
    view.level.hint =
        "Off centre, the struck ball leaves along the line of centres; equal balls part at a right "
        "angle.";
    view.level.platform = physics::Disc{11.0};
    view.level.ai_balls = 5;
    view.link.rtt_s = 0.024;
    return view;
}

}  // namespace

client::View match_view() {
    View view = base_view();
    add_player_ball(view, 1, {-2.6, 1.4}, {3.1, 1.2}, 1.25);
    view.balls.back().thrust = {0.9, 0.3};
    add_player_ball(view, 2, {4.2, -3.8}, {-1.6, 2.8}, 1.0);
    using game::Behaviour;
    add_ai_ball(view, Behaviour::kChaser, {1.5, 3.2}, {-2.0, -1.0}, 1.0, 0.5);
    add_ai_ball(view, Behaviour::kEdgeGuard, {7.9, 1.0}, {0.2, 1.4}, 1.2, 0.5);
    add_ai_ball(view, Behaviour::kInterceptor, {-6.1, -3.0}, {2.2, 2.1}, 0.8, 0.5);
    add_ai_ball(view, Behaviour::kHerd, {0.5, -6.6}, {0.4, 0.2}, 0.6, 0.4);
    add_ai_ball(view, Behaviour::kCoward, {-4.4, 6.3}, {-1.1, 0.4}, 0.5, 0.4);
    add_ai_ball(view, Behaviour::kBruiser, {4.9, 5.6}, {-0.7, -0.9}, 4.0, 0.9);
    view.coins = {
        {1, {2.0, 0.2}, 1}, {2, {-1.0, -3.1}, 1}, {3, {-8.0, 1.0}, 5}, {4, {6.0, -6.0}, 1}};
    view.hits = {{{3.0, -1.0}, 2.5, 1, 2}, {{-5.0, 2.0}, 0.4, 3, 4}};
    view.last_own_hit = oblique_hit(1.25, 1.0, Vec2d::Zero());
    view.last_own_hit->other.ball = 3;
    return view;
}

client::View rectangle_view() {
    View view = match_view();
    view.level.platform = physics::Rectangle{{15.0, 7.0}};
    return view;
}

client::View ring_view() {
    View view = match_view();
    view.level.name = "The hole";
    view.level.platform = physics::Ring{3.0, 12.0};
    view.balls[0].position_m = {-5.2, 3.4};
    view.balls[2].position_m = {3.5, 3.2};
    return view;
}

client::View crowded_view() {
    View view = base_view();
    view.level.name = "A level with a name that goes on and on";
    view.level.platform = physics::Rectangle{{18.0, 9.0}};
    view.players.clear();
    for (int i = 0; i < 64; ++i) {
        const auto id = static_cast<std::uint16_t>(i + 1);
        view.players.push_back(
            player(id, "Wwwwwwwwwwwwwwwwwwwwwww" + std::to_string(i), i % 7, i % 4));
    }
    view.players[1].name = "\xd0\x98\xd0\xb3\xd0\xbe\xd1\x80\xd1\x8c \n \xff\xfe";
    for (int i = 0; i < 40; ++i) {
        const Vec2d at(-16.0 + 3.6 * (i % 10), -6.0 + 3.5 * (i / 10));
        const Vec2d velocity(std::sin(i * 1.3) * 6.0, std::cos(i * 2.1) * 6.0);
        if (i < 8) {
            add_player_ball(view, static_cast<std::uint16_t>(i + 1), at, velocity, 0.8 + 0.2 * i);
        } else {
            add_ai_ball(view, static_cast<game::Behaviour>(i % 6), at, velocity, 0.5 + 0.1 * i,
                        0.5);
        }
    }
    view.coins_held = 123456;
    return view;
}

client::View countdown_view() {
    View view = match_view();
    view.phase = game::Phase::kCountdown;
    view.phase_remaining_s = 2.4;
    view.hits.clear();
    for (auto& ball : view.balls) ball.velocity_mps.setZero();
    return view;
}

client::View shop_view() {
    View view = match_view();
    view.phase = game::Phase::kShop;
    view.phase_remaining_s = 14.2;
    view.last_level_end = replication::LevelEnded{3, replication::LevelOutcome::kCleared, 23};
    view.coins_held = 31;
    view.players[1].ready = true;
    return view;
}

client::View fallen_view() {
    View view = match_view();
    view.balls.erase(view.balls.begin());
    view.own_ball.reset();
    view.players[0].lives = 2;
    return view;
}

replication::CollisionReport oblique_hit(double own_kg, double other_kg,
                                         const Vec2d& other_velocity_mps,
                                         const Vec2d& own_velocity_mps) {
    replication::CollisionReport hit;
    hit.tick = 4213;
    hit.own = {1, kOwnId, own_kg, 0.5, {0.2, -0.1}, own_velocity_mps, Vec2d::Zero()};
    hit.normal = -Vec2d(std::cos(0.62), std::sin(0.62));
    hit.other = {
        2, 0, other_kg, 0.5, hit.own.position_m - hit.normal, other_velocity_mps, Vec2d::Zero()};
    const double closing =
        (hit.other.velocity_before_mps - hit.own.velocity_before_mps).dot(hit.normal);
    hit.impulse_ns = 2.0 * closing * own_kg * other_kg / (own_kg + other_kg);
    hit.own.velocity_after_mps =
        hit.own.velocity_before_mps + hit.normal * (hit.impulse_ns / own_kg);
    hit.other.velocity_after_mps =
        hit.other.velocity_before_mps - hit.normal * (hit.impulse_ns / other_kg);
    return hit;
}

}  // namespace fts::sdl
