// Levels of the campaign, read from text files (*.level, protobuf text format, proto/scene.proto).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/game/level.h"

namespace fts::server {

struct LoadedLevels {
    std::vector<game::Level> levels;  // by number
    std::string error;  // not empty: names file, field, value and remedy, and `levels` is empty
};

// All *.level files of a folder. They must be numbered 1, 2, 3, ... without gaps.
LoadedLevels load_levels(const std::string& folder);
// One file; `text` is its content, `file` its name for the error.
LoadedLevels parse_level(const std::string& text, const std::string& file);

}  // namespace fts::server
