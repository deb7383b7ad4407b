#include "client/core/data_folder.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>

namespace fts::client {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolderName = "fear-the-sphere";

// Empty when the environment names no home at all.
fs::path default_path() {
    const char* data_home = std::getenv("XDG_DATA_HOME");
    // The XDG specification says that a relative path must be ignored.
    if (data_home != nullptr && data_home[0] == '/') return fs::path(data_home) / kFolderName;
    const char* home = std::getenv("HOME");
    if (home == nullptr || home[0] == '\0') return {};
    return fs::path(home) / ".local" / "share" / kFolderName;
}

// Several programs may write at once: each has its own draft.
fs::path draft_of(const fs::path& path) {
    std::random_device entropy;
    return path.string() + ".new." + std::to_string(entropy());
}

bool write_draft(const fs::path& draft, const std::string& text) {
    std::ofstream file(draft, std::ios::binary | std::ios::trunc);
    std::error_code failure;
    fs::permissions(draft, fs::perms::owner_read | fs::perms::owner_write, failure);
    return static_cast<bool>(file << text << std::flush);
}

}  // namespace

std::optional<DataFolder> DataFolder::open(const std::string& wanted, std::string& error) {
    const fs::path path = wanted.empty() ? default_path() : fs::path(wanted);
    if (path.empty()) {
        error =
            "There is no place for the player's key: neither HOME nor XDG_DATA_HOME is set. "
            "Give a folder with --data.";
        return std::nullopt;
    }
    std::error_code failure;
    const bool made = fs::create_directories(path, failure);
    if (failure || !fs::is_directory(path, failure)) {
        error = "Cannot make the data folder " + path.string() +
                (failure ? ": " + failure.message() : ": it is a file") +
                ". Give a folder that can be written to with --data.";
        return std::nullopt;
    }
    if (made) fs::permissions(path, fs::perms::owner_all, failure);
    return DataFolder(path);
}

std::optional<net::KeyPair> DataFolder::player_key(std::string& error,
                                                   const std::string& file_name) const {
    return net::load_or_create_key_pair((path_ / file_name).string(), error);
}

bool write_file_atomically(const fs::path& path, const std::string& text, std::string& error) {
    const fs::path draft = draft_of(path);
    std::error_code failure;
    errno = 0;
    if (write_draft(draft, text)) {
        fs::rename(draft, path, failure);
        if (!failure) return true;
    } else {
        failure.assign(errno != 0 ? errno : EIO, std::generic_category());
    }
    std::error_code ignored;
    fs::remove(draft, ignored);
    error = "Cannot write " + path.string() + ": " + failure.message() +
            ". Make room or the folder writable, or give another one with --data.";
    return false;
}

}  // namespace fts::client
