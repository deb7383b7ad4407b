// Every screen at the sizes people play at, drawn from made-up views into memory.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "client/sdl/draw_balls.h"
#include "client/sdl/screens/inspector.h"
#include "client/sdl/screens/match.h"
#include "client/sdl/screens/menu.h"
#include "client/sdl/screens/notice.h"
#include "client/sdl/screens/shop.h"
#include "tests/client_sdl/fabricated_views.h"
#include "tests/client_sdl/offscreen.h"

namespace fts::sdl {
namespace {

struct Scene {
    std::string name;
    std::function<void(Canvas&)> draw;
};

std::function<void(Canvas&)> match_of(const client::View& view, MatchState state = {}) {
    auto held = std::make_shared<MatchState>(std::move(state));
    return [view, held](Canvas& canvas) { draw_match(canvas, view, *held, std::nullopt); };
}

// A client that has been played for a while.
MatchState lively() {
    MatchState state;
    state.hud.feed = {
        {"David knocked off Chaser  +5 coins", player_colour(0), 9.0},
        {"Ana knocked off Kolmogorov, helped by David and Bruiser", player_colour(1), 9.5},
        {"Coward fell", palette::kTextFaint, 9.9}};
    state.hud.chat = {
        {"Ana: watch the edge \xe2\x80\x93 the heavy one is slow", player_colour(1), 8.0},
        {"Server: the next level starts in 20 s", palette::kTextQuiet, 9.0}};
    state.hud.dash_ready_in_s = 1.3;
    return state;
}

std::vector<Scene> every_screen() {
    auto menu = std::make_shared<MenuState>(MenuState{"David", "play.example.org:7777", ""});
    auto failed = std::make_shared<MenuState>(MenuState{
        "", "",
        "\"nowhere.invalid\" cannot be found. Check the spelling, or give an address such "
        "as 192.0.2.1:7777."});
    auto shop = std::make_shared<ShopState>();
    MatchState arrows = lively();
    arrows.hud.velocity_arrows = arrows.hud.momentum_arrows = true;
    MatchState inspecting = lively();
    inspecting.inspecting = true;
    MatchState paused = lively();
    paused.paused = true;
    MatchState chatting = lively();
    chatting.chatting = true;
    MatchState following = lively();
    following.camera_mode = CameraMode::kFollow;
    client::View no_hit = match_view();
    no_hit.last_own_hit.reset();
    return {
        {"menu", [menu](Canvas& canvas) { draw_menu(canvas, *menu); }},
        {"menu-problem", [failed](Canvas& canvas) { draw_menu(canvas, *failed); }},
        {"connecting", [](Canvas& c) { draw_connecting(c, "play.example.org:7777", false); }},
        {"ended",
         [](Canvas& c) {
             draw_ended(c, "The server does not answer",
                        "No answer from 203.0.113.7:7777. Is the server running, and UDP port 7777 "
                        "open?");
         }},
        {"ended-key",
         [](Canvas& c) {
             draw_ended(
                 c, "The server's key has changed",
                 "The server at 203.0.113.7:7777 has another key than the one it had before: "
                 "it was set up anew, or somebody poses as it. If its host confirms the new "
                 "key, remove the line of 203.0.113.7:7777 from known_servers in the data "
                 "folder and join again.");
         }},
        {"match", match_of(match_view(), lively())},
        {"match-arrows", match_of(match_view(), arrows)},
        {"match-rectangle", match_of(rectangle_view(), lively())},
        {"match-ring", match_of(ring_view(), lively())},
        {"match-crowded", match_of(crowded_view(), arrows)},
        {"match-follow", match_of(match_view(), following)},
        {"match-fallen", match_of(fallen_view(), lively())},
        {"countdown", match_of(countdown_view(), lively())},
        {"pause", match_of(match_view(), paused)},
        {"chat", match_of(match_view(), chatting)},
        {"shop", match_of(shop_view(), lively())},
        {"inspector", match_of(match_view(), inspecting)},
        {"inspector-empty", match_of(no_hit, inspecting)},
    };
}

class EveryScreen : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(EveryScreen, draws_something_and_keeps_its_words_inside_the_window) {
    for (const Scene& scene : every_screen()) {
        SCOPED_TRACE(scene.name);
        Offscreen window(GetParam().first, GetParam().second);
        // Three frames a little apart, so that trails and sparks have something to show.
        for (const double time_s : {9.95, 10.0, 10.12}) window.frame(time_s, scene.draw);
        window.keep(scene.name);
        EXPECT_GT(window.drawn_share(), 0.3);
        EXPECT_GT(window.glyphs(), 20);
        EXPECT_EQ(window.glyphs_outside(), 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, EveryScreen,
                         testing::Values(std::pair{1280, 720}, std::pair{1920, 1080}));

}  // namespace
}  // namespace fts::sdl
