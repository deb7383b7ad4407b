#include "server/lab/svg_plot.h"

#include <cmath>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/lab/svg_axis.h"
#include "server/lab/svg_labels.h"
#include "server/lab/svg_text.h"
#include "tests/physics/dice.h"

namespace fts::lab {
namespace {

using physics::Dice;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// Empty when every tag is closed in its turn and every attribute is quoted; else what is wrong.
std::string fault_in_xml(const std::string& text) {
    static const std::regex kTag(R"re(<(/?)([a-z]+)((?:\s+[a-zA-Z0-9:-]+="[^"<>]*")*)\s*(/?)>)re");
    std::vector<std::string> open;
    std::size_t at = 0;
    for (auto it = std::sregex_iterator(text.begin(), text.end(), kTag);
         it != std::sregex_iterator(); ++it) {
        const auto start = static_cast<std::size_t>(it->position());
        const std::string between = text.substr(at, start - at);
        if (between.find_first_of("<>") != std::string::npos) return "stray: " + between;
        at = start + static_cast<std::size_t>(it->length());
        if ((*it)[1].length() > 0) {
            if (open.empty() || open.back() != (*it)[2]) return "unexpected </" + (*it)[2].str();
            open.pop_back();
        } else if ((*it)[4].length() == 0) {
            open.push_back((*it)[2]);
        }
    }
    if (text.substr(at).find_first_of("<>") != std::string::npos) return "stray at the end";
    return open.empty() ? "" : "never closed: " + open.back();
}

// Where each text is, as wide as it is estimated.
std::vector<std::pair<std::string, PixelBox>> texts_in(const std::string& svg) {
    static const std::regex kText(
        R"re(<text x="([-\d.]+)" y="([-\d.]+)" text-anchor="(\w+)" font-size="([\d.]+)"[^>]*>([^<]*))re");
    std::vector<std::pair<std::string, PixelBox>> texts;
    for (auto it = std::sregex_iterator(svg.begin(), svg.end(), kText);
         it != std::sregex_iterator(); ++it) {
        const double x = std::stod((*it)[1]), y = std::stod((*it)[2]), size = std::stod((*it)[4]);
        const double width = text_width_px((*it)[5].str(), size);
        const double left = (*it)[3] == "start" ? x : (*it)[3] == "end" ? x - width : x - width / 2;
        texts.push_back({(*it)[5], {left, y - 0.75 * size, left + width, y + 0.2 * size}});
    }
    return texts;
}

Plot crowded(std::uint64_t seed, Scale scale, bool lines) {
    Dice dice(seed);
    Plot plot;
    plot.title = "A title <with> \"quotes\" & ampersands";
    plot.subtitle =
        "Words that are many enough to be wrapped into a second line, since there are "
        "more of them than fit beside each other on one card of this width.";
    plot.footnote = "fts-lab compare 'a & b.scene'";
    plot.x = {"cost", scale, {}, {}};
    plot.y = {"error", scale, {}, {}};
    for (int k = 0; k < 6; ++k) {
        Series series;
        series.label = lines ? "series " + std::to_string(k) : "";
        series.line = lines;
        for (int i = 0; i < 5; ++i) {
            const std::string label = lines ? "" : "solver \u00d7" + std::to_string(i);
            series.points.push_back(
                {dice.of_any_size(1e-3, 1e3), dice.of_any_size(1e-15, 1.0), label, i == 2});
        }
        plot.series.push_back(series);
    }
    plot.bands = {{0.1, 10.0, "a band"}};
    plot.front = Front{"the front", {{1e-3, 1.0, "", false}, {1.0, 1e-8, "", false}}};
    return plot;
}

TEST(SvgPlot, is_well_formed_and_every_text_is_on_the_card) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        for (const bool lines : {false, true}) {
            for (const Scale scale : {Scale::kLinear, Scale::kLog}) {
                SCOPED_TRACE(testing::Message() << "seed " << seed << ", lines " << lines);
                const Plot plot = crowded(seed, scale, lines);
                const std::string svg = render_svg(plot);
                EXPECT_EQ(fault_in_xml(svg), "");
                const auto texts = texts_in(svg);
                EXPECT_GT(texts.size(), 15U);
                for (const auto& [text, box] : texts) {
                    EXPECT_GE(box.left, 0.0) << text;
                    EXPECT_LE(box.right, plot.width_px) << text;
                    EXPECT_GE(box.top, 0.0) << text;
                    EXPECT_LE(box.bottom, plot.height_px) << text;
                }
            }
        }
    }
}

