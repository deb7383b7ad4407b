// Every screen at the sizes people play at, drawn from made-up views into memory.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
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

client::View hit_view(double own_kg, double other_kg, const physics::Vec2d& other_mps,
                      const physics::Vec2d& own_mps = {4.6, 1.9}) {
    client::View view = match_view();
    view.last_own_hit = oblique_hit(own_kg, other_kg, other_mps, own_mps);
    view.last_own_hit->other.ball = 8;
    return view;
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
        {"inspector-both-move", match_of(hit_view(0.8, 4.0, {-3.1, 2.2}), inspecting)},
        {"inspector-was-hit", match_of(hit_view(1.0, 1.0, {-5.0, -4.0}, {0.0, 0.02}), inspecting)},
        {"inspector-empty", match_of(no_hit, inspecting)},
    };
}

class EveryScreen : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(EveryScreen, draws_something_and_keeps_its_words_inside_the_window) {
    Offscreen window(GetParam().first, GetParam().second);
    for (const Scene& scene : every_screen()) {
        SCOPED_TRACE(scene.name);
        window.frame(9.0, [](Canvas&) {});  // so that the screen appears anew
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

// Where the camera of a settled match puts a ball.
ImVec2 place_of(const Offscreen& window, const client::View& view, std::size_t ball) {
    Canvas canvas;
    canvas.size = {static_cast<float>(window.width()), static_cast<float>(window.height())};
    canvas.type.unit = unit_for(canvas.size);
    Camera camera;
    camera.update(view.level.platform, std::nullopt, stage_of(canvas), canvas.type.unit,
                  CameraMode::kWhole, 0.0);
    return camera.to_screen(view.balls[ball].position_m);
}

int distance(Colour a, Colour b) {
    int sum = 0;
    for (const unsigned shift : {0U, 8U, 16U}) {
        sum += std::abs(static_cast<int>((a >> shift) & 0xffU) -
                        static_cast<int>((b >> shift) & 0xffU));
    }
    return sum;
}

TEST(Match, shows_each_player_in_their_colour_where_the_camera_has_their_ball) {
    for (const auto& [width, height] : {std::pair{1280, 720}, {1920, 1080}, {1024, 768}}) {
        Offscreen window(width, height);
        const client::View view = match_view();
        const auto draw = match_of(view);
        for (const double time_s : {1.0, 1.02}) window.frame(time_s, draw);
        for (const std::size_t ball : {std::size_t{0}, std::size_t{1}}) {
            const Colour wanted = player_colour(view.balls[ball].colour);
            const Colour other = player_colour(view.balls[1 - ball].colour);
            const Colour seen = window.pixel(place_of(window, view, ball));
            EXPECT_LT(distance(seen, wanted), 120) << ball;
            EXPECT_LT(distance(seen, wanted), distance(seen, other)) << ball;
        }
    }
}

TEST(Match, rings_the_own_ball_alone_in_white) {
    Offscreen window(1280, 720);
    const client::View view = match_view();
    const auto draw = match_of(view);
    for (const double time_s : {1.0, 1.02}) window.frame(time_s, draw);
    const auto brightest_around = [&](std::size_t ball) {
        const ImVec2 at = place_of(window, view, ball);
        int best = 0;
        // Down and to the left: no highlight, no thrust mark, no words.
        for (float out = 8; out < 24; out += 0.5F) {
            best =
                std::max(best, 765 - distance(window.pixel({at.x - out * 0.7F, at.y + out * 0.7F}),
                                              rgb(0xffffff)));
        }
        return best;
    };
    EXPECT_GT(brightest_around(0), 700);
    EXPECT_LT(brightest_around(1), 600);
}

TEST(Match, falls_silent_about_a_ball_only_after_it_has_fallen_off) {
    Offscreen window(1280, 720);
    client::View view = match_view();
    MatchState state;
    const auto draw = [&](Canvas& canvas) { draw_match(canvas, view, state, std::nullopt); };
    view.balls[2].position_m = {10.4, 0.0};
    window.frame(1.0, draw);
    window.frame(1.02, draw);
    view.balls.erase(view.balls.begin() + 2);
    window.frame(1.04, draw);
    const std::size_t falling = window.triangles();
    window.frame(3.0, draw);
    EXPECT_GT(falling, window.triangles());
}

TEST(Match, tells_knock_offs_chat_and_purchases) {
    const client::View view = match_view();
    MatchState state;
    Offscreen window(1280, 720);
    window.frame(0.0, [&](Canvas& canvas) { draw_match(canvas, view, state, std::nullopt); });
    using Kind = client::Notice::Kind;
    take_notices({{Kind::kKnockOff, replication::KnockOff{3, 0, {{1, 5, false}}}},
                  {Kind::kChat, replication::ChatLine{2, "well hit"}},
                  {Kind::kPurchase,
                   replication::PurchaseResult{9, replication::PurchaseOutcome::kTooExpensive}}},
                 view, state, 1.0);
    ASSERT_EQ(state.hud.feed.size(), 1U);
    EXPECT_EQ(state.hud.feed[0].text, "You knocked off Chaser  +5 coins");
    ASSERT_EQ(state.hud.chat.size(), 1U);
    EXPECT_EQ(state.hud.chat[0].text, "Ana: well hit");
    EXPECT_EQ(state.hud.chat[0].colour, player_colour(1));
    EXPECT_EQ(state.shop.message, "Not enough coins.");
    EXPECT_FALSE(state.shop.good);
}

TEST(Match, keeps_no_more_lines_than_anybody_reads) {
    const client::View view = match_view();
    MatchState state;
    const client::Notice line{client::Notice::Kind::kChat, replication::ChatLine{2, "spam"}};
    take_notices(std::vector<client::Notice>(5000, line), view, state, 1.0);
    EXPECT_LE(state.hud.chat.size(), 64U);
}

TEST(Match, steers_only_while_nothing_lies_over_it) {
    MatchState state;
    const client::View playing = match_view();
    EXPECT_TRUE(steers(state, playing));
    EXPECT_FALSE(steers(state, shop_view()));
    Actions inspect;
    inspect.inspector = true;
    apply(inspect, state, playing);
    EXPECT_FALSE(steers(state, playing));
    Actions back;
    back.back = true;
    apply(back, state, playing);
    EXPECT_TRUE(steers(state, playing));
    apply(back, state, playing);
    EXPECT_TRUE(state.paused);
    EXPECT_FALSE(steers(state, playing));
}

TEST(Match, counts_the_dash_down_as_the_server_does) {
    HudState hud;
    const client::View view = match_view();
    game::InputCommand dash{127, 0, false, true};
    count_dash(dash, view, 0.016, hud);
    const double recharge_s = game::stats_for(view.tiers).dash_recharge_s;
    EXPECT_DOUBLE_EQ(hud.dash_ready_in_s, recharge_s);
    count_dash(dash, view, 1.0, hud);
    EXPECT_DOUBLE_EQ(hud.dash_ready_in_s, recharge_s - 1.0);
    count_dash(dash, fallen_view(), 0.016, hud);
    EXPECT_EQ(hud.dash_ready_in_s, 0.0);
    const game::InputCommand nowhere{0, 0, false, true};
    count_dash(nowhere, view, 0.016, hud);
    EXPECT_EQ(hud.dash_ready_in_s, 0.0);
}

// Runs a screen until it has settled, then `act`s and returns the first choice that is not `none`.
template <typename Choice>
Choice choice_after(Offscreen& window, const std::function<Choice(Canvas&)>& screen,
                    const Choice& none, const std::function<void()>& act) {
    Choice choice = none;
    const auto draw = [&](Canvas& canvas) {
        const Choice now = screen(canvas);
        if (choice == none) choice = now;
    };
    double time_s = 100.0;
    const auto frames = [&](int count) {
        for (int i = 0; i < count; ++i) window.frame(time_s += 0.1, draw);
    };
    frames(15);
    act();
    frames(6);
    return choice;
}

TEST(Menu, joins_on_enter_without_anything_being_clicked) {
    Offscreen window(1280, 720);
    MenuState state{"Ana", "localhost", ""};
    const auto choice = choice_after<MenuChoice>(
        window, [&](Canvas& canvas) { return draw_menu(canvas, state); }, MenuChoice::kNone,
        [&] { window.press_key(ImGuiKey_Enter); });
    EXPECT_EQ(choice, MenuChoice::kJoin);
}

TEST(Menu, does_what_the_clicked_button_says) {
    for (const auto& [at, wanted] : {std::pair{ImVec2{200, 570}, MenuChoice::kHost},
                                     {ImVec2{400, 570}, MenuChoice::kQuit},
                                     {ImVec2{300, 515}, MenuChoice::kJoin},
                                     {ImVec2{900, 360}, MenuChoice::kNone}}) {
        Offscreen window(1280, 720);
        MenuState state;
        const auto choice = choice_after<MenuChoice>(
            window, [&](Canvas& canvas) { return draw_menu(canvas, state); }, MenuChoice::kNone,
            [&, where = at] { window.click(where); });
        EXPECT_EQ(choice, wanted) << at.x << ", " << at.y;
    }
}

TEST(Menu, takes_typed_letters_into_the_clicked_field_and_no_more_than_fit) {
    Offscreen window(1280, 720);
    MenuState state{"", "there", ""};
    const auto draw = [&](Canvas& canvas) { draw_menu(canvas, state); };
    for (int i = 0; i < 3; ++i) window.frame(i * 0.1, draw);
    window.click({300, 367});
    for (int i = 0; i < 5; ++i) window.frame(1.0 + i * 0.1, draw);
    for (int i = 0; i < 40; ++i) ImGui::GetIO().AddInputCharacter('n');
    for (int i = 0; i < 3; ++i) window.frame(2.0 + i * 0.1, draw);
    EXPECT_EQ(state.name, std::string(24, 'n'));
    EXPECT_EQ(state.address, "there");
}

TEST(Notice, lets_the_player_cancel_go_back_and_retry) {
    Offscreen window(1280, 720);
    const auto connecting = [](Canvas& canvas) { return draw_connecting(canvas, "here", false); };
    EXPECT_TRUE(choice_after<bool>(window, connecting, false, [&] { window.click({640, 458}); }));
    const auto ended = [](Canvas& canvas) { return draw_ended(canvas, "Full", "Try later."); };
    EXPECT_EQ(choice_after<NoticeChoice>(window, ended, NoticeChoice::kNone,
                                         [&] { window.press_key(ImGuiKey_Enter); }),
              NoticeChoice::kRetry);
    EXPECT_EQ(choice_after<NoticeChoice>(window, ended, NoticeChoice::kNone,
                                         [&] {
                                             window.click({530, 480});
                                         }),
              NoticeChoice::kBack);
}

struct Bought {
    std::optional<game::Stat> stat;
    bool ready = false;
    friend bool operator==(const Bought&, const Bought&) = default;
};

class Shop : public testing::Test {
  protected:
    Bought after(const std::function<void()>& act) {
        return choice_after<Bought>(
            window_,
            [this](Canvas& canvas) {
                const ShopChoice choice = draw_shop(canvas, view_, state_, slot_);
                slot_.reset();
                return Bought{choice.buy, choice.ready};
            },
            Bought{}, act);
    }

    Offscreen window_{1280, 720};
    client::View view_ = shop_view();
    ShopState state_;
    std::optional<int> slot_;
};

TEST_F(Shop, sells_the_card_that_is_clicked) {
    EXPECT_EQ(after([&] { window_.click({640, 250}); }).stat, game::Stat::kThrust);
}

TEST_F(Shop, sells_by_number) {
    EXPECT_EQ(after([&] { slot_ = 0; }).stat, game::Stat::kMass);
}

TEST_F(Shop, says_what_is_missing_instead_of_selling) {
    EXPECT_EQ(after([&] { slot_ = 3; }).stat, std::nullopt);
    EXPECT_EQ(state_.message, "Braking: Needs 7 coins more.");
    EXPECT_FALSE(state_.good);
    EXPECT_EQ(after([&] { slot_ = 5; }).stat, std::nullopt);
    EXPECT_EQ(state_.message, "Coin magnet: Fully upgraded.");
}

TEST_F(Shop, takes_enter_for_ready) {
    EXPECT_TRUE(after([&] { window_.press_key(ImGuiKey_Enter); }).ready);
}

TEST_F(Shop, is_deaf_at_first_so_that_a_hammered_key_buys_nothing) {
    Bought bought;
    const auto draw = [&](Canvas& canvas) {
        const ShopChoice choice = draw_shop(canvas, view_, state_, 0);
        if (choice.buy || choice.ready) bought = {choice.buy, choice.ready};
    };
    for (int i = 0; i < 20; ++i) {
        window_.press_key(ImGuiKey_Enter);
        window_.frame(10.0 + i * 0.03, draw);
    }
    EXPECT_EQ(bought, Bought{});
    window_.frame(12.0, draw);
    EXPECT_EQ(bought.stat, game::Stat::kMass);
}

TEST(Pause, leaves_quits_or_goes_back) {
    const client::View view = match_view();
    const auto run = [&](ImVec2 at) {
        Offscreen window(1280, 720);
        MatchState state;
        state.paused = true;
        return choice_after<int>(
            window,
            [&](Canvas& canvas) {
                const MatchChoice choice = draw_match(canvas, view, state, std::nullopt);
                return choice.leave ? 1 : choice.quit ? 2 : state.paused ? 0 : 3;
            },
            0, [&] { window.click(at); });
    };
    EXPECT_EQ(run({640, 330}), 3);
    EXPECT_EQ(run({640, 390}), 1);
    EXPECT_EQ(run({640, 450}), 2);
}

}  // namespace
}  // namespace fts::sdl
