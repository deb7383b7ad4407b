// DataFolder: where a player's identity and preferences are kept on this machine:
//   player.key     the key pair that is the player (no passwords); whoever copies it is the player
//   known_servers  server keys pinned on first use (known_servers.h)
//   settings       name, last server (settings.h)
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/net/connection.h"

namespace fts::client {

class DataFolder {
  public:
    // `wanted` if it is not empty; otherwise $XDG_DATA_HOME/fear-the-sphere, or
    // ~/.local/share/fear-the-sphere. Made if it is missing, readable by its owner only. Empty with
    // `error` set to a message that names the path and a remedy.
    static std::optional<DataFolder> open(const std::string& wanted, std::string& error);

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path known_servers_path() const { return path_ / "known_servers"; }
    std::filesystem::path settings_path() const { return path_ / "settings"; }

    // The player's key pair, made on first use. `file_name` for programs that hold several players.
    // Empty with `error` set.
    std::optional<net::KeyPair> player_key(std::string& error,
                                           const std::string& file_name = "player.key") const;

  private:
    explicit DataFolder(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;
};

// Replaces the whole file at once: after a crash it holds the old text or the new one, never a
// part. False with `error` set to a message that names the path and a remedy.
bool write_file_atomically(const std::filesystem::path& path, const std::string& text,
                           std::string& error);

}  // namespace fts::client
