#include "client/sdl/hud.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "client/sdl/draw_balls.h"
#include "client/sdl/widgets.h"
#include "client/sdl/wording.h"
#include "common/game/rules.h"

namespace fts::sdl {
namespace {

constexpr double kFeedS = 7.0, kChatS = 14.0, kFadeS = 1.0;
constexpr double kHurryS = 10.0;
constexpr std::size_t kFeedLines = 5, kChatLines = 5;

double remaining_opacity(const FeedLine& line, double lasts_s, double now_s) {
    return std::clamp((lasts_s - (now_s - line.born_s)) / kFadeS, 0.0, 1.0);
}

void draw_level(const Canvas& canvas, const client::View& view) {
    const float left = canvas.px(space::kMargin), width = canvas.px(space::kSidePanel);
    float y = canvas.px(space::kMargin);
    std::string number = "LEVEL " + std::to_string(view.level.number);
    if (view.level.level_count > 0) number += " OF " + std::to_string(view.level.level_count);
    canvas.text({left, y}, TextStyle::kCaption, palette::kTextFaint, number);
    y += canvas.px(18);
    canvas.text({left, y}, TextStyle::kHeading, palette::kText,
                canvas.elided(TextStyle::kHeading, view.level.name, width));
    y += canvas.px(36);
    if (view.phase != game::Phase::kPlaying) return;
    const bool hurry = view.phase_remaining_s > 0.0 && view.phase_remaining_s < kHurryS;
    canvas.text({left, y}, TextStyle::kTitle, hurry ? palette::kBad : palette::kText,
                view.phase_remaining_s > 0.0 ? clock_time(view.phase_remaining_s) : "no limit");
    const auto ai_left = std::ranges::count_if(
        view.balls, [](const client::BallView& ball) { return !ball.is_player; });
    const std::string balls =
        ai_left == 1 ? "1 ball to knock off" : std::to_string(ai_left) + " balls to knock off";
    canvas.text({left, y + canvas.px(46)}, TextStyle::kBody, palette::kTextQuiet, balls);
}

void draw_feed(const Canvas& canvas, const HudState& state) {
    const float left = canvas.px(space::kMargin);
    const float width = canvas.px(space::kSidePanel);
    float y = canvas.px(space::kMargin + 152);
    const std::size_t skipped = state.feed.size() > kFeedLines ? state.feed.size() - kFeedLines : 0;
    for (std::size_t i = skipped; i < state.feed.size(); ++i) {
        const FeedLine& line = state.feed[i];
        const double opacity = remaining_opacity(line, kFeedS, canvas.time_s);
        if (opacity <= 0.0) continue;
        canvas.list->AddRectFilled({left, y + canvas.px(1)},
                                   {left + canvas.px(2.5F), y + canvas.px(15)},
                                   fade(line.colour, opacity), canvas.px(1));
        y += canvas.paragraph({left + canvas.px(10), y}, width - canvas.px(10), TextStyle::kCaption,
                              fade(palette::kText, 0.9 * opacity), line.text);
        y += canvas.px(6);
    }
}

void draw_chat(const Canvas& canvas, const HudState& state) {
    const float left = canvas.px(space::kMargin), width = canvas.px(space::kSidePanel + 60);
    float y = canvas.size.y - canvas.px(space::kMargin + 236);
    const std::size_t skipped = state.chat.size() > kChatLines ? state.chat.size() - kChatLines : 0;
    for (std::size_t i = skipped; i < state.chat.size(); ++i) {
        const FeedLine& line = state.chat[i];
        const double opacity = remaining_opacity(line, kChatS, canvas.time_s);
        if (opacity > 0.0) {
            canvas.text({left, y}, TextStyle::kCaption, fade(line.colour, opacity),
                        canvas.elided(TextStyle::kCaption, line.text, width));
        }
        y += canvas.px(18);
    }
}

void draw_lives(const Canvas& canvas, ImVec2 at, int lives, Colour colour, float radius) {
    for (int i = 0; i < game::kLivesPerLevel; ++i) {
        const ImVec2 centre{at.x + (radius * 2.8F) * static_cast<float>(i) + radius, at.y};
        if (i < lives) {
            canvas.list->AddCircleFilled(centre, radius, colour, segments_for(radius));
        } else {
            canvas.ring(centre, radius - 0.5F, fade(palette::kTextFaint, 0.7),
                        std::max(1.0F, canvas.px(1)));
        }
    }
}

void draw_dash(const Canvas& canvas, ImVec2 at, float width, const client::View& view,
               const HudState& state) {
    const double recharge_s = game::stats_for(view.tiers).dash_recharge_s;
    const double charge = std::clamp(1.0 - state.dash_ready_in_s / recharge_s, 0.0, 1.0);
    const bool ready = charge >= 1.0;
    canvas.text(at, TextStyle::kCaption, ready ? palette::kText : palette::kTextFaint,
                ready ? "Dash ready" : "Dash " + fixed(state.dash_ready_in_s, 1) + " s");
    const float y = at.y + canvas.px(20), height = canvas.px(4);
    canvas.list->AddRectFilled({at.x, y}, {at.x + width, y + height}, palette::kCard, height / 2);
    if (charge > 0.02) {
        canvas.list->AddRectFilled({at.x, y},
                                   {at.x + width * static_cast<float>(charge), y + height},
                                   ready ? palette::kAccent : palette::kTextFaint, height / 2);
    }
}

void draw_own_readings(const Canvas& canvas, const client::View& view, const HudState& state) {
    const float left = canvas.px(space::kMargin), width = canvas.px(space::kSidePanel);
    const float top = canvas.size.y - canvas.px(space::kMargin + 128);
    const replication::PlayerInfo* own = view.own_player();
    const Colour colour = own != nullptr ? player_colour(own->colour) : palette::kAccent;
    if (own != nullptr) {
        draw_lives(canvas, {left, top + canvas.px(6)}, own->lives, colour, canvas.px(6));
        const std::string lives =
            own->lives == 1 ? "1 life" : std::to_string(own->lives) + " lives";
        canvas.text_middle({left + canvas.px(62), top + canvas.px(6)}, TextStyle::kCaption,
                           palette::kTextQuiet, lives, Align::kLeft);
    }
    draw_dash(canvas, {left, top + canvas.px(26)}, width, view, state);

    struct Reading {
        const char* name;
        std::string value;
        const char* unit;
    };
    std::vector<Reading> readings = {{"speed", "\xe2\x80\x93", "m/s"},
                                     {"momentum", "\xe2\x80\x93", "N\xc2\xb7s"},
                                     {"energy", "\xe2\x80\x93", "J"}};
    if (view.own_ball) {
        const client::BallView& ball = view.balls[*view.own_ball];
        const double speed = ball.velocity_mps.norm();
        readings[0].value = fixed(speed, 1);
        readings[1].value = fixed(ball.mass_kg * speed, 1);
        readings[2].value = fixed(0.5 * ball.mass_kg * speed * speed, 1);
    }
    const float y = top + canvas.px(70);
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const float x = left + width * static_cast<float>(i) / 3.0F;
        canvas.text({x, y}, TextStyle::kCaption, palette::kTextFaint, readings[i].name);
        canvas.text({x, y + canvas.px(16)}, TextStyle::kHeading, palette::kText, readings[i].value);
        canvas.text({x, y + canvas.px(42)}, TextStyle::kCaption, palette::kTextFaint,
                    readings[i].unit);
    }
}

void draw_coins_held(const Canvas& canvas, const client::View& view) {
    const float right = canvas.size.x - canvas.px(space::kMargin);
    const float y = canvas.px(space::kMargin + 14);
    const std::string coins = std::to_string(view.coins_held);
    canvas.text_middle({right, y}, TextStyle::kTitle, palette::kGold, coins, Align::kRight,
                       canvas.px(30));
    const float width = canvas.text_width(TextStyle::kTitle, coins) * 30.0F / 36.0F;
    canvas.coin({right - width - canvas.px(20), y}, canvas.px(10));
}

void draw_player_row(const Canvas& canvas, const Box& row, const client::View& view,
                     const replication::PlayerInfo& player) {
    const bool own = player.player_id == view.own_player_id;
    const Colour colour = player_colour(player.colour);
    const float middle = row.centre().y;
    if (own) {
        canvas.list->AddRectFilled(row.min, row.max, fade(palette::kCardHover, 0.75), canvas.px(6));
    }
    const float dot = canvas.px(5);
    canvas.list->AddCircleFilled({row.min.x + canvas.px(14), middle}, dot, colour,
                                 segments_for(dot));
    const Colour ink = player.lives > 0 ? palette::kText : palette::kTextFaint;
    const std::string score = std::to_string(player.knock_offs);
    canvas.text_middle({row.max.x - canvas.px(12), middle}, TextStyle::kStrong, ink, score,
                       Align::kRight, canvas.px(15));
    const float lives = canvas.px(50);
    draw_lives(canvas, {row.max.x - canvas.px(38) - lives, middle}, player.lives, fade(colour, 0.9),
               canvas.px(3.5F));
    const float room = row.width() - canvas.px(28 + 40) - lives;
    canvas.text_middle({row.min.x + canvas.px(28), middle}, TextStyle::kBody, ink,
                       canvas.elided(TextStyle::kBody, player.name, room), Align::kLeft,
                       canvas.px(15));
}

void draw_players(const Canvas& canvas, const client::View& view) {
    constexpr std::size_t kMaxRows = 10;
    std::vector<const replication::PlayerInfo*> ranked;
    for (const auto& player : view.players) ranked.push_back(&player);
    std::ranges::stable_sort(
        ranked, [](const auto* a, const auto* b) { return a->knock_offs > b->knock_offs; });
    const float right = canvas.size.x - canvas.px(space::kMargin);
    const float left = right - canvas.px(space::kSidePanel), height = canvas.px(30);
    float y = canvas.px(space::kMargin + 56);
    canvas.text({left + canvas.px(14 - 5), y}, TextStyle::kCaption, palette::kTextFaint, "PLAYERS");
    canvas.text({right - canvas.px(12), y}, TextStyle::kCaption, palette::kTextFaint, "KNOCK-OFFS",
                Align::kRight);
    y += canvas.px(22);
    // The own row is always among those shown.
    if (ranked.size() > kMaxRows) {
        const auto own = std::ranges::find(ranked, view.own_player());
        if (own - ranked.begin() >= static_cast<std::ptrdiff_t>(kMaxRows)) {
            std::iter_swap(own, ranked.begin() + kMaxRows - 1);
        }
    }
    for (std::size_t i = 0; i < std::min(ranked.size(), kMaxRows); ++i) {
        draw_player_row(canvas, {{left, y}, {right, y + height - canvas.px(2)}}, view, *ranked[i]);
        y += height;
    }
    if (ranked.size() > kMaxRows) {
        canvas.text({left + canvas.px(28), y}, TextStyle::kCaption, palette::kTextFaint,
                    "and " + std::to_string(ranked.size() - kMaxRows) + " more");
    }
}

void draw_keys(const Canvas& canvas, const HudState& state) {
    struct Key {
        const char* cap;
        std::string does;
    };
    const std::vector<Key> keys = {
        {"W A S D", "steer"},
        {"Space", "dash"},
        {"Shift", "brake"},
        {"E", "last hit"},
        {"V", state.velocity_arrows ? "hide velocities" : "show velocities"},
        {"M", state.momentum_arrows ? "hide momenta" : "show momenta"},
        {"G", state.ghost ? "hide the ghost" : "server's ghost"},
        {"C", "camera"},
        {"T", "chat"},
        {"H", "hide these keys"},
    };
    const float left = canvas.size.x - canvas.px(space::kMargin + space::kSidePanel - 9);
    const float row = canvas.px(24);
    float y =
        canvas.size.y - canvas.px(space::kMargin + 30) - row * static_cast<float>(keys.size());
    for (const Key& key : keys) {
        key_cap(canvas, {left, y}, key.cap);
        canvas.text_middle({left + canvas.px(76), y + canvas.px(10)}, TextStyle::kCaption,
                           palette::kTextFaint, key.does, Align::kLeft);
        y += row;
    }
}

void draw_link(const Canvas& canvas, const client::View& view) {
    const ImVec2 at{canvas.size.x - canvas.px(space::kMargin),
                    canvas.size.y - canvas.px(space::kMargin + 14)};
    std::string text = fixed(view.link.rtt_s * 1000.0, 0) + " ms";
    text += ", drawn " + fixed(view.link.interpolation_delay_s * 1000.0, 0) + " ms behind";
    if (view.link.loss >= 0.005) text += "   " + fixed(view.link.loss * 100.0, 0) + " % lost";
    const bool bad = view.link.starved || view.link.loss > 0.1 || view.link.rtt_s > 0.25;
    canvas.text(at, TextStyle::kCaption, bad ? palette::kBad : palette::kTextFaint, text,
                Align::kRight);
}

// A soft dark ground that keeps words readable over balls and lines.
void draw_hush(const Canvas& canvas, ImVec2 centre, float radius) {
    canvas.gradient_ring(centre, 0, fade(palette::kInk, 0.66), radius * 0.55F,
                         fade(palette::kInk, 0.5));
    canvas.gradient_ring(centre, radius * 0.55F, fade(palette::kInk, 0.5), radius,
                         fade(palette::kInk, 0.0));
}

void announce(const Canvas& canvas, const std::string& title, const std::string& detail) {
    const ImVec2 centre = stage_of(canvas).centre();
    draw_hush(canvas, centre, canvas.px(230));
    canvas.text_middle({centre.x, centre.y - canvas.px(16)}, TextStyle::kTitle, palette::kText,
                       title, Align::kCentre);
    canvas.paragraph({centre.x, centre.y + canvas.px(14)}, canvas.px(340), TextStyle::kBody,
                     palette::kTextQuiet, detail, Align::kCentre);
}

void draw_countdown(const Canvas& canvas, const Camera& camera, const client::View& view) {
    const ImVec2 centre = stage_of(canvas).centre();
    draw_hush(canvas, centre, canvas.px(290));
    draw_own_ball(canvas, camera, view);
    canvas.text_middle({centre.x, centre.y - canvas.px(96)}, TextStyle::kCaption,
                       palette::kTextQuiet, "LEVEL " + std::to_string(view.level.number),
                       Align::kCentre);
    canvas.text_middle({centre.x, centre.y - canvas.px(68)}, TextStyle::kTitle, palette::kText,
                       view.level.name, Align::kCentre);
    const double left_s = std::max(view.phase_remaining_s, 0.0);
    const double part = left_s - std::floor(left_s);
    const float size = canvas.px(84) * static_cast<float>(1.0 + 0.12 * part * part);
    canvas.text_middle({centre.x, centre.y + canvas.px(6)}, TextStyle::kDisplay, palette::kAccent,
                       std::to_string(std::max(1, static_cast<int>(std::ceil(left_s)))),
                       Align::kCentre, size);
    canvas.paragraph({centre.x, centre.y + canvas.px(62)}, canvas.px(360), TextStyle::kBody,
                     palette::kText, view.level.hint, Align::kCentre);
}

}  // namespace

