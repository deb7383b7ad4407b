// Scenes of the laboratory, read from text files (protobuf text format, proto/scene.proto).
#pragma once

#include <string>
#include <vector>

#include "common/physics/scene.h"

namespace fts::lab {

struct LoadedScene {
    std::string name;  // of the file when it has none inside
    physics::Scene scene;
    std::string warning;  // not empty: bodies overlap at the start
    // Not empty: names file, line, field, value and remedy in the file's own words, and nothing
    // else holds.
    std::string error;
};

// `text` is the content of a file, `file` its name for messages. Bodies may overlap; all else is
// held to physics::validate, and a generator to physics::fill.
LoadedScene parse_scene(const std::string& text, const std::string& file);

// `scene` is a file, or else the name of a scene in `folder`, with or without ".scene".
LoadedScene load_scene(const std::string& scene, const std::string& folder);

// Names of the scenes in a folder, sorted.
std::vector<std::string> scene_names(const std::string& folder);

// share/fear-the-sphere/scenes beside the bin folder of this executable.
std::string default_scenes_folder();

}  // namespace fts::lab
