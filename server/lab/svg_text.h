// Text of a chart: how wide it is without a font at hand, and how it is written into XML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fts::lab {

// An upper estimate for the usual sans-serif faces.
double text_width_px(std::string_view utf8, double size_px);

// `text` in lines no wider than `width_px`; a word that is wider stands alone.
std::vector<std::string> wrapped_lines(std::string_view text, double size_px, double width_px);

std::string xml_escaped(std::string_view text);

// With one decimal, which is finer than a screen: the last bits of a logarithm do not show.
std::string pixels(double value);

}  // namespace fts::lab
