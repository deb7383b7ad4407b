// Settings: what a player has chosen, in a text file of lines "name = value". Settings that this
// version does not know are kept.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fts::client {

struct Settings {
    std::string player_name = "player";
    std::string last_server;  // as typed
    std::map<std::string, std::string> others;
};

struct LoadedSettings {
    Settings settings;
    std::vector<std::string> problems;  // each names file, line and remedy
};

// A file that does not exist gives the defaults.
LoadedSettings load_settings(const std::filesystem::path& path);
// False with `error` set. Line breaks within a value become spaces.
bool save_settings(const Settings& settings, const std::filesystem::path& path, std::string& error);

}  // namespace fts::client
