#include "server/economy/lock_file.h"

#include <cassert>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace fts::server {

LockFile::~LockFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

LockFile::Outcome LockFile::acquire(const std::string& path, std::string& error) {
    assert(descriptor_ < 0);
    descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (descriptor_ < 0) {
        error = std::strerror(errno);
        return Outcome::kCannotWrite;
    }
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return Outcome::kHeld;
    if (errno == EWOULDBLOCK) return Outcome::kHeldByAnother;
    error = std::strerror(errno);
    return Outcome::kCannotWrite;
}

}  // namespace fts::server
