#include "client/sdl/screens/shop.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "client/sdl/draw_arena.h"
#include "client/sdl/widgets.h"
#include "client/sdl/wording.h"

namespace fts::sdl {
namespace {

constexpr float kPanelWidth = 1136, kPanelHeight = 640;
constexpr int kColumns = 3;
// A dash that is still being hammered when the shop opens buys nothing.
constexpr double kDeafS = 0.9;

int tier_of(const game::Tiers& tiers, game::Stat stat) {
    return tiers[static_cast<std::size_t>(stat)];
}

game::Tiers raised(game::Tiers tiers, game::Stat stat) {
    auto& tier = tiers[static_cast<std::size_t>(stat)];
    if (tier < game::kMaxTier) ++tier;
    return tiers;
}

struct Effect {
    const char* title;
    const char* unit;
    double now, next;
    int decimals;
    std::string remark;
};

// What a heavier ball does, head on, to a resting ball that weighs what a new ball weighs.
std::string mass_remark(double now_kg, double next_kg) {
    const double standard_kg = game::stats_for({}).mass_kg;
    const auto speed = [&](double m) { return 200.0 * m / (m + standard_kg); };
    const auto energy = [&](double m) {
        return 400.0 * m * standard_kg / ((m + standard_kg) * (m + standard_kg));
    };
    const std::string arrow = " \xe2\x86\x92 ";
    return "A resting " + fixed(standard_kg, 1) + " kg ball leaves with " +
           fixed(speed(now_kg), 0) + arrow + fixed(speed(next_kg), 0) + " % of your speed and " +
           fixed(energy(now_kg), 1) + arrow + fixed(energy(next_kg), 1) + " % of your energy.";
}

Effect effect_of(const game::Tiers& tiers, game::Stat stat) {
    const game::BallStats now = game::stats_for(tiers);
    const game::BallStats next = game::stats_for(raised(tiers, stat));
    const auto reach_s = [](const game::BallStats& s) {
        return s.mass_kg * s.top_speed_mps / s.thrust_n;
    };
    switch (stat) {
        case game::Stat::kMass:
            return {"Mass",       "kg", now.mass_kg,
                    next.mass_kg, 2,    mass_remark(now.mass_kg, next.mass_kg)};
        case game::Stat::kThrust:
            return {"Thrust",
                    "N",
                    now.thrust_n,
                    next.thrust_n,
                    1,
                    "Speeds up at " + fixed(now.thrust_n / now.mass_kg, 1) + " \xe2\x86\x92 " +
                        fixed(next.thrust_n / next.mass_kg, 1) + " m/s\xc2\xb2 from rest."};
        case game::Stat::kTopSpeed:
            return {"Top speed",
                    "m/s",
                    now.top_speed_mps,
                    next.top_speed_mps,
                    1,
                    "63 % of it after " + fixed(reach_s(now), 2) + " \xe2\x86\x92 " +
                        fixed(reach_s(next), 2) + " s of full thrust."};
        case game::Stat::kBraking:
            return {"Braking",
                    "1/s",
                    now.braking_per_s,
                    next.braking_per_s,
                    2,
                    "Held, the brake halves your speed in " +
                        fixed(std::log(2.0) / now.braking_per_s, 2) + " \xe2\x86\x92 " +
                        fixed(std::log(2.0) / next.braking_per_s, 2) + " s."};
        case game::Stat::kDash:
            return {"Dash recharge",
                    "s",
                    now.dash_recharge_s,
                    next.dash_recharge_s,
                    2,
                    "Each dash adds " + fixed(now.dash_speed_mps, 1) + " m/s at once."};
        case game::Stat::kMagnet:
            return {"Coin magnet",       "m", now.magnet_range_m,
                    next.magnet_range_m, 2,   "Coins this far from your ball's edge are yours."};
    }
    return {"", "", 0, 0, 0, ""};
}

void draw_pips(const Canvas& canvas, ImVec2 at, int tier) {
    const float width = canvas.px(20), height = canvas.px(6), step = canvas.px(25);
    for (int i = 0; i < game::kMaxTier; ++i) {
        const float x = at.x + step * static_cast<float>(i);
        canvas.list->AddRectFilled({x, at.y}, {x + width, at.y + height},
                                   i < tier ? palette::kAccent : palette::kLine, height / 2);
    }
}

void draw_price(const Canvas& canvas, const Box& card, const client::View& view, game::Stat stat) {
    const std::optional<int> price = game::price_coins(tier_of(view.tiers, stat));
    const ImVec2 right{card.max.x - canvas.px(20), card.min.y + canvas.px(32)};
    if (!price) {
        canvas.text_middle(right, TextStyle::kStrong, palette::kGood, "Complete", Align::kRight);
        return;
    }
    const bool affordable = *price <= view.coins_held;
    const std::string text = std::to_string(*price);
    canvas.text_middle(right, TextStyle::kHeading,
                       affordable ? palette::kGold : palette::kTextFaint, text, Align::kRight);
    const float width = canvas.text_width(TextStyle::kHeading, text);
    canvas.coin({right.x - width - canvas.px(15), right.y}, canvas.px(8));
}

void draw_effect(const Canvas& canvas, const Box& card, const Effect& effect, bool last_tier) {
    const float left = card.min.x + canvas.px(20);
    float x = left;
    const float y = card.min.y + canvas.px(82);
    const auto word = [&](TextStyle style, Colour colour, const std::string& text, float units) {
        const float size = canvas.px(units);
        const float drop = (canvas.px(28) - size) * 0.4F;
        canvas.text_middle({x, y + drop}, style, colour, text, Align::kLeft, size);
        x += canvas.text_width(style, text) * size / canvas.type.size_px(style) + canvas.px(8);
    };
    word(TextStyle::kHeading, last_tier ? palette::kText : palette::kTextQuiet,
         fixed(effect.now, effect.decimals), 28);
    if (!last_tier) {
        word(TextStyle::kHeading, palette::kTextFaint, "\xe2\x86\x92", 22);
        word(TextStyle::kHeading, palette::kText, fixed(effect.next, effect.decimals), 28);
    }
    word(TextStyle::kBody, palette::kTextFaint, effect.unit, 16);
}

bool draw_card(const Canvas& canvas, const Box& card, const client::View& view, int slot) {
    const auto stat = static_cast<game::Stat>(slot);
    const Effect effect = effect_of(view.tiers, stat);
    const int tier = tier_of(view.tiers, stat);
    const std::string blocked = obstacle(view, stat);
    const Touch touch = touch_area(canvas, card, effect.title);
    const Colour fill = touch.focused ? palette::kCardHover : palette::kCard;
    canvas.panel(card, fill, touch.focused && blocked.empty() ? palette::kAccent : palette::kLine);

    const float left = card.min.x + canvas.px(20);
    const std::string number = std::to_string(slot + 1);
    const float cap = key_cap(canvas, {left, card.min.y + canvas.px(22)}, number.c_str());
    canvas.text_middle({left + cap + canvas.px(12), card.min.y + canvas.px(32)},
                       TextStyle::kHeading, palette::kText, effect.title, Align::kLeft);
    draw_price(canvas, card, view, stat);
    draw_effect(canvas, card, effect, tier >= game::kMaxTier);
    canvas.paragraph({left, card.min.y + canvas.px(112)}, card.width() - canvas.px(40),
                     TextStyle::kCaption, palette::kTextQuiet, effect.remark);
    const float foot = card.max.y - canvas.px(24);
    draw_pips(canvas, {left, foot - canvas.px(3)}, tier);
    const bool complete = tier >= game::kMaxTier;
    if (!complete) {
        canvas.text_middle({card.max.x - canvas.px(20), foot}, TextStyle::kCaption,
                           blocked.empty() ? palette::kGood : palette::kTextFaint,
                           blocked.empty() ? "Buy" : blocked, Align::kRight);
    }
    return touch.pressed;
}

std::string heading(const client::View& view) {
    if (!view.last_level_end) return "Between levels";
    std::string level = "Level " + std::to_string(view.last_level_end->number);
    switch (view.last_level_end->outcome) {
        case replication::LevelOutcome::kCleared:
            return level + " cleared";
        case replication::LevelOutcome::kLost:
            return level + " lost";
        case replication::LevelOutcome::kTimeUp:
            return level + ": time is up";
        case replication::LevelOutcome::kCampaignComplete:
            return "Every level cleared";
    }
    return level;
}

void draw_head(const Canvas& canvas, const Box& panel, const client::View& view) {
    const float left = panel.min.x + canvas.px(32), top = panel.min.y + canvas.px(24);
    canvas.text({left, top}, TextStyle::kTitle, palette::kText, heading(view));
    const std::string earned =
        view.last_level_end ? "You earned " + coins_text(view.last_level_end->coins_earned) + ". "
                            : "";
    canvas.text({left, top + canvas.px(48)}, TextStyle::kBody, palette::kTextQuiet,
                earned + "Spend them on what your ball is made of.");
    const float right = panel.max.x - canvas.px(32);
    const std::string coins = std::to_string(view.coins_held);
    const float middle = top + canvas.px(22);
    canvas.text_middle({right, middle}, TextStyle::kTitle, palette::kGold, coins, Align::kRight);
    canvas.coin({right - canvas.text_width(TextStyle::kTitle, coins) - canvas.px(24), middle},
                canvas.px(13));
    canvas.text({right, top + canvas.px(48)}, TextStyle::kBody, palette::kTextQuiet,
                "Next level in " + clock_time(view.phase_remaining_s), Align::kRight);
}

void draw_players_ready(const Canvas& canvas, ImVec2 at, float room, const client::View& view) {
    float x = at.x;
    for (const auto& player : view.players) {
        const std::string name = canvas.elided(TextStyle::kCaption, player.name, canvas.px(110));
        const float width = canvas.text_width(TextStyle::kCaption, name) + canvas.px(40);
        if (x + width > at.x + room) {
            canvas.text_middle({x, at.y}, TextStyle::kCaption, palette::kTextFaint, "\xe2\x80\xa6",
                               Align::kLeft);
            return;
        }
        const float dot = canvas.px(5);
        const Colour colour = player_colour(player.colour);
        if (player.ready) {
            canvas.list->AddCircleFilled({x + dot, at.y}, dot, colour, segments_for(dot));
        } else {
            canvas.ring({x + dot, at.y}, dot - 0.5F, colour, canvas.px(1.5F));
        }
        canvas.text_middle({x + canvas.px(18), at.y}, TextStyle::kCaption,
                           player.ready ? palette::kText : palette::kTextFaint, name, Align::kLeft);
        x += width;
    }
}

bool draw_foot(const Canvas& canvas, const Box& panel, const client::View& view,
               const ShopState& state) {
    const float right = panel.max.x - canvas.px(32), bottom = panel.max.y - canvas.px(26);
    const float left = panel.min.x + canvas.px(32), width = canvas.px(210);
    const Box box{{right - width, bottom - canvas.px(space::kButtonHeight)}, {right, bottom}};
    const replication::PlayerInfo* own = view.own_player();
    const bool ready = own != nullptr && own->ready;
    const float room = box.min.x - left - canvas.px(24);
    const float middle = box.centre().y;
    if (state.message.empty()) {
        draw_players_ready(canvas, {left, middle}, room, view);
    } else {
        canvas.text_middle({left, middle - canvas.px(12)}, TextStyle::kBody,
                           state.good ? palette::kGood : palette::kBad,
                           canvas.elided(TextStyle::kBody, state.message, room), Align::kLeft);
        draw_players_ready(canvas, {left, middle + canvas.px(14)}, room, view);
    }
    const bool pressed = button(canvas, box, ready ? "Waiting for the others" : "Ready",
                                ButtonKind::kPrimary, !ready);
    focus_by_default();
    return pressed;
}

}  // namespace

std::string obstacle(const client::View& view, game::Stat stat) {
    const std::optional<int> price = game::price_coins(tier_of(view.tiers, stat));
    if (!price) return "Fully upgraded";
    const int missing = *price - view.coins_held;
    if (missing > 0) return "Needs " + coins_text(missing) + " more";
    if (view.phase != game::Phase::kShop) return "The shop is closed";
    return "";
}

std::string outcome_words(replication::PurchaseOutcome outcome) {
    switch (outcome) {
        case replication::PurchaseOutcome::kBought:
            return "Bought.";
        case replication::PurchaseOutcome::kAlreadyBought:
            return "Bought before; nothing more was charged.";
        case replication::PurchaseOutcome::kTooExpensive:
            return "Not enough coins.";
        case replication::PurchaseOutcome::kLastTier:
            return "Already fully upgraded.";
        case replication::PurchaseOutcome::kStalePrice:
            return "The price had changed; nothing was charged. Pick it again.";
        case replication::PurchaseOutcome::kShopClosed:
            return "The shop had closed; nothing was charged.";
        case replication::PurchaseOutcome::kStoreFailed:
            return "The server could not write it down; nothing was charged.";
    }
    return "";
}

ShopChoice draw_shop(Canvas& canvas, const client::View& view, ShopState& state,
                     std::optional<int> slot) {
    const Layer layer("shop", canvas);
    if (state.open_since_s < 0.0) state = {"", true, canvas.time_s};
    const Box whole = canvas.whole();
    canvas.list->AddRectFilled(whole.min, whole.max, fade(palette::kVeil, 0.8));
    const Box panel = canvas.centred(kPanelWidth, kPanelHeight);
    canvas.panel(panel);
    draw_head(canvas, panel, view);

    const float gap = canvas.px(16), inset = canvas.px(32);
    const float top = panel.min.y + canvas.px(116);
    const float width = (panel.width() - 2 * inset - gap * (kColumns - 1)) / kColumns;
    const float height = canvas.px(200);
    for (int i = 0; i < static_cast<int>(game::kStatCount); ++i) {
        const float x = panel.min.x + inset + static_cast<float>(i % kColumns) * (width + gap);
        const int row = i / kColumns;
        const float y = top + static_cast<float>(row) * (height + gap);
        if (draw_card(canvas, {{x, y}, {x + width, y + height}}, view, i)) slot = i;
    }
    ShopChoice choice;
    choice.ready = draw_foot(canvas, panel, view, state);
    if (canvas.time_s - state.open_since_s < kDeafS) return {};
    if (slot && *slot >= 0 && *slot < static_cast<int>(game::kStatCount)) {
        const auto stat = static_cast<game::Stat>(*slot);
        const std::string blocked = obstacle(view, stat);
        if (blocked.empty()) {
            choice.buy = stat;
        } else {
            state.message = std::string(effect_of(view.tiers, stat).title) + ": " + blocked + ".";
            state.good = false;
        }
    }
    return choice;
}

}  // namespace fts::sdl
