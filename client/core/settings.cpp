#include "client/core/settings.h"

#include <algorithm>
#include <fstream>

#include "client/core/data_folder.h"

namespace fts::client {
namespace {

constexpr const char* kNameKey = "player_name";
constexpr const char* kServerKey = "last_server";

std::string trimmed(const std::string& text) {
    constexpr const char* kBlank = " \t\r";
    const auto first = text.find_first_not_of(kBlank);
    if (first == std::string::npos) return "";
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string one_line(std::string value) {
    std::ranges::replace_if(
        value, [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return value;
}

}  // namespace

LoadedSettings load_settings(const std::filesystem::path& path) {
    LoadedSettings loaded;
    std::error_code failure;
    if (!std::filesystem::exists(path, failure) && !failure) return loaded;
    std::ifstream file(path);
    if (!file) {
        loaded.problems.push_back("Cannot read " + path.string() +
                                  "; the defaults are used. Make it readable.");
        return loaded;
    }
    std::string text;
    for (int number = 1; std::getline(file, text); ++number) {
        const auto equals = text.find('=');
        const std::string key = trimmed(text.substr(0, equals));
        if (key.empty() && equals == std::string::npos) continue;
        if (key.empty() || equals == std::string::npos) {
            loaded.problems.push_back(path.string() + ":" + std::to_string(number) +
                                      " is not \"name = value\"; it is ignored. Correct or remove "
                                      "the line.");
            continue;
        }
        const std::string value = trimmed(text.substr(equals + 1));
        if (key == kNameKey) {
            loaded.settings.player_name = value;
        } else if (key == kServerKey) {
            loaded.settings.last_server = value;
        } else {
            loaded.settings.others[key] = value;
        }
    }
    return loaded;
}

bool save_settings(const Settings& settings, const std::filesystem::path& path,
                   std::string& error) {
    std::map<std::string, std::string> all = settings.others;
    all[kNameKey] = settings.player_name;
    all[kServerKey] = settings.last_server;
    std::string text;
    for (const auto& [key, value] : all) text += key + " = " + one_line(value) + "\n";
    return write_file_atomically(path, text, error);
}

}  // namespace fts::client