TEST(SvgPlot, escapes_what_comes_from_outside) {
    const std::string svg = render_svg(crowded(1, Scale::kLog, true));
    EXPECT_THAT(svg, HasSubstr("&lt;with&gt; &quot;quotes&quot; &amp; ampersands"));
    EXPECT_THAT(xml_escaped(std::string("a\0b\x01", 4)), "ab");
}

TEST(SvgPlot, is_the_same_for_the_same_plot) {
    EXPECT_EQ(render_svg(crowded(3, Scale::kLog, false)),
              render_svg(crowded(3, Scale::kLog, false)));
}

TEST(SvgPlot, leaves_out_what_an_axis_cannot_show) {
    Plot plot;
    plot.x.scale = plot.y.scale = Scale::kLog;
    Series series;
    const double infinity = std::numeric_limits<double>::infinity();
    series.points = {{0.0, 1.0, "zero", false},
                     {-1.0, 1.0, "negative", false},
                     {1.0, std::nan(""), "nothing", false},
                     {infinity, 1.0, "endless", false},
                     {1.0, 1.0, "good", false}};
    plot.series = {series};
    const std::string svg = render_svg(plot);
    for (const char* gone : {"zero", "negative", "nothing", "endless", "nan", "inf"}) {
        EXPECT_THAT(svg, Not(HasSubstr(gone)));
    }
    EXPECT_THAT(svg, HasSubstr("good"));
    EXPECT_EQ(fault_in_xml(render_svg(Plot())), "") << "a plot of nothing is a plot";
}

TEST(SvgAxis, ticks_are_round_numbers) {
    AxisScale linear({"", Scale::kLinear, {}, {}}, {0.3, 9.7});
    std::vector<double> values;
    for (const Tick& tick : linear.ticks()) {
        if (tick.major()) values.push_back(tick.value);
    }
    EXPECT_THAT(values, ElementsAre(0.0, 2.0, 4.0, 6.0, 8.0, 10.0));

    AxisScale log({"", Scale::kLog, {}, {}}, {0.002, 300.0});
    std::vector<std::string> labels;
    for (const Tick& tick : log.ticks()) {
        if (tick.major()) labels.push_back(tick.label);
    }
    EXPECT_THAT(labels, ElementsAre("0.001", "0.01", "0.1", "1", "10", "100"));
    log.span_pixels(0.0, 100.0);
    EXPECT_THAT(log.pixel_of(1.0) - log.pixel_of(0.1),
                DoubleNear(log.pixel_of(10.0) - log.pixel_of(1.0), 1e-9));
}

TEST(SvgLabels, do_not_cover_each_other_or_the_points) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        std::vector<LabelWish> wishes;
        std::vector<PixelBox> points;
        for (int i = 0; i < 20; ++i) {
            const double x = dice.between(50.0, 550.0), y = dice.between(50.0, 350.0);
            wishes.push_back({x, y, 60.0, 14.0});
            points.push_back({x - 4, y - 4, x + 4, y + 4});
        }
        const PixelBox room{0.0, 0.0, 600.0, 400.0};
        const auto placed = place_labels(wishes, room, points, {});
        for (std::size_t i = 0; i < placed.size(); ++i) {
            const PixelBox& box = placed[i].box;
            EXPECT_TRUE(box.left >= 0 && box.top >= 0 && box.right <= 600 && box.bottom <= 400);
            for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(box.overlaps(placed[j].box));
        }
    }
}

TEST(SvgLabels, in_a_column_keep_apart_and_near_what_they_name) {
    EXPECT_THAT(spread_out({10.0, 100.0, 200.0}, 16.0, 0.0, 300.0),
                ElementsAre(10.0, 100.0, 200.0));
    EXPECT_THAT(spread_out({100.0, 100.0, 100.0}, 16.0, 0.0, 300.0),
                ElementsAre(84.0, 100.0, 116.0));
    EXPECT_THAT(spread_out({5.0, 0.0}, 16.0, 0.0, 300.0), ElementsAre(16.0, 0.0));
    EXPECT_THAT(spread_out({299.0, 300.0}, 16.0, 0.0, 300.0), ElementsAre(284.0, 300.0));
}

}  // namespace
}  // namespace fts::lab
