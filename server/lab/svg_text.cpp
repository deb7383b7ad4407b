#include "server/lab/svg_text.h"

#include <cmath>
#include <cstdio>

namespace fts::lab {
namespace {

// Width over font size, by kinds of letters.
double relative_width(char c) {
    constexpr std::string_view kNarrow = " .,:;!|'ijlI()[]";
    constexpr std::string_view kSlim = "frt-/\"";
    constexpr std::string_view kWide = "mwMW%@";
    if (kNarrow.find(c) != std::string_view::npos) return 0.33;
    if (kSlim.find(c) != std::string_view::npos) return 0.42;
    if (kWide.find(c) != std::string_view::npos) return 0.92;
    if (c >= 'A' && c <= 'Z') return 0.71;
    return 0.6;
}

bool continues_a_character(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

}  // namespace

double text_width_px(std::string_view utf8, double size_px) {
    double width = 0.0;
    for (const char c : utf8) {
        if (!continues_a_character(c)) width += relative_width(c);
    }
    return width * size_px;
}

std::vector<std::string> wrapped_lines(std::string_view text, double size_px, double width_px) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::string word(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::string longer = lines.empty() ? word : lines.back() + " " + word;
        if (!lines.empty() && text_width_px(longer, size_px) <= width_px) {
            lines.back() = longer;
        } else {
            lines.push_back(word);
        }
    }
    return lines;
}

std::string xml_escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                // XML has no way to say the control characters.
                if (static_cast<unsigned char>(c) >= 0x20U) out += c;
        }
    }
    return out;
}

std::string pixels(double value) {
    const double rounded = std::round(value * 10.0) / 10.0;
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", rounded == 0.0 ? 0.0 : rounded);
    std::string out = text;
    if (out.ends_with(".0")) out.resize(out.size() - 2);
    return out;
}

}  // namespace fts::lab
