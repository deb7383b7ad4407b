// Whether bytes are well-formed UTF-8 (RFC 3629): no overlong forms, no surrogates, nothing above
// U+10FFFF. Control characters are well-formed; who shows a text removes them.
#pragma once

#include <string_view>

namespace fts::replication {

bool is_utf8(std::string_view text);

}  // namespace fts::replication
