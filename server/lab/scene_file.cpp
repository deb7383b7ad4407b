#include "server/lab/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>
#include <variant>

#include "server/lab/scene_text.h"

namespace fts::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxSceneFileBytes = 128 * 1024 * 1024;
constexpr std::string_view kExtension = ".scene";

LoadedScene failed(std::string error) {
    LoadedScene scene;
    scene.error = std::move(error);
    return scene;
}

}  // namespace

LoadedScene parse_scene(const std::string& text, const std::string& file) {
    auto read = read_scene_text(text, file);
    if (const auto* error = std::get_if<std::string>(&read)) return failed(*error);
    const SceneText& found = std::get<SceneText>(read);
    const auto at_its_place = [&](const physics::SceneError& error) {
        return file + found.place_of(error.field) + ": " +
               in_words_of_the_file(error.message, found.scene.platform);
    };
    const bool is_plain = std::none_of(found.name.begin(), found.name.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    });
    if (!is_plain) {
        return failed(file + found.place_of("name") +
                      ": name holds a control character; give plain text on one line");
    }
    LoadedScene loaded;
    loaded.name = found.name.empty() ? fs::path(file).stem().string() : found.name;
    loaded.scene = found.scene;
    if (found.generator) {
        auto filled = physics::fill(found.scene, *found.generator);
        if (const auto* error = std::get_if<physics::SceneError>(&filled)) {
            return failed(at_its_place(*error));
        }
        loaded.scene = std::get<physics::Scene>(std::move(filled));
    } else if (loaded.scene.bodies.empty()) {
        return failed(file + ": body is missing; give at least one body, or a generator");
    } else if (const auto error = validate(loaded.scene, physics::Overlaps::kAccepted)) {
        return failed(at_its_place(*error));
    }
    // Generated bodies come last and overlap nothing.
    physics::Scene given = found.scene;
    given.walls = loaded.scene.walls;
    given.periodic = loaded.scene.periodic;
    if (const auto overlap = validate(given)) {
        loaded.warning = at_its_place(*overlap) + "; such a pair collides while it approaches";
    }
    return loaded;
}

std::vector<std::string> scene_names(const std::string& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        if (it->path().extension() == kExtension) names.push_back(it->path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

LoadedScene load_scene(const std::string& scene, const std::string& folder) {
    std::error_code error;
    fs::path path = scene;
    if (!fs::exists(path, error) && scene.find('/') == std::string::npos) {
        path =
            fs::path(folder) /
            (fs::path(scene).extension() == kExtension ? scene : scene + std::string(kExtension));
    }
    if (!fs::exists(path, error)) {
        std::string known;
        for (const std::string& name : scene_names(folder)) {
            known += (known.empty() ? "" : ", ") + name;
        }
        return failed("there is no scene '" + scene + "'; name a file" +
                      (known.empty() ? "" : ", or one of: " + known));
    }
    const auto size = fs::is_regular_file(path, error) ? fs::file_size(path, error) : 0;
    if (!error && size > kMaxSceneFileBytes) {
        return failed(path.string() + " is " + std::to_string(size) +
                      " bytes long; give a scene of at most " + std::to_string(kMaxSceneFileBytes) +
                      " bytes, or a generator");
    }
    if (fs::is_directory(path, error)) {
        return failed(path.string() + " is a folder; name one *.scene file in it");
    }
    std::ifstream in(path, std::ios::binary);
    std::ostringstream content;
    content << in.rdbuf();
    if (error || !in) return failed(path.string() + " cannot be read; make it a readable file");
    return parse_scene(content.str(), path.string());
}

std::string default_scenes_folder() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (error) return {};
    return (program.parent_path().parent_path() / "share" / "fear-the-sphere" / "scenes").string();
}

}  // namespace fts::lab
