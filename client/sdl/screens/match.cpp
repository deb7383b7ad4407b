#include "client/sdl/screens/match.h"

#include <algorithm>
#include <variant>

#include "client/sdl/draw_arena.h"
#include "client/sdl/draw_balls.h"
#include "client/sdl/screens/inspector.h"
#include "client/sdl/widgets.h"
#include "client/sdl/wording.h"
#include "common/game/rules.h"

namespace fts::sdl {
namespace {

constexpr std::size_t kMaxLines = 32;

void push(std::deque<FeedLine>& lines, const std::string& text, Colour colour, double now_s) {
    if (lines.size() == kMaxLines) lines.pop_front();
    lines.push_back({text, colour, now_s});
}

Colour colour_of_player(const client::View& view, std::uint16_t player_id) {
    const auto found =
        std::ranges::find(view.players, player_id, &replication::PlayerInfo::player_id);
    return found == view.players.end() ? palette::kTextQuiet : player_colour(found->colour);
}

// Puts what a server message says into the feed, the chat or the shop.
struct Teller {
    const client::View& view;
    MatchState& state;
    double now_s;

    void operator()(const replication::KnockOff& knock_off) const {
        std::string victim = "a ball";
        if (knock_off.victim_player != 0) {
            victim = player_name(view, knock_off.victim_player);
        } else if (state.ball_names.contains(knock_off.victim_ball)) {
            victim = state.ball_names.at(knock_off.victim_ball);
        }
        const Colour colour = knock_off.shares.empty()
                                  ? palette::kTextFaint
                                  : colour_of_player(view, knock_off.shares.front().player_id);
        push(state.hud.feed, knock_off_line(view, knock_off, victim), colour, now_s);
    }
    void operator()(const replication::ChatLine& line) const {
        const bool server = line.player_id == 0;
        const std::string who = server ? "Server" : player_name(view, line.player_id);
        push(state.hud.chat, who + ": " + line.text,
             server ? palette::kTextQuiet : colour_of_player(view, line.player_id), now_s);
    }
    void operator()(const replication::PurchaseResult& result) const {
        state.shop.message = outcome_words(result.outcome);
        state.shop.good = result.outcome == replication::PurchaseOutcome::kBought ||
                          result.outcome == replication::PurchaseOutcome::kAlreadyBought;
    }
    template <typename Other>
    void operator()(const Other&) const {}
};

void remember_balls(const client::View& view, MatchState& state) {
    for (const client::BallView& ball : view.balls) {
        if (!ball.is_player) state.ball_names[ball.id] = behaviour_name(ball.behaviour);
    }
}

void draw_arena(Canvas& canvas, const client::View& view, MatchState& state) {
    std::optional<physics::Vec2d> own_m;
    if (view.own_ball) own_m = view.balls[*view.own_ball].position_m;
    const double dt_s = state.drawn_s < 0.0 ? 0.0 : canvas.time_s - state.drawn_s;
    state.camera.update(view.level.platform, own_m, stage_of(canvas), canvas.type.unit,
                        state.camera_mode, dt_s);
    state.effects.observe(view, canvas.time_s);
    draw_background(canvas);
    draw_platform(canvas, state.camera, view.level.platform);
    draw_coins(canvas, state.camera, view.coins);
    state.effects.draw_below_balls(canvas, state.camera);
    if (state.hud.ghost) draw_ghost(canvas, state.camera, view);
    draw_balls(canvas, state.camera, view, {state.hud.velocity_arrows, state.hud.momentum_arrows});
    state.effects.draw_above_balls(canvas, state.camera);
}

std::optional<std::string> draw_chat_line(Canvas& canvas, MatchState& state) {
    const Layer layer("chat", canvas);
    const float left = canvas.px(space::kMargin);
    const float top = canvas.size.y - canvas.px(space::kMargin + 142 + 32);
    const Box box{{left, top}, {left + canvas.px(340), top + canvas.px(34)}};
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    if (!text_field(canvas, box, "##chat", "Say something; Enter sends", state.draft,
                    game::kMaxChatBytes)) {
        return std::nullopt;
    }
    const std::string said = state.draft;
    state.draft.clear();
    state.chatting = false;
    if (said.empty()) return std::nullopt;
    return said;
}

void draw_pause(Canvas& canvas, MatchState& state, MatchChoice& choice) {
    const Layer layer("pause", canvas);
    const Box whole = canvas.whole();
    canvas.list->AddRectFilled(whole.min, whole.max, fade(palette::kVeil, 0.72));
    const Box box = canvas.centred(360, 306);
    canvas.panel(box);
    const float middle = box.centre().x;
    canvas.text_middle({middle, box.min.y + canvas.px(44)}, TextStyle::kHeading, palette::kText,
                       "Menu", Align::kCentre);
    canvas.text_middle({middle, box.min.y + canvas.px(72)}, TextStyle::kCaption,
                       palette::kTextFaint, "The match goes on meanwhile.", Align::kCentre);
    float y = box.min.y + canvas.px(100);
    const auto row = [&] {
        const Box place{{box.min.x + canvas.px(40), y},
                        {box.max.x - canvas.px(40), y + canvas.px(space::kButtonHeight)}};
        y = place.max.y + canvas.px(14);
        return place;
    };
    if (button(canvas, row(), "Back to the match", ButtonKind::kPrimary)) state.paused = false;
    focus_by_default();
    if (button(canvas, row(), "Leave", ButtonKind::kPlain)) choice.leave = true;
    if (button(canvas, row(), "Quit", ButtonKind::kPlain)) choice.quit = true;
}

}  // namespace

bool shows_laws(const MatchState& state) {
    return state.inspecting || state.hud.velocity_arrows || state.hud.momentum_arrows;
}

bool steers(const MatchState& state, const client::View& view) {
    return !state.inspecting && !state.paused && !state.chatting &&
           view.phase != game::Phase::kShop;
}

void apply(const Actions& actions, MatchState& state, const client::View& view) {
    if (actions.back) {
        if (state.chatting || state.inspecting) {
            state.chatting = state.inspecting = false;
        } else {
            state.paused = !state.paused;
        }
    }
    if (state.chatting || state.paused) return;
    if (actions.inspector) state.inspecting = !state.inspecting;
    if (actions.velocities) state.hud.velocity_arrows = !state.hud.velocity_arrows;
    if (actions.momenta) state.hud.momentum_arrows = !state.hud.momentum_arrows;
    if (actions.ghost) state.hud.ghost = !state.hud.ghost;
    if (actions.keys) state.hud.shows_keys = !state.hud.shows_keys;
    if (actions.camera) {
        state.camera_mode =
            state.camera_mode == CameraMode::kWhole ? CameraMode::kFollow : CameraMode::kWhole;
    }
    if (actions.chat && !state.inspecting && view.phase != game::Phase::kShop) {
        state.chatting = true;
    }
}

void count_dash(const game::InputCommand& command, const client::View& view, double dt_s,
                HudState& hud) {
    hud.dash_ready_in_s = std::max(0.0, hud.dash_ready_in_s - std::max(dt_s, 0.0));
    const bool moves = view.own_ball && view.phase == game::Phase::kPlaying;
    if (!moves) {
        hud.dash_ready_in_s = 0.0;
    } else if (command.dash && hud.dash_ready_in_s <= 0.0 && !game::thrust_of(command).isZero()) {
        hud.dash_ready_in_s = game::stats_for(view.tiers).dash_recharge_s;
    }
}

void take_notices(const std::vector<client::Notice>& notices, const client::View& view,
                  MatchState& state, double now_s) {
    for (const client::Notice& notice : notices) {
        std::visit(Teller{view, state, now_s}, notice.message);
    }
}

MatchChoice draw_match(Canvas& canvas, const client::View& view, MatchState& state,
                       std::optional<int> slot) {
    MatchChoice choice;
    remember_balls(view, state);
    {
        const Layer layer("match", canvas, true);
        draw_arena(canvas, view, state);
        const bool covered = state.inspecting || view.phase == game::Phase::kShop;
        if (!covered) {
            draw_hud(canvas, view, state.hud);
            draw_announcement(canvas, state.camera, view);
        }
    }
    state.drawn_s = canvas.time_s;
    if (view.phase == game::Phase::kShop && !state.inspecting) {
        const ShopChoice shop =
            draw_shop(canvas, view, state.shop, state.paused ? std::nullopt : slot);
        choice.buy = shop.buy;
        choice.ready = shop.ready;
    } else if (view.phase != game::Phase::kShop) {
        state.shop = {};
    }
    if (state.inspecting && draw_inspector(canvas, view)) state.inspecting = false;
    if (state.chatting) choice.chat = draw_chat_line(canvas, state);
    if (state.paused) draw_pause(canvas, state, choice);
    return choice;
}

}  // namespace fts::sdl
