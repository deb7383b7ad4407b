// A scene file is whatever somebody wrote: parse_scene answers with a valid scene or with words,
// never both. Generators of thousands of balls are right too, but slow, and left out.
#include <cstdlib>
#include <string>
#include <variant>

#include "server/lab/scene_file.h"
#include "server/lab/scene_text.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::int64_t kManyBalls = 500;
    const std::string text(reinterpret_cast<const char*>(data), size);
    const auto read = fts::lab::read_scene_text(text, "fuzzed.scene");
    if (const auto* found = std::get_if<fts::lab::SceneText>(&read)) {
        const bool is_slow =
            found->generator && found->generator->count.value_or(kManyBalls + 1) > kManyBalls;
        if (is_slow) return 0;
    }
    const fts::lab::LoadedScene loaded = fts::lab::parse_scene(text, "fuzzed.scene");
    if (!loaded.error.empty()) return 0;
    if (loaded.scene.bodies.empty()) std::abort();
    if (validate(loaded.scene, fts::physics::Overlaps::kAccepted)) std::abort();
    return 0;
}
