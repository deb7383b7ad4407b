// Keeps a second process away for as long as it lives. The kernel lets go when the process dies,
// however it dies; the file itself stays.
#pragma once

#include <string>

namespace fts::server {

class LockFile {
  public:
    LockFile() = default;
    ~LockFile();
    LockFile(const LockFile&) = delete;
    LockFile& operator=(const LockFile&) = delete;

    enum class Outcome { kHeld, kHeldByAnother, kCannotWrite };
    // With kCannotWrite `error` says why, in the system's words.
    Outcome acquire(const std::string& path, std::string& error);

  private:
    int descriptor_ = -1;
};

}  // namespace fts::server
