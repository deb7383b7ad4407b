// The argument SCENE, and the folder its names are looked for in, alike in every subcommand.
#pragma once

#include <optional>
#include <string>

#include "server/lab/scene_file.h"

namespace CLI {
class App;
}

namespace fts::lab {

struct SceneArgument {
    std::string scene;
    std::string folder = default_scenes_folder();
};

void declare(CLI::App& command, SceneArgument& argument);
// Empty when it was refused; stderr has been told why, and of what is only odd.
std::optional<LoadedScene> load(const SceneArgument& argument);

// "fts-lab: ..." on stderr.
void complain(const std::string& message);

}  // namespace fts::lab
