// The text of a scene file as values, and where in it each of them stands. Says nothing about
// whether a scene can be made of them (scene_file.h).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "common/physics/generator.h"
#include "common/physics/scene.h"

namespace fts::lab {

struct SceneText {
    std::string name;
    physics::Scene scene;
    std::optional<physics::Generator> generator;
    // The place of the file, ":12:5", at which a field of the scene stands ("body[3].radius_m"), or
    // the nearest that holds it; empty when there is none.
    std::function<std::string(const std::string& field)> place_of;
};

// Or what is wrong: file, line, field, value and remedy.
std::variant<SceneText, std::string> read_scene_text(const std::string& text,
                                                     const std::string& file);

// "body[3].radius_m is -1; ..." with the names that stand in the file, in which only platforms have
// units: "body[3].radius is -1; ...".
std::string in_words_of_the_file(std::string message,
                                 const std::optional<physics::Platform>& platform);

}  // namespace fts::lab
