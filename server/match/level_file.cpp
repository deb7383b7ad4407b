#include "server/match/level_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include <climits>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include "scene.pb.h"
#include "server/match/level_check.h"

namespace fts::server {
namespace {

constexpr std::uintmax_t kMaxLevelFileBytes = 64 * 1024;
constexpr std::string_view kExtension = ".level";

LoadedLevels failed(std::string error) {
    return {.levels = {}, .error = std::move(error)};
}

// Keeps the first error; the parser counts lines from 0, and gives -1 when it knows none.
class FirstError : public google::protobuf::io::ErrorCollector {
  public:
    void AddError(int line, google::protobuf::io::ColumnNumber column,
                  const std::string& message) override {
        if (!text_.empty()) return;
        std::ostringstream out;
        if (line >= 0) out << ':' << line + 1 << ':' << column + 1;
        out << ": " << message;
        text_ = out.str();
    }
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

std::optional<physics::Platform> platform_of(const scene::Platform& platform) {
    switch (platform.shape_case()) {
        case scene::Platform::kDisc:
            return physics::Disc{platform.disc().radius_m()};
        case scene::Platform::kRectangle:
            return physics::Rectangle{
                {platform.rectangle().width_m() / 2.0, platform.rectangle().height_m() / 2.0}};
        case scene::Platform::kRing:
            return physics::Ring{platform.ring().inner_radius_m(),
                                 platform.ring().outer_radius_m()};
        case scene::Platform::SHAPE_NOT_SET:
            break;
    }
    return std::nullopt;
}

// Numbers beyond an int are out of every range, and stay so.
int whole(std::uint32_t value) {
    return static_cast<int>(std::min<std::uint32_t>(value, INT_MAX));
}

game::AiGroup group_of(const scene::AiGroup& group) {
    game::AiGroup result;
    result.behaviour = static_cast<game::Behaviour>(group.behaviour() - scene::CHASER);
    result.difficulty = static_cast<game::Difficulty>(group.difficulty() - scene::NOVICE);
    if (group.has_count()) result.count = whole(group.count());
    if (group.has_radius_m()) result.radius_m = group.radius_m();
    if (group.has_mass_kg()) result.mass_kg = group.mass_kg();
    if (group.has_thrust_n()) result.thrust_n = group.thrust_n();
    if (group.has_top_speed_mps()) result.top_speed_mps = group.top_speed_mps();
    return result;
}

static_assert(static_cast<int>(game::Behaviour::kChaser) == 0);
static_assert(static_cast<int>(game::Behaviour::kEdgeGuard) == scene::EDGE_GUARD - scene::CHASER);
static_assert(static_cast<int>(game::Behaviour::kInterceptor) ==
              scene::INTERCEPTOR - scene::CHASER);
static_assert(static_cast<int>(game::Behaviour::kHerd) == scene::HERD - scene::CHASER);
static_assert(static_cast<int>(game::Behaviour::kCoward) == scene::COWARD - scene::CHASER);
static_assert(static_cast<int>(game::Behaviour::kBruiser) == scene::BRUISER - scene::CHASER);
static_assert(static_cast<int>(game::Difficulty::kExpert) == scene::EXPERT - scene::NOVICE);

// What a value of the file's own kind can miss before it becomes a level.
std::optional<std::string> missing_in(const scene::Level& file) {
    if (platform_of(file.platform()) == std::nullopt)
        return "platform is missing; give a disc, a rectangle or a ring";
    for (int i = 0; i < file.ai_size(); ++i) {
        const std::string group = "ai[" + std::to_string(i) + "].";
        if (file.ai(i).behaviour() == scene::BEHAVIOUR_UNSPECIFIED)
            return group + "behaviour is missing; give CHASER, EDGE_GUARD, INTERCEPTOR, HERD, " +
                   "COWARD or BRUISER";
        if (file.ai(i).difficulty() == scene::DIFFICULTY_UNSPECIFIED)
            return group + "difficulty is missing; give NOVICE, EASY, NORMAL, HARD or EXPERT";
    }
    return std::nullopt;
}

}  // namespace

LoadedLevels parse_level(const std::string& text, const std::string& file) {
    scene::Level parsed;
    FirstError first_error;
    google::protobuf::TextFormat::Parser parser;
    parser.RecordErrorsTo(&first_error);
    // A mistyped number such as "radius_m: 1e999" becomes infinite here and is refused by its
    // range.
    if (!parser.ParseFromString(text, &parsed)) return failed(file + first_error.text());
    if (const auto missing = missing_in(parsed)) return failed(file + ": " + *missing);

    game::Level level;
    level.number = whole(parsed.number());
    level.name = parsed.name();
    level.hint = parsed.hint();
    level.platform = *platform_of(parsed.platform());
    for (const scene::AiGroup& group : parsed.ai()) level.ai.push_back(group_of(group));
    level.field_coins = whole(parsed.field_coins());
    if (parsed.has_time_limit_s()) level.time_limit_s = parsed.time_limit_s();
    if (const auto fault = fault_of(level)) return failed(file + ": " + *fault);
    return {.levels = {std::move(level)}, .error = {}};
}

LoadedLevels load_levels(const std::string& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (it->path().extension() == kExtension) files.push_back(it->path());
    if (error)
        return failed(folder + ": " + error.message() + "; name a folder with *.level files");
    if (files.empty())
        return failed(folder + " holds no *.level file; name a folder with levels 1, 2, 3, ...");
    std::sort(files.begin(), files.end());

    std::vector<std::pair<game::Level, std::string>> found;
    for (const fs::path& path : files) {
        const auto size = fs::file_size(path, error);
        if (!error && size > kMaxLevelFileBytes)
            return failed(path.string() + " is " + std::to_string(size) +
                          " bytes long; give a level of at most " +
                          std::to_string(kMaxLevelFileBytes) + " bytes");
        std::ifstream in(path, std::ios::binary);
        std::ostringstream content;
        content << in.rdbuf();
        if (error || !in) return failed(path.string() + " cannot be read; make it a readable file");
        LoadedLevels one = parse_level(content.str(), path.string());
        if (!one.error.empty()) return one;
        found.emplace_back(std::move(one.levels.front()), path.string());
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first.number < b.first.number; });
    LoadedLevels result;
    for (auto& [level, file] : found) {
        const int expected = static_cast<int>(result.levels.size()) + 1;
        if (level.number != expected)
            return failed(file + ": number is " + std::to_string(level.number) + "; give " +
                          std::to_string(expected) +
                          ", for levels are numbered 1, 2, 3, ... without gaps or repeats");
        result.levels.push_back(std::move(level));
    }
    return result;
}

}  // namespace fts::server
