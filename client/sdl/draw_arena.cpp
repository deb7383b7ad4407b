#include "client/sdl/draw_arena.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "common/game/rules.h"

namespace fts::sdl {
namespace {

constexpr double kSlabM = 0.45;    // how far the platform's side shows below its top
constexpr double kGlowM = 1.1;     // of the soft edge, outwards
constexpr double kRimBandM = 1.2;  // of the warning band, inwards
constexpr double kGridStepM = 2.0;

struct Look {
    const Canvas& canvas;
    const Camera& camera;

    float hair() const { return std::max(1.0F, canvas.px(1)); }
    float edge() const { return std::max(1.5F, canvas.px(2)); }
};

void draw_round(const Look& look, double inner_m, double outer_m) {
    const Canvas& canvas = look.canvas;
    const Camera& camera = look.camera;
    const ImVec2 centre = camera.to_screen(physics::Vec2d::Zero());
    const ImVec2 below{centre.x, centre.y + camera.px(kSlabM)};
    const float r0 = camera.px(inner_m), r1 = camera.px(outer_m);

    canvas.gradient_ring(centre, r1, fade(palette::kPlatformEdge, 0.20), r1 + camera.px(kGlowM),
                         fade(palette::kPlatformEdge, 0.0));
    canvas.gradient_ring(below, r0, palette::kPlatformSide, r1, palette::kPlatformSide);
    canvas.ring(below, r1, mix(palette::kPlatformSide, palette::kPlatformEdge, 0.25), look.hair());
    canvas.gradient_ring(centre, r0, palette::kPlatformCentre, r1, palette::kPlatformRim);
    for (double r = kGridStepM; r < outer_m - 0.5; r += kGridStepM) {
        if (r > inner_m + 0.5) {
            canvas.ring(centre, camera.px(r), fade(palette::kGrid, 0.10), look.hair());
        }
    }
    constexpr int kSpokes = 12;
    for (int i = 0; i < kSpokes; ++i) {
        const double angle = 2.0 * 3.14159265358979 * i / kSpokes;
        const physics::Vec2d way(std::cos(angle), std::sin(angle));
        canvas.line(camera.to_screen(way * std::max(inner_m, kGridStepM)),
                    camera.to_screen(way * outer_m), fade(palette::kGrid, 0.06), look.hair());
    }
    const float band = camera.px(std::min(kRimBandM, (outer_m - inner_m) / 2));
    const Colour warm = fade(palette::kPlatformEdge, 0.16), clear = fade(warm, 0.0);
    canvas.gradient_ring(centre, r1 - band, clear, r1, warm);
    canvas.ring(centre, r1, palette::kPlatformEdge, look.edge());
    if (inner_m > 0.0) {
        canvas.gradient_ring(centre, r0, warm, r0 + band, clear);
        canvas.ring(centre, r0, palette::kPlatformEdge, look.edge());
    }
}

void draw_box_glow(const Look& look, const Box& box) {
    const float reach = look.camera.px(kGlowM);
    constexpr int kLayers = 12;
    for (int i = 0; i < kLayers; ++i) {
        const float out = reach * static_cast<float>(i + 1) / kLayers;
        look.canvas.list->AddRect({box.min.x - out, box.min.y - out},
                                  {box.max.x + out, box.max.y + out},
                                  fade(palette::kPlatformEdge, 0.17 * (1.0 - (i + 0.5) / kLayers)),
                                  out, 0, reach / kLayers + 1.0F);
    }
}

void draw_rectangle(const Look& look, const physics::Vec2d& half_m) {
    const Canvas& canvas = look.canvas;
    const Camera& camera = look.camera;
    const Box box{camera.to_screen({-half_m.x(), half_m.y()}),
                  camera.to_screen({half_m.x(), -half_m.y()})};
    draw_box_glow(look, box);
    const float slab = camera.px(kSlabM);
    const ImVec2 foot{box.max.x, box.max.y + slab};
    canvas.list->AddRectFilled(box.min, foot, palette::kPlatformSide);
    canvas.line({box.min.x, foot.y}, foot,
                mix(palette::kPlatformSide, palette::kPlatformEdge, 0.25), look.hair());
    canvas.list->AddRectFilled(box.min, box.max,
                               mix(palette::kPlatformRim, palette::kPlatformCentre, 0.6));
    const Colour grid = fade(palette::kGrid, 0.09);
    for (double x = 0.0; x < half_m.x() - 0.5; x += kGridStepM) {
        for (const double side : {-1.0, 1.0}) {
            const float at = camera.to_screen({x * side, 0}).x;
            canvas.line({at, box.min.y}, {at, box.max.y}, grid, look.hair());
        }
    }
    for (double y = 0.0; y < half_m.y() - 0.5; y += kGridStepM) {
        for (const double side : {-1.0, 1.0}) {
            const float at = camera.to_screen({0, y * side}).y;
            canvas.line({box.min.x, at}, {box.max.x, at}, grid, look.hair());
        }
    }
    const float band = camera.px(std::min(kRimBandM, half_m.minCoeff() / 2));
    const Colour warm = fade(palette::kPlatformEdge, 0.14), clear = fade(warm, 0.0);
    canvas.gradient_box({box.min, {box.max.x, box.min.y + band}}, warm, clear);
    canvas.gradient_box({{box.min.x, box.max.y - band}, box.max}, clear, warm);
    canvas.list->AddRectFilledMultiColor(box.min, {box.min.x + band, box.max.y}, warm, clear, clear,
                                         warm);
    canvas.list->AddRectFilledMultiColor({box.max.x - band, box.min.y}, box.max, clear, warm, warm,
                                         clear);
    canvas.list->AddRect(box.min, box.max, palette::kPlatformEdge, canvas.px(2), 0, look.edge());
}

struct Shape {
    const Look& look;
    void operator()(const physics::Disc& disc) const { draw_round(look, 0.0, disc.radius_m); }
    void operator()(const physics::Rectangle& rectangle) const {
        draw_rectangle(look, rectangle.half_extents_m);
    }
    void operator()(const physics::Ring& ring) const {
        draw_round(look, ring.inner_radius_m, ring.outer_radius_m);
    }
};

}  // namespace

void draw_background(const Canvas& canvas) {
    const Box whole = canvas.whole();
    canvas.list->AddRectFilled(whole.min, whole.max, palette::kBackground);
    const ImVec2 centre{canvas.size.x / 2, canvas.size.y * 0.48F};
    canvas.gradient_disc(centre, std::max(canvas.size.x, canvas.size.y) * 0.62F, centre,
                         palette::kBackgroundGlow, fade(palette::kBackgroundGlow, 0.0));
}

void draw_platform(const Canvas& canvas, const Camera& camera, const physics::Platform& platform) {
    const Look look{canvas, camera};
    std::visit(Shape{look}, platform);
}

void draw_coins(const Canvas& canvas, const Camera& camera,
                const std::vector<client::CoinView>& coins) {
    for (const client::CoinView& coin : coins) {
        const float radius = std::max(camera.px(game::kCoinRadiusM), canvas.px(5));
        const ImVec2 at = camera.to_screen(coin.position_m);
        canvas.gradient_ring({at.x, at.y + radius * 0.5F}, 0.0F, fade(palette::kInk, 0.5),
                             radius * 1.5F, fade(palette::kInk, 0.0));
        canvas.coin(at, radius);
        if (coin.value_coins > 1) {
            canvas.text_middle(at, TextStyle::kStrong, palette::kInk,
                               std::to_string(coin.value_coins), Align::kCentre, radius * 1.1F);
        }
    }
}

}  // namespace fts::sdl