Box stage_of(const Canvas& canvas) {
    const float side = canvas.px(space::kMargin + space::kSidePanel);
    return {{side, canvas.px(12)}, {canvas.size.x - side, canvas.size.y - canvas.px(12)}};
}

void draw_hud(const Canvas& canvas, const client::View& view, const HudState& state) {
    draw_level(canvas, view);
    draw_feed(canvas, state);
    draw_chat(canvas, state);
    draw_own_readings(canvas, view, state);
    draw_coins_held(canvas, view);
    draw_players(canvas, view);
    if (state.shows_keys) draw_keys(canvas, state);
    draw_link(canvas, view);
}

void draw_announcement(const Canvas& canvas, const Camera& camera, const client::View& view) {
    const replication::PlayerInfo* own = view.own_player();
    switch (view.phase) {
        case game::Phase::kWaiting:
            announce(canvas, "Waiting", "The arena rests until somebody plays.");
            break;
        case game::Phase::kCountdown:
            draw_countdown(canvas, camera, view);
            break;
        case game::Phase::kPlaying:
            if (view.own_ball || own == nullptr) break;
            if (own->lives > 0) {
                announce(canvas, "Knocked off", "Back on the platform in a moment.");
            } else {
                announce(canvas, "Out of lives", "Watch the others finish this level.");
            }
            break;
        case game::Phase::kShop:
            break;
    }
}

}  // namespace fts::sdl
