#include "client/sdl/screens/menu.h"

#include <algorithm>
#include <cmath>

#include "client/sdl/draw_arena.h"
#include "client/sdl/draw_balls.h"
#include "client/sdl/widgets.h"
#include "common/game/rules.h"

namespace fts::sdl {
namespace {

constexpr double kLoopS = 7.0;  // of the collision beside the form
constexpr float kLeft = 104, kFormWidth = 380;

struct Mover {
    Colour colour;
    double radius_m, mass_kg;
    physics::Vec2d contact_m, before_mps, after_mps;

    physics::Vec2d at(double time_s) const {
        return contact_m + (time_s < 0.0 ? before_mps : after_mps) * time_s;
    }
};

struct Pair {
    Mover first, second;
};

// Two balls that touch at time 0 and part as an elastic collision has it.
Pair collision() {
    Mover a{player_colour(1), 0.85, 1.6, {}, {1.35, -0.62}, {}};
    Mover b{player_colour(0), 0.65, 0.9, {}, {-1.15, 0.95}, {}};
    const physics::Vec2d normal = physics::Vec2d(1.0, 0.45).normalized();  // from a to b
    a.contact_m = -normal * a.radius_m;
    b.contact_m = normal * b.radius_m;
    const double closing = (a.before_mps - b.before_mps).dot(normal);
    const double impulse = 2.0 * closing * a.mass_kg * b.mass_kg / (a.mass_kg + b.mass_kg);
    a.after_mps = a.before_mps - normal * (impulse / a.mass_kg);
    b.after_mps = b.before_mps + normal * (impulse / b.mass_kg);
    return {a, b};
}

void draw_mover(const Canvas& canvas, const Camera& camera, const Mover& mover, double time_s,
                double opacity) {
    const ImVec2 contact = camera.to_screen(mover.contact_m);
    const double seen_s = std::min(time_s, 0.0);
    const ImVec2 origin = camera.to_screen(mover.at(-kLoopS * 0.42));
    const ImVec2 come = camera.to_screen(mover.at(seen_s));
    canvas.dashed_line(origin, come, fade(mover.colour, 0.40 * opacity), canvas.px(1.5F),
                       canvas.px(7));
    if (time_s > 0.0) {
        canvas.dashed_line(contact, camera.to_screen(mover.at(time_s)),
                           fade(mover.colour, 0.55 * opacity), canvas.px(1.5F), canvas.px(7));
    }
    const physics::Vec2d velocity = time_s < 0.0 ? mover.before_mps : mover.after_mps;
    const ImVec2 at = camera.to_screen(mover.at(time_s));
    draw_rubber_ball(canvas, at, camera.px(mover.radius_m),
                     {mover.colour, mover.mass_kg, false, opacity});
    canvas.arrow(at, camera.to_screen(mover.at(time_s) + velocity * 1.1),
                 fade(palette::kText, opacity), canvas.px(2.5F));
}

void draw_scene(const Canvas& canvas) {
    const Box stage{{canvas.size.x * 0.44F, canvas.px(40)},
                    {canvas.size.x - canvas.px(40), canvas.size.y - canvas.px(40)}};
    Camera camera;
    const physics::Disc disc{5.6};
    camera.update(disc, std::nullopt, stage, canvas.type.unit, CameraMode::kWhole, 0.0);
    draw_platform(canvas, camera, disc);
    const Pair pair = collision();
    const double time_s = std::fmod(canvas.time_s, kLoopS) - kLoopS / 2;
    const double edge_s = kLoopS * 0.45 - std::abs(time_s);
    const double opacity = std::clamp(edge_s / 0.6, 0.0, 1.0);
    if (time_s > 0.0 && time_s < 0.5) {
        const ImVec2 point = camera.to_screen(physics::Vec2d::Zero());
        canvas.ring(point, camera.px(0.3 + 2.6 * time_s), fade(palette::kText, 0.5 - time_s),
                    canvas.px(2));
    }
    draw_mover(canvas, camera, pair.first, time_s, opacity);
    draw_mover(canvas, camera, pair.second, time_s, opacity);
}

void draw_title(const Canvas& canvas, float left) {
    const float top = canvas.size.y / 2 - canvas.px(268);
    canvas.text({left - canvas.px(4), top}, TextStyle::kDisplay, palette::kText, "Fear The");
    canvas.text({left - canvas.px(4), top + canvas.px(80)}, TextStyle::kDisplay, palette::kAccent,
                "Sphere");
    canvas.text({left, top + canvas.px(180)}, TextStyle::kBody, palette::kTextQuiet,
                "Knock every ball off. Lose no momentum.");
}

}  // namespace

MenuChoice draw_menu(Canvas& canvas, MenuState& state) {
    const Layer layer("menu", canvas);
    draw_background(canvas);
    draw_scene(canvas);
    const float left = canvas.px(kLeft), right = left + canvas.px(kFormWidth);
    draw_title(canvas, left);

    float y = canvas.size.y / 2 - canvas.px(36);
    const auto row = [&](float height_units, float gap_units) {
        const Box box{{left, y}, {right, y + canvas.px(height_units)}};
        y = box.max.y + canvas.px(gap_units);
        return box;
    };
    MenuChoice choice = MenuChoice::kNone;
    const auto label = [&](const char* text) {
        canvas.text({left, y}, TextStyle::kCaption, palette::kTextQuiet, text);
        y += canvas.px(20);
    };
    label("Your name");
    if (text_field(canvas, row(space::kButtonHeight, 16), "##name", "player", state.name,
                   game::kMaxNameBytes)) {
        choice = MenuChoice::kJoin;
    }
    label("Server");
    if (text_field(canvas, row(space::kButtonHeight, 20), "##address", "localhost:7777",
                   state.address, kMaxAddressBytes)) {
        choice = MenuChoice::kJoin;
    }
    if (button(canvas, row(space::kButtonHeight, 10), "Join", ButtonKind::kPrimary)) {
        choice = MenuChoice::kJoin;
    }
    focus_by_default();
    const float half = canvas.px(kFormWidth - 10) / 2;
    const Box pair = row(space::kButtonHeight, 14);
    if (button(canvas, {pair.min, {left + half, pair.max.y}}, "Host here", ButtonKind::kPlain)) {
        choice = MenuChoice::kHost;
    }
    if (button(canvas, {{right - half, pair.min.y}, pair.max}, "Quit", ButtonKind::kPlain)) {
        choice = MenuChoice::kQuit;
    }
    if (!state.problem.empty()) {
        canvas.paragraph({left, y}, canvas.px(kFormWidth), TextStyle::kCaption, palette::kBad,
                         state.problem);
    } else {
        canvas.text({left, y}, TextStyle::kCaption, palette::kTextFaint,
                    "Enter joins.  Host here starts a server on this machine.");
    }
    return choice;
}

}  // namespace fts::sdl
