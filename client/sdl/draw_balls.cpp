#include "client/sdl/draw_balls.h"

#include <algorithm>
#include <cmath>

#include "client/sdl/wording.h"

namespace fts::sdl {
namespace {

constexpr double kVelocityArrowS = 0.6;  // an arrow reaches where the ball would be by then
constexpr double kMomentumArrowMPerNs = 0.4;
constexpr double kMinArrowSpeedMps = 0.05;
constexpr float kSmallestRadius = 5;

float drawn_radius(const Canvas& canvas, const Camera& camera, const client::BallView& ball) {
    return std::max(camera.px(ball.radius_m), canvas.px(kSmallestRadius));
}

void draw_shadow(const Canvas& canvas, ImVec2 centre, float radius, double opacity) {
    const ImVec2 below{centre.x + radius * 0.10F, centre.y + radius * 0.34F};
    const Colour dark = fade(palette::kInk, 0.6 * opacity);
    // The hole of the ring lies under the ball.
    canvas.gradient_ring(below, radius * 0.55F, dark, radius * 1.35F, fade(dark, 0.0));
}

// Where it pushes: a wedge of light just outside the ball.
void draw_thrust(const Canvas& canvas, const client::BallView& ball, ImVec2 centre, float radius) {
    const double share = ball.thrust.norm();
    if (share < 0.05) return;
    const auto angle = static_cast<float>(std::atan2(-ball.thrust.y(), ball.thrust.x()));
    const float reach = radius + canvas.px(5);
    canvas.list->PathArcTo(centre, reach, angle - 0.5F, angle + 0.5F, 12);
    canvas.list->PathStroke(fade(palette::kText, 0.25 + 0.45 * share), 0,
                            std::max(1.5F, canvas.px(2)));
}

void draw_brake(const Canvas& canvas, ImVec2 centre, float radius) {
    constexpr int kBars = 8;
    for (int i = 0; i < kBars; ++i) {
        const float angle = static_cast<float>(i) * 0.785398F + 0.39F;
        canvas.list->PathArcTo(centre, radius + canvas.px(4), angle - 0.16F, angle + 0.16F, 5);
        canvas.list->PathStroke(fade(palette::kBad, 0.7), 0, std::max(1.5F, canvas.px(2)));
    }
}

void draw_words(const Canvas& canvas, const client::BallView& ball, ImVec2 centre, float radius) {
    const float gap = canvas.px(3);
    const Colour quiet = ball.is_own ? palette::kText : fade(palette::kText, 0.72);
    canvas.text_middle({centre.x, centre.y + radius + gap + canvas.px(9)}, TextStyle::kCaption,
                       quiet, mass_text(ball.mass_kg), Align::kCentre, canvas.px(11.5F));
    if (!ball.is_player) return;
    const float top = centre.y - radius - gap - canvas.px(ball.is_own ? 13 : 9);
    const std::string name =
        canvas.elided(TextStyle::kCaption, ball.is_own ? "You" : ball.name, canvas.px(84));
    canvas.text_middle({centre.x, top}, ball.is_own ? TextStyle::kStrong : TextStyle::kCaption,
                       ball.is_own ? palette::kText : fade(palette::kText, 0.85), name,
                       Align::kCentre, ball.is_own ? canvas.px(14) : 0.0F);
}

void draw_one(const Canvas& canvas, const Camera& camera, const client::BallView& ball) {
    const ImVec2 centre = camera.to_screen(ball.position_m);
    const float radius = drawn_radius(canvas, camera, ball);
    draw_rubber_ball(canvas, centre, radius, {ball_colour(ball), ball.mass_kg, ball.is_own, 1.0});
    if (!ball.is_player) {
        draw_behaviour_glyph(canvas, centre, radius * 0.92F, ball.behaviour,
                             fade(palette::kInk, 0.85));
    }
    if (ball.is_player)
        draw_thrust(canvas, ball, centre, radius + (ball.is_own ? canvas.px(4) : 0));
    if (ball.braking) draw_brake(canvas, centre, radius + (ball.is_own ? canvas.px(4) : 0));
    draw_words(canvas, ball, centre, radius);
}

void draw_arrows(const Canvas& canvas, const Camera& camera, const client::BallView& ball,
                 const Arrows& arrows) {
    if (ball.velocity_mps.norm() < kMinArrowSpeedMps) return;
    const ImVec2 from = camera.to_screen(ball.position_m);
    if (arrows.momentum) {
        const physics::Vec2d reach = ball.velocity_mps * (ball.mass_kg * kMomentumArrowMPerNs);
        canvas.arrow(from, camera.to_screen(ball.position_m + reach), fade(palette::kGold, 0.9),
                     canvas.px(4));
    }
    if (arrows.velocity) {
        const physics::Vec2d reach = ball.velocity_mps * kVelocityArrowS;
        canvas.arrow(from, camera.to_screen(ball.position_m + reach), palette::kText,
                     canvas.px(2.2F));
    }
}

}  // namespace

Colour ball_colour(const client::BallView& ball) {
    return ball.is_player ? player_colour(ball.colour) : behaviour_colour(ball.behaviour);
}

void draw_rubber_ball(const Canvas& canvas, ImVec2 centre, float radius, const BallLook& look) {
    draw_shadow(canvas, centre, radius, look.opacity);
    const Colour body = fade(look.colour, look.opacity);
    const Colour light = fade(mix(look.colour, palette::kText, 0.30), look.opacity);
    const Colour dark = fade(mix(look.colour, palette::kInk, 0.22), look.opacity);
    const ImVec2 focus{centre.x - radius * 0.30F, centre.y - radius * 0.34F};
    canvas.gradient_disc(centre, radius - 0.8F, focus, light, mix(body, dark, 0.8));

    const auto weight = static_cast<float>(std::clamp(look.mass_kg, 0.2, 4.0));
    const float thickness = radius * std::clamp(0.07F + 0.085F * weight, 0.08F, 0.40F);
    canvas.ring(centre, radius - thickness * 0.5F, fade(dark, 0.75), thickness);
    // Covers the shading's edge, which is not anti-aliased.
    const float rim = std::max(1.8F, canvas.px(1.4F));
    canvas.ring(centre, radius - rim * 0.5F,
                fade(mix(look.colour, palette::kInk, 0.55), look.opacity), rim);
    const ImVec2 spot{centre.x - radius * 0.36F, centre.y - radius * 0.42F};
    canvas.gradient_ring(spot, 0, fade(palette::kText, 0.55 * look.opacity), radius * 0.34F,
                         fade(palette::kText, 0.0));
    if (look.own) {
        canvas.ring(centre, radius + canvas.px(2.5F), fade(palette::kOwnRing, look.opacity),
                    std::max(2.0F, canvas.px(2.5F)));
        canvas.gradient_ring(centre, radius + canvas.px(3.5F),
                             fade(palette::kOwnRing, 0.30 * look.opacity), radius + canvas.px(13),
                             fade(palette::kOwnRing, 0.0));
    }
}

void draw_behaviour_glyph(const Canvas& canvas, ImVec2 centre, float size,
                          game::Behaviour behaviour, Colour colour) {
    const float h = size * 0.5F, line = std::max(1.5F, size * 0.16F);
    ImDrawList& list = *canvas.list;
    const auto at = [&](float x, float y) { return ImVec2{centre.x + x * h, centre.y + y * h}; };
    const auto chevron = [&](float x) {
        const ImVec2 points[] = {at(x - 0.35F, -0.7F), at(x + 0.35F, 0), at(x - 0.35F, 0.7F)};
        list.AddPolyline(points, 3, colour, 0, line);
    };
    switch (behaviour) {
        case game::Behaviour::kChaser:  // runs after you
            chevron(-0.3F);
            chevron(0.45F);
            break;
        case game::Behaviour::kEdgeGuard: {  // a shield
            const ImVec2 points[] = {at(-0.65F, -0.65F), at(0.65F, -0.65F), at(0.65F, 0.1F),
                                     at(0, 0.85F), at(-0.65F, 0.1F)};
            list.AddPolyline(points, 5, colour, ImDrawFlags_Closed, line);
            break;
        }
        case game::Behaviour::kInterceptor:  // a sight
            canvas.ring(centre, h * 0.5F, colour, line);
            for (const float s : {-1.0F, 1.0F}) {
                list.AddLine(at(s * 0.5F, 0), at(s * 0.95F, 0), colour, line);
                list.AddLine(at(0, s * 0.5F), at(0, s * 0.95F), colour, line);
            }
            break;
        case game::Behaviour::kHerd:  // three together
            for (const ImVec2 spot : {at(0, -0.5F), at(-0.52F, 0.4F), at(0.52F, 0.4F)}) {
                list.AddCircleFilled(spot, h * 0.32F, colour);
            }
            break;
        case game::Behaviour::kCoward:  // a wavering line
            list.AddBezierCubic(at(-0.8F, 0.1F), at(-0.3F, -1.2F), at(0.3F, 1.3F), at(0.8F, -0.1F),
                                colour, line);
            break;
        case game::Behaviour::kBruiser:  // a solid block
            list.AddRectFilled(at(-0.6F, -0.6F), at(0.6F, 0.6F), colour, h * 0.2F);
            break;
    }
}

void draw_ghost(const Canvas& canvas, const Camera& camera, const client::View& view) {
    if (!view.own_ball || !view.own_by_server_m) return;
    const client::BallView& own = view.balls[*view.own_ball];
    const ImVec2 here = camera.to_screen(own.position_m);
    const ImVec2 there = camera.to_screen(*view.own_by_server_m);
    const float radius = drawn_radius(canvas, camera, own);
    canvas.list->AddLine(there, here, fade(palette::kText, 0.35), std::max(1.0F, canvas.px(1.2F)));
    canvas.gradient_ring(there, 0, fade(ball_colour(own), 0.10), radius,
                         fade(ball_colour(own), 0.35));
    canvas.ring(there, radius, fade(palette::kText, 0.55), std::max(1.2F, canvas.px(1.5F)));
}

void draw_own_ball(const Canvas& canvas, const Camera& camera, const client::View& view) {
    if (view.own_ball) draw_one(canvas, camera, view.balls[*view.own_ball]);
}

void draw_balls(const Canvas& canvas, const Camera& camera, const client::View& view,
                const Arrows& arrows) {
    for (const client::BallView& ball : view.balls) {
        if (!ball.is_own) draw_one(canvas, camera, ball);
    }
    draw_own_ball(canvas, camera, view);
    for (const client::BallView& ball : view.balls) draw_arrows(canvas, camera, ball, arrows);
}

}  // namespace fts::sdl
