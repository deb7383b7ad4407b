#include "server/lab/scene_text.h"

#include <algorithm>
#include <array>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include "scene.pb.h"

namespace fts::lab {
namespace {

using google::protobuf::TextFormat;

constexpr std::size_t kMaxQuoted = 60;

std::string place(int line, int column) {
    return ":" + std::to_string(line + 1) + ":" + std::to_string(column + 1);
}

std::string line_at(const std::string& text, int line) {
    std::istringstream in(text);
    std::string found;
    for (int i = 0; i <= line && std::getline(in, found); ++i) {
    }
    const std::size_t first = found.find_first_not_of(" \t");
    if (first == std::string::npos) return {};
    found.erase(0, first);
    return found.size() > kMaxQuoted ? found.substr(0, kMaxQuoted) + "..." : found;
}

// What stands between the quotes after `before`.
std::string quoted_after(const std::string& message, std::string_view before) {
    const std::size_t at = message.find(before);
    if (at == std::string::npos) return {};
    const std::size_t begin = at + before.size();
    return message.substr(begin, message.find('"', begin) - begin);
}

std::string fields_of(const std::string& type) {
    const auto* descriptor =
        google::protobuf::DescriptorPool::generated_pool()->FindMessageTypeByName(type);
    std::string names;
    for (int i = 0; descriptor != nullptr && i < descriptor->field_count(); ++i) {
        names += (i == 0                               ? ""
                  : i + 1 == descriptor->field_count() ? " or "
                                                       : ", ") +
                 descriptor->field(i)->name();
    }
    return names;
}

// Keeps the first error, with the line that it is about.
class FirstError : public google::protobuf::io::ErrorCollector {
  public:
    FirstError(const std::string& text, const std::string& file) : text_(text), file_(file) {}

    // Lines and columns count from 0; a line of -1 is none.
    void AddError(int line, google::protobuf::io::ColumnNumber column,
                  const std::string& message) override {
        if (!words_.empty()) return;
        words_ = file_ + (line >= 0 ? place(line, column) : "") + ": ";
        const std::string field = quoted_after(message, "no field named \"");
        if (field.empty()) {
            words_ += message;
        } else {
            const std::string type = quoted_after(message, "Message type \"");
            words_ += "'" + field + "' is unknown";
            if (const std::string known = fields_of(type); !known.empty()) {
                words_ += " in " + type.substr(type.rfind('.') + 1) + "; give " + known;
            }
        }
        if (line >= 0) words_ += " (the line is: " + line_at(text_, line) + ")";
    }
    const std::string& words() const { return words_; }

