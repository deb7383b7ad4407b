#include "server/lab/scene_argument.h"

#include <cstdio>

#include <CLI/CLI.hpp>

namespace fts::lab {

void declare(CLI::App& command, SceneArgument& argument) {
    command
        .add_option("SCENE", argument.scene,
                    "A scene file, or the name of one that came with this program")
        ->required();
    command.add_option("--scenes", argument.folder, "Folder in which scenes go by their names")
        ->envname("FTS_SCENES")
        ->capture_default_str();
}

std::optional<LoadedScene> load(const SceneArgument& argument) {
    LoadedScene loaded = load_scene(argument.scene, argument.folder);
    if (!loaded.error.empty()) {
        complain(loaded.error);
        return std::nullopt;
    }
    if (!loaded.warning.empty()) complain("warning: " + loaded.warning);
    return loaded;
}

void complain(const std::string& message) {
    std::fprintf(stderr, "fts-lab: %s\n", message.c_str());
}

}  // namespace fts::lab
