#include "client/core/data_folder.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

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

bool write_and_sync(int file, const std::string& text) {
    std::size_t written = 0;
    while (written < text.size()) {
        const ssize_t count = ::write(file, text.data() + written, text.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        written += static_cast<std::size_t>(count);
    }
    return ::fsync(file) == 0;
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
    // Several programs may write at once: each has its own draft.
    const std::string draft = path.string() + ".new." + std::to_string(::getpid());
    const int file = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    bool written = file >= 0 && write_and_sync(file, text);
    int problem = written ? 0 : errno;
    if (file >= 0) ::close(file);
    if (written && std::rename(draft.c_str(), path.c_str()) != 0) {
        written = false;
        problem = errno;
    }
    if (written) return true;
    ::unlink(draft.c_str());
    error = "Cannot write " + path.string() + ": " + std::strerror(problem) +
            ". Make room or the folder writable, or give another one with --data.";
    return false;
}

}  // namespace fts::client
