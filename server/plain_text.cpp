#include "server/plain_text.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace fts::server {

namespace {

// Bytes of the well-formed character at the start of `text`, with its code point; 0 when it is
// malformed (RFC 3629: no overlong forms, no surrogates, nothing above U+10FFFF).
std::size_t decode(std::string_view text, std::uint32_t& code_point) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint32_t lead = byte(0);
    if (lead < 0x80) {
        code_point = lead;
        return 1;
    }
    const std::size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < size) return 0;
    code_point = lead & (0x7fU >> size);
    for (std::size_t i = 1; i < size; ++i) {
        if ((byte(i) & 0xc0U) != 0x80U) return 0;
        code_point = (code_point << 6U) | (byte(i) & 0x3fU);
    }
    constexpr std::array<std::uint32_t, 5> kSmallest = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code_point >= 0xd800 && code_point <= 0xdfff;
    return code_point < kSmallest[size] || surrogate || code_point > 0x10ffff ? 0 : size;
}

bool is_visible(std::uint32_t c) {
    struct Range {
        std::uint32_t first, last;
    };
    constexpr std::array<Range, 9> kHidden = {{
        {0x00, 0x1f},         // control
        {0x7f, 0x9f},         // control
        {0xad, 0xad},         // soft hyphen
        {0x200b, 0x200f},     // zero width, direction
        {0x2028, 0x202e},     // line ends, direction
        {0x2060, 0x206f},     // joiners, direction
        {0xfeff, 0xfeff},     // byte order mark
        {0xfff0, 0xffff},     // specials
        {0xe0000, 0x10ffff},  // tags, private use
    }};
    return std::ranges::none_of(
        kHidden, [c](const Range& range) { return c >= range.first && c <= range.last; });
}

}  // namespace

std::string plain_line(std::string_view text, std::size_t max_bytes) {
    std::string line;
    while (!text.empty()) {
        std::uint32_t code_point = 0;
        const std::size_t size = decode(text, code_point);
        if (size == 0) {
            text.remove_prefix(1);
            continue;
        }
        const bool leading_space = line.empty() && code_point == ' ';
        if (is_visible(code_point) && !leading_space) {
            if (line.size() + size > max_bytes) break;
            line.append(text.substr(0, size));
        }
        text.remove_prefix(size);
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

}  // namespace fts::server