  private:
    const std::string& text_;
    const std::string& file_;
    std::string words_;
};

physics::Vec2d vector_of(const scene::Vector& vector) {
    return {vector.x(), vector.y()};
}

physics::BodyDef body_of(const scene::Body& file) {
    physics::BodyDef body;
    body.position_m = vector_of(file.position());
    body.velocity_mps = vector_of(file.velocity());
    if (file.has_radius()) body.radius_m = file.radius();
    if (file.has_mass()) body.mass_kg = file.mass();
    return body;
}

physics::Platform platform_of(const scene::Platform& platform) {
    if (platform.has_disc()) return physics::Disc{platform.disc().radius_m()};
    if (platform.has_ring()) {
        return physics::Ring{platform.ring().inner_radius_m(), platform.ring().outer_radius_m()};
    }
    return physics::Rectangle{
        {platform.rectangle().width_m() / 2.0, platform.rectangle().height_m() / 2.0}};
}

physics::Generator generator_of(const scene::Generator& file) {
    physics::Generator generator;
    generator.seed = file.seed();
    if (file.has_count()) generator.count = file.count();
    if (file.has_packing_fraction()) generator.packing_fraction = file.packing_fraction();
    if (file.has_radius_min()) {
        generator.radius_min_m = file.radius_min();
        generator.radius_max_m = file.radius_min();
    }
    if (file.has_radius_max()) {
        generator.radius_max_m = file.radius_max();
        if (!file.has_radius_min()) generator.radius_min_m = file.radius_max();
    }
    if (file.mass() == scene::Generator::BY_AREA) generator.mass = physics::MassRule::kByArea;
    if (file.has_speed_rms()) generator.speed_rms_mps = file.speed_rms();
    return generator;
}

physics::Scene scene_of(const scene::Scene& file) {
    physics::Scene scene;
    for (const scene::Body& body : file.body()) scene.bodies.push_back(body_of(body));
    if (file.has_walls()) {
        scene.walls = {vector_of(file.walls().min()), vector_of(file.walls().max())};
    }
    if (file.has_periodic()) {
        scene.periodic = {vector_of(file.periodic().min()), vector_of(file.periodic().max())};
    }
    if (file.has_platform()) scene.platform = platform_of(file.platform());
    scene.drag_per_s = file.drag();
    if (file.has_restitution()) scene.restitution = file.restitution();
    return scene;
}

bool is_of_a_name(char c) {
    return c == '_' || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
}

// Whole names only: "radius_m", but not in "radius_min".
void rename_all(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
        const std::size_t end = at + from.size();
        const bool begins = at == 0 || !is_of_a_name(text[at - 1]);
        if (begins && (end == text.size() || !is_of_a_name(text[end]))) {
            text.replace(at, from.size(), to);
            at += to.size();
        } else {
            at = end;
        }
    }
}

// Follows "body[3].radius" into the file as far as it has it.
std::string find_place(const std::string& path, const TextFormat::ParseInfoTree* tree) {
    const auto* type = scene::Scene::descriptor();
    std::string found;
    std::istringstream steps(path);
    for (std::string step; type != nullptr && tree != nullptr && std::getline(steps, step, '.');) {
        const std::size_t bracket = step.find('[');
        const auto* field = type->FindFieldByName(step.substr(0, bracket));
        if (field == nullptr) break;
        const int index = bracket == std::string::npos ? -1 : std::stoi(step.substr(bracket + 1));
        if (field->is_repeated() != (index >= 0)) break;
        const TextFormat::ParseLocation at = tree->GetLocation(field, index);
        if (at.line >= 0) found = place(at.line, at.column);
        tree = tree->GetTreeForNested(field, index);
        type = field->message_type();
    }
    return found;
}

}  // namespace

std::variant<SceneText, std::string> read_scene_text(const std::string& text,
                                                     const std::string& file) {
    scene::Scene parsed;
    FirstError first_error(text, file);
    const auto locations = std::make_shared<TextFormat::ParseInfoTree>();
    TextFormat::Parser parser;
    parser.RecordErrorsTo(&first_error);
    parser.WriteLocationsTo(locations.get());
    if (!parser.ParseFromString(text, &parsed)) return first_error.words();

    SceneText result;
    result.name = parsed.name();
    result.place_of = [locations, platform = parsed.has_platform()
                                                 ? std::optional(platform_of(parsed.platform()))
                                                 : std::nullopt](const std::string& field) {
        return find_place(in_words_of_the_file(field, platform), locations.get());
    };
    if (parsed.has_platform() && parsed.platform().shape_case() == scene::Platform::SHAPE_NOT_SET) {
        return file + result.place_of("platform") +
               ": platform is empty; give a disc, a rectangle or a ring";
    }
    result.scene = scene_of(parsed);
    if (parsed.has_generator()) result.generator = generator_of(parsed.generator());
    return result;
}

std::string in_words_of_the_file(std::string message,
                                 const std::optional<physics::Platform>& platform) {
    if (message.starts_with("platform.") && platform) {
        constexpr std::array<std::string_view, 3> kShapes = {"disc.", "rectangle.", "ring."};
        message.insert(std::string_view("platform.").size(), kShapes[platform->index()]);
        rename_all(message, "half_extents_m.x is", "width_m, halved, is");
        rename_all(message, "half_extents_m.y is", "height_m, halved, is");
        rename_all(message, "half_extents_m.x", "width_m");
        rename_all(message, "half_extents_m.y", "height_m");
        return message;
    }
    constexpr std::pair<std::string_view, std::string_view> kNames[] = {
        {"radius_m", "radius"},       {"mass_kg", "mass"}, {"position_m", "position"},
        {"velocity_mps", "velocity"}, {"min_m", "min"},    {"max_m", "max"},
        {"drag_per_s", "drag"},
    };
    for (const auto& [from, to] : kNames) rename_all(message, from, to);
    return message;
}

}  // namespace fts::lab
