// The rasteriser against areas that geometry gives.
#include "client/sdl/rasteriser.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/client_sdl/offscreen.h"

namespace fts::sdl {
namespace {

constexpr int kSide = 200;

int brightness(Colour colour) {
    return static_cast<int>((colour & 0xffU) + ((colour >> 8U) & 0xffU) +
                            ((colour >> 16U) & 0xffU));
}

// Pixels' worth of white on black.
double white_area(const Offscreen& window) {
    double area = 0.0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            area +=
                brightness(window.pixel({static_cast<float>(x), static_cast<float>(y)})) / 765.0;
        }
    }
    return area;
}

void draw_on_black(Offscreen& window, const std::function<void(ImDrawList&)>& draw) {
    window.frame(0.0, [&](Canvas& canvas) {
        canvas.list->AddRectFilled({0, 0}, canvas.size, rgb(0x000000));
        draw(*canvas.list);
    });
}

TEST(Rasteriser, draws_circles_of_the_right_area_at_any_place) {
    constexpr unsigned kSeed = 71;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<float> place(60, 140), size(3, 50);
    Offscreen window(kSide, kSide);
    for (int i = 0; i < 20; ++i) {
        const ImVec2 centre{place(random), place(random)};
        const float radius = size(random);
        draw_on_black(window, [&](ImDrawList& list) {
            list.AddCircleFilled(centre, radius, rgb(0xffffff), segments_for(radius));
        });
        const double expected =
            3.14159265 * static_cast<double>(radius) * static_cast<double>(radius);
        // An anti-aliased outline is half a pixel wide on either side.
        EXPECT_NEAR(white_area(window), expected,
                    0.03 * expected + 4.0 * static_cast<double>(radius) * 0.5)
            << "radius " << radius;
    }
}

TEST(Rasteriser, leaves_neither_gap_nor_overlap_between_triangles_that_share_an_edge) {
    constexpr unsigned kSeed = 5;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<float> place(20, 180);
    Offscreen window(kSide, kSide);
    for (int i = 0; i < 20; ++i) {
        // A fan around a point inside a box, half transparent: a gap would stay black, an overlap
        // would be brighter.
        const ImVec2 hub{place(random), place(random)};
        const ImVec2 corners[] = {{10, 10}, {190, 10}, {190, 190}, {10, 190}};
        window.frame(0.0, [&](Canvas& canvas) {
            ImDrawList& list = *canvas.list;
            list.AddRectFilled({0, 0}, canvas.size, rgb(0x000000));
            list.Flags &= ~ImDrawListFlags_AntiAliasedFill;
            for (int side = 0; side < 4; ++side) {
                list.AddTriangleFilled(hub, corners[side], corners[(side + 1) % 4],
                                       rgb(0xffffff, 0.5));
            }
        });
        const int expected = brightness(window.pixel({12, 12}));
        EXPECT_NEAR(expected, 384, 6);
        for (int y = 11; y < 189; ++y) {
            for (int x = 11; x < 189; ++x) {
                const ImVec2 at{static_cast<float>(x), static_cast<float>(y)};
                ASSERT_EQ(brightness(window.pixel(at)), expected)
                    << x << ", " << y << " hub " << hub.x << ", " << hub.y;
            }
        }
    }
}

TEST(Rasteriser, shades_from_one_colour_to_the_other) {
    Offscreen window(kSide, kSide);
    draw_on_black(window, [](ImDrawList& list) {
        list.AddRectFilledMultiColor({0, 0}, {kSide, kSide}, rgb(0x000000), rgb(0xffffff),
                                     rgb(0xffffff), rgb(0x000000));
    });
    int last = -1;
    for (int x = 0; x < kSide; x += 5) {
        const int now = brightness(window.pixel({static_cast<float>(x), 100})) / 3;
        EXPECT_NEAR(now, 255 * (x + 0.5) / kSide, 3);
        EXPECT_GE(now, last);
        last = now;
    }
}

TEST(Rasteriser, keeps_to_the_clip_rectangle_and_the_window) {
    Offscreen window(kSide, kSide);
    draw_on_black(window, [](ImDrawList& list) {
        list.PushClipRect({50, 50}, {150, 120});
        list.AddCircleFilled({100, 100}, 1000, rgb(0xffffff), 64);
        list.AddRectFilled({-5000, -5000}, {5000, 5000}, rgb(0xffffff));
        list.PopClipRect();
        list.AddLine({-9999, 160}, {9999, 160}, rgb(0xffffff), 2.0F);
    });
    EXPECT_NEAR(white_area(window), 100 * 70 + 2 * kSide, 0.01 * 7400);
    EXPECT_EQ(brightness(window.pixel({100, 130})), 0);
}

TEST(Rasteriser, draws_nothing_for_coordinates_that_make_no_sense) {
    Offscreen window(kSide, kSide);
    const float nan = std::nanf("");
    draw_on_black(window, [&](ImDrawList& list) {
        list.AddTriangleFilled({nan, 0}, {100, nan}, {50, 50}, rgb(0xffffff));
        list.AddTriangleFilled({INFINITY, 0}, {100, 100}, {50, 50}, rgb(0xffffff));
        list.AddRectFilled({nan, 10}, {20, 20}, rgb(0xffffff));
    });
    EXPECT_LT(white_area(window), 1.0);
}

TEST(Rasteriser, draws_text_twice_as_fine_on_a_screen_with_twice_the_pixels) {
    const auto ink = [](float ratio) {
        Offscreen window(kSide, kSide, ratio);
        draw_on_black(window, [](ImDrawList&) {});
        window.frame(0.0, [](Canvas& canvas) {
            canvas.list->AddRectFilled({0, 0}, canvas.size, rgb(0x000000));
            canvas.text({20, 60}, TextStyle::kDisplay, rgb(0xffffff), "Sphere");
        });
        double area = 0.0;
        for (float y = 0; y < kSide; y += 0.5F) {
            for (float x = 0; x < kSide; x += 0.5F)
                area += brightness(window.pixel({x, y})) / 3060.0;
        }
        return area;
    };
    const double coarse = ink(1.0F), fine = ink(2.0F);
    EXPECT_GT(coarse, 100.0);
    EXPECT_NEAR(fine, coarse, 0.05 * coarse);
}

}  // namespace
}  // namespace fts::sdl
