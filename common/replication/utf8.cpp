#include "common/replication/utf8.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace fts::replication {
namespace {

constexpr std::uint32_t kFirstSurrogate = 0xD800, kLastSurrogate = 0xDFFF;
constexpr std::uint32_t kLastCodePoint = 0x10FFFF;

struct Form {
    std::uint8_t lead_mask, lead;
    std::size_t bytes;
    std::uint32_t least;  // a smaller code point has a shorter form
};
constexpr Form kForms[] = {
    {0x80, 0x00, 1, 0}, {0xE0, 0xC0, 2, 0x80}, {0xF0, 0xE0, 3, 0x800}, {0xF8, 0xF0, 4, 0x10000}};

// Bytes of the character that `text` begins with; 0 when it begins with none.
std::size_t first_character_bytes(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const auto* form = std::find_if(std::begin(kForms), std::end(kForms), [&](const Form& f) {
        return (byte(0) & f.lead_mask) == f.lead;
    });
    if (form == std::end(kForms) || text.size() < form->bytes) return 0;
    std::uint32_t code_point = byte(0) & static_cast<std::uint8_t>(~form->lead_mask);
    for (std::size_t i = 1; i < form->bytes; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return 0;
        code_point = code_point << 6 | (byte(i) & 0x3FU);
    }
    const bool surrogate = code_point >= kFirstSurrogate && code_point <= kLastSurrogate;
    return code_point < form->least || code_point > kLastCodePoint || surrogate ? 0 : form->bytes;
}

}  // namespace

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const std::size_t bytes = first_character_bytes(text);
        if (bytes == 0) return false;
        text.remove_prefix(bytes);
    }
    return true;
}

}  // namespace fts::replication
