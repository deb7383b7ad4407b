#include "client/sdl/screens/inspector.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "client/sdl/draw_balls.h"
#include "client/sdl/widgets.h"
#include "client/sdl/wording.h"

namespace fts::sdl {
namespace {

using Hit = replication::CollisionReport;
using physics::Vec2d;

constexpr float kWidth = 1160, kHeight = 640, kInset = 30;
// Twice the spacing of doubles near 1 for each of the few roundings in a collision: beyond it,
// energy or momentum was really lost.
constexpr double kRoundOff = 16 * 2.2e-16;

std::string from_to(double before, double after) {
    return fixed(before, 2) + " \xe2\x86\x92 " + fixed(after, 2);
}

struct Row {
    std::string quantity;
    const char* unit;
    std::string own, other, together, change;
    bool conserved = false;
};

std::string change_words(double relative) {
    return relative == 0.0 ? "exactly 0" : scientific(relative);
}

std::vector<Row> rows_of(const Hit& hit, const HitSums& sums) {
    const Vec2d along = -hit.normal;
    const Vec2d across(-along.y(), along.x());
    const auto component = [](const Hit::Side& side, const Vec2d& axis) {
        return from_to(side.velocity_before_mps.dot(axis), side.velocity_after_mps.dot(axis));
    };
    const auto momentum = [](const Hit::Side& side, int axis) {
        return from_to(side.mass_kg * side.velocity_before_mps[axis],
                       side.mass_kg * side.velocity_after_mps[axis]);
    };
    const auto energy = [](const Hit::Side& side) {
        return from_to(0.5 * side.mass_kg * side.velocity_before_mps.squaredNorm(),
                       0.5 * side.mass_kg * side.velocity_after_mps.squaredNorm());
    };
    const auto speed = [](const Hit::Side& side) {
        return from_to(side.velocity_before_mps.norm(), side.velocity_after_mps.norm());
    };
    const double scale_ns = hit.own.mass_kg * hit.own.velocity_before_mps.norm() +
                            hit.other.mass_kg * hit.other.velocity_before_mps.norm();
    const auto momentum_row = [&](const char* name, int axis) {
        const double before = sums.momentum_before_ns[axis], after = sums.momentum_after_ns[axis];
        return Row{name,
                   "N\xc2\xb7s",
                   momentum(hit.own, axis),
                   momentum(hit.other, axis),
                   from_to(before, after),
                   change_words(scale_ns > 0.0 ? (after - before) / scale_ns : 0.0),
                   true};
    };
    return {
        {"Mass", "kg", fixed(hit.own.mass_kg, 3), fixed(hit.other.mass_kg, 3),
         fixed(hit.own.mass_kg + hit.other.mass_kg, 3), "", false},
        {"Speed", "m/s", speed(hit.own), speed(hit.other), "", "", false},
        {"   along the line", "m/s", component(hit.own, along), component(hit.other, along), "", "",
         false},
        {"   across it", "m/s", component(hit.own, across), component(hit.other, across), "", "",
         false},
        momentum_row("Momentum x", 0),
        momentum_row("Momentum y", 1),
        {"Kinetic energy", "J", energy(hit.own), energy(hit.other),
         from_to(sums.energy_before_j, sums.energy_after_j),
         change_words(sums.relative_energy_change), true},
    };
}

struct Columns {
    float quantity, unit, own, other, together, change;  // right edges but for the first two
};

Columns columns_in(const Canvas& canvas, const Box& box) {
    return {box.min.x,
            box.min.x + canvas.px(112),
            box.min.x + canvas.px(268),
            box.min.x + canvas.px(392),
            box.min.x + canvas.px(516),
            box.max.x};
}

float draw_table(const Canvas& canvas, const Box& box, const std::vector<Row>& rows,
                 const std::string& other, const HitColours& colours) {
    const Columns at = columns_in(canvas, box);
    float y = box.min.y;
    const auto head = [&](float x, Colour colour, const std::string& text) {
        canvas.text({x, y}, TextStyle::kCaption, colour, text, Align::kRight);
    };
    head(at.own, mix(colours.own, palette::kText, 0.35), "You");
    head(at.other, mix(colours.other, palette::kText, 0.35),
         canvas.elided(TextStyle::kCaption, other, canvas.px(116)));
    head(at.together, palette::kTextQuiet, "Together");
    head(at.change, palette::kTextQuiet, "Relative change");
    y += canvas.px(24);
    for (const Row& row : rows) {
        const float line = y - canvas.px(3);
        canvas.line({box.min.x, line}, {box.max.x, line}, fade(palette::kLine, 0.7),
                    std::max(1.0F, canvas.px(1)));
        if (row.conserved) {
            canvas.list->AddRectFilled({box.min.x - canvas.px(8), line},
                                       {box.max.x + canvas.px(8), line + canvas.px(29)},
                                       fade(palette::kGood, 0.07));
        }
        const float middle = y + canvas.px(11.5F);
        const auto cell = [&](float x, Colour colour, const std::string& text, Align align) {
            canvas.text_middle({x, middle}, TextStyle::kCaption, colour, text, align,
                               canvas.px(14));
        };
        cell(at.quantity, palette::kText, row.quantity, Align::kLeft);
        cell(at.unit, palette::kTextFaint, row.unit, Align::kLeft);
        cell(at.own, palette::kText, row.own, Align::kRight);
        cell(at.other, palette::kText, row.other, Align::kRight);
        cell(at.together, palette::kText, row.together, Align::kRight);
        cell(at.change, palette::kGood, row.change, Align::kRight);
        y += canvas.px(29);
    }
    return y;
}

// All the digits that a double has.
std::string every_digit(double value) {
    std::array<char, 40> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.17g", value);
    return buffer.data();
}

// Who holds the energy: two bars of one length, because the sum is the same.
float draw_energy_bars(const Canvas& canvas, ImVec2 at, const Box& box, const Hit& hit,
                       const HitColours& colours) {
    const float left = at.x + canvas.px(112), width = box.max.x - left;
    const auto bar = [&](float y, const char* when, const Vec2d& own_mps, const Vec2d& other_mps) {
        const double own_j = 0.5 * hit.own.mass_kg * own_mps.squaredNorm();
        const double other_j = 0.5 * hit.other.mass_kg * other_mps.squaredNorm();
        const double share = own_j + other_j > 0.0 ? own_j / (own_j + other_j) : 0.5;
        const float split = left + width * static_cast<float>(share), height = canvas.px(16);
        canvas.text_middle({at.x, y + height / 2}, TextStyle::kCaption, palette::kTextQuiet, when,
                           Align::kLeft);
        canvas.list->AddRectFilled({left, y}, {split, y + height}, colours.own);
        canvas.list->AddRectFilled({split, y}, {left + width, y + height}, colours.other);
        const auto words = [&](double part, float x, Align align) {
            if (part < 0.12) return;
            canvas.text_middle({x, y + height / 2}, TextStyle::kCaption, palette::kInk,
                               fixed(100.0 * part, 0) + " %", align, canvas.px(12));
        };
        words(share, left + canvas.px(8), Align::kLeft);
        words(1.0 - share, left + width - canvas.px(8), Align::kRight);
    };
    bar(at.y, "Energy before", hit.own.velocity_before_mps, hit.other.velocity_before_mps);
    bar(at.y + canvas.px(22), "Energy after", hit.own.velocity_after_mps,
        hit.other.velocity_after_mps);
    return at.y + canvas.px(38);
}

void draw_last_bit(const Canvas& canvas, ImVec2 at, const Box& box, const HitSums& sums,
                   std::uint32_t contacts_at_once) {
    const float before = at.x + canvas.px(112), after = at.x + canvas.px(300);
    const auto line = [&](float drop, Colour colour, const std::string& name, const std::string& a,
                          const std::string& b) {
        const float y = at.y + canvas.px(drop);
        canvas.text({at.x, y}, TextStyle::kCaption, palette::kTextQuiet, name);
        canvas.text({before, y}, TextStyle::kCaption, colour, a);
        canvas.text({after, y}, TextStyle::kCaption, colour, b);
    };
    const auto digits = [&](float drop, const char* name, double a, double b) {
        line(drop, palette::kText, name, every_digit(a), every_digit(b));
    };
    line(0, palette::kTextFaint, "Every digit", "before", "after");
    digits(20, "Energy, J", sums.energy_before_j, sums.energy_after_j);
    digits(39, "Mom. x, N\xc2\xb7s", sums.momentum_before_ns.x(), sums.momentum_after_ns.x());
    digits(58, "Mom. y, N\xc2\xb7s", sums.momentum_before_ns.y(), sums.momentum_after_ns.y());
    if (contacts_at_once > 1) {
        canvas.paragraph({at.x, at.y + canvas.px(84)}, box.max.x - at.x, TextStyle::kCaption,
                         palette::kTextQuiet,
                         "Momentum and energy were kept by all " +
                             std::to_string(contacts_at_once) +
                             " contacts together (generalised reflections, Smith et al. 2012), not "
                             "by these two balls alone.");
        return;
    }
    const bool kept = std::abs(sums.relative_energy_change) <= kRoundOff &&
                      sums.relative_momentum_change <= kRoundOff;
    canvas.paragraph({at.x, at.y + canvas.px(84)}, box.max.x - at.x, TextStyle::kCaption,
                     kept ? palette::kGood : palette::kBad,
                     kept ? "Conserved. What differs, if anything, is the rounding of a double's "
                            "last bit (2.2 \xc3\x97 10\xe2\x81\xbb\xc2\xb9\xe2\x81\xb6)."
                          : "Not conserved within rounding: this hit was not perfectly elastic.");
}

HitColours colours_of(const client::View& view, const Hit& hit) {
    HitColours colours{palette::kAccent, behaviour_colour(game::Behaviour::kChaser)};
    for (const auto& player : view.players) {
        if (player.player_id == view.own_player_id) colours.own = player_colour(player.colour);
        if (player.player_id == hit.other.player_id) colours.other = player_colour(player.colour);
    }
    if (hit.other.player_id != 0) return colours;
    for (const client::BallView& ball : view.balls) {
        if (ball.id == hit.other.ball) colours.other = ball_colour(ball);
    }
    return colours;
}

void draw_figures(const Canvas& canvas, const Box& box, const Hit& hit, const HitColours& colours) {
    const float split = box.min.y + box.height() * 0.60F;
    canvas.list->AddRectFilled(box.min, {box.max.x, split - canvas.px(6)}, palette::kField,
                               canvas.px(space::kCorner));
    canvas.list->AddRectFilled({box.min.x, split + canvas.px(6)}, box.max, palette::kField,
                               canvas.px(space::kCorner));
    const auto caption = [&](float y, const std::string& text) {
        canvas.text({box.min.x + canvas.px(14), y}, TextStyle::kCaption, palette::kTextQuiet, text);
    };
    const Vec2d along = -hit.normal;
    const double phi_deg = std::atan2(along.y(), along.x()) * 180.0 / 3.14159265358979;
    caption(box.min.y + canvas.px(10), "In the plane");
    canvas.text({box.max.x - canvas.px(14), box.min.y + canvas.px(10)}, TextStyle::kCaption,
                palette::kAccent, "line of centres  \xcf\x86 = " + fixed(phi_deg, 1) + "\xc2\xb0",
                Align::kRight);
    caption(split + canvas.px(16),
            "Turned: the line of centres lies flat, only speed along it "
            "changes");
    const float pad = canvas.px(14);
    draw_figure_in_plane(canvas,
                         {{box.min.x + pad, box.min.y + canvas.px(34)},
                          {box.max.x - pad, split - canvas.px(6) - pad}},
                         hit, colours);
    draw_figure_turned(
        canvas,
        {{box.min.x + pad, split + canvas.px(38)}, {box.max.x - pad, box.max.y - canvas.px(8)}},
        hit, colours);
}

void draw_nothing_yet(const Canvas& canvas, const Box& panel) {
    canvas.text_middle(panel.centre(), TextStyle::kHeading, palette::kText, "No hit yet",
                       Align::kCentre);
    canvas.text_middle(
        {panel.centre().x, panel.centre().y + canvas.px(32)}, TextStyle::kBody, palette::kTextQuiet,
        "Run into a ball, then look here at what became of momentum and energy.", Align::kCentre);
}

}  // namespace

bool draw_inspector(Canvas& canvas, const client::View& view) {
    const Layer layer("inspector", canvas);
    const Box whole = canvas.whole();
    canvas.list->AddRectFilled(whole.min, whole.max, fade(palette::kVeil, 0.8));
    const Box panel = canvas.centred(kWidth, kHeight);
    canvas.panel(panel);
    const float inset = canvas.px(kInset);
    const float top = panel.min.y + canvas.px(22);
    canvas.text({panel.min.x + inset, top}, TextStyle::kTitle, palette::kText, "Your last hit");
    const Box close{{panel.max.x - inset - canvas.px(128), top},
                    {panel.max.x - inset, top + canvas.px(38)}};
    const bool closed = button(canvas, close, "Close (E)", ButtonKind::kPlain);
    focus_by_default();
    if (!view.last_own_hit) {
        draw_nothing_yet(canvas, panel);
        return closed;
    }
    const Hit& hit = *view.last_own_hit;
    const HitColours colours = colours_of(view, hit);
    const HitSums sums = sums_of(hit);
    const std::string other = other_name(view, hit);
    const float head = canvas.text_width(TextStyle::kTitle, "Your last hit");
    canvas.text({panel.min.x + inset + head + canvas.px(20), top + canvas.px(17)}, TextStyle::kBody,
                palette::kTextQuiet,
                canvas.elided(TextStyle::kBody,
                              "with " + other + ", tick " + std::to_string(hit.tick) +
                                  ", impulse " + fixed(hit.impulse_ns, 2) + " N\xc2\xb7s",
                              close.min.x - panel.min.x - inset - head - canvas.px(40)));
    const float body = top + canvas.px(62), bottom = panel.max.y - inset;
    const float split = panel.min.x + inset + canvas.px(440);
    draw_figures(canvas, {{panel.min.x + inset, body}, {split, bottom}}, hit, colours);

    const Box right{{split + canvas.px(30), body}, {panel.max.x - inset, bottom}};
    float y = right.min.y;
    y += canvas.paragraph({right.min.x, y}, right.width(), TextStyle::kStrong, palette::kText,
                          explain(hit));
    y = draw_table(canvas, {{right.min.x, y + canvas.px(14)}, right.max}, rows_of(hit, sums), other,
                   colours);
    y = draw_energy_bars(canvas, {right.min.x, y + canvas.px(24)}, right, hit, colours);
    draw_last_bit(canvas, {right.min.x, y + canvas.px(26)}, right, sums, hit.contacts_at_once);
    return closed;
}

}  // namespace fts::sdl
