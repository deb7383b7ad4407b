#include "common/net/identity.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "common/net/cipher.h"

namespace fts::net {
namespace {

// The file is this line and 64 hex digits, so that a person can tell what it is.
constexpr std::string_view kFileTitle = "fear-the-sphere secret key 1\n";
constexpr std::size_t kHexDigits = 2 * sizeof(SecretKey);
constexpr std::size_t kFileBytes = kFileTitle.size() + kHexDigits + 1;

using FileText = std::array<std::uint8_t, kFileBytes>;

class FileDescriptor {
  public:
    explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;
    ~FileDescriptor() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    int get() const { return descriptor_; }

  private:
    int descriptor_;
};

std::string reason() {
    return std::generic_category().message(errno);
}

char hex_digit(unsigned value) {
    return "0123456789abcdef"[value & 15U];
}

void put_hex(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> out) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        out[2 * i] = static_cast<std::uint8_t>(hex_digit(bytes[i] >> 4U));
        out[2 * i + 1] = static_cast<std::uint8_t>(hex_digit(bytes[i]));
    }
}

std::optional<SecretKey> parse_secret(std::string_view text) {
    if (text.size() != kFileBytes || !text.starts_with(kFileTitle) || text.back() != '\n') {
        return std::nullopt;
    }
    SecretKey secret{};
    const std::string_view digits = text.substr(kFileTitle.size(), kHexDigits);
    for (std::size_t i = 0; i < secret.size(); ++i) {
        const char* pair = digits.data() + 2 * i;
        if (std::from_chars(pair, pair + 2, secret[i], 16).ptr != pair + 2) return std::nullopt;
    }
    return secret;
}

enum class Existing { kRead, kMissing, kBad };

Existing read_existing(const std::string& path, KeyPair& keys, std::string& error) {
    const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0) {
        if (errno == ENOENT) return Existing::kMissing;
        error = "cannot read the key file " + path + ": " + reason() +
                "; make it readable by this user or name another file";
        return Existing::kBad;
    }
    std::array<char, kFileBytes + 1> text{};
    std::size_t size = 0;
    ssize_t got = 0;
    while (size < text.size() &&
           (got = ::read(file.get(), text.data() + size, text.size() - size)) > 0) {
        size += static_cast<std::size_t>(got);
    }
    if (got < 0) {
        error = "cannot read the key file " + path + ": " + reason();
        return Existing::kBad;
    }
    auto secret = parse_secret({text.data(), size});
    wipe(std::span(reinterpret_cast<std::uint8_t*>(text.data()), text.size()));
    if (!secret) {
        error =
            "the key file " + path +
            " is damaged or is something else; restore it from a copy, or move it away to start "
            "over with a new key";
        return Existing::kBad;
    }
    keys.secret_key = *secret;
    keys.public_key = public_key_of(*secret);
    wipe(*secret);
    return Existing::kRead;
}

bool write_all(int descriptor, std::span<const std::uint8_t> text) {
    std::size_t written = 0;
    while (written < text.size()) {
        const ssize_t count = ::write(descriptor, text.data() + written, text.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        written += static_cast<std::size_t>(count);
    }
    return ::fsync(descriptor) == 0;
}

// Never takes the place of a file that is there. Not every file system knows both ways.
bool put_in_place(const std::string& temporary, const std::string& path) {
    if (::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) == 0) {
        return true;
    }
    return errno != EEXIST && ::link(temporary.c_str(), path.c_str()) == 0;
}

// Puts the whole file in place or nothing; false with errno, EEXIST when somebody else was faster.
bool create_file(const std::string& path, std::span<const std::uint8_t> text) {
    std::array<std::uint8_t, 8> random{};
    fill_random(random);
    std::array<std::uint8_t, 16> suffix{};
    put_hex(random, suffix);
    const std::string temporary = path + "." + std::string(suffix.begin(), suffix.end());
    const FileDescriptor file(
        ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR));
    if (file.get() < 0) return false;
    bool done = write_all(file.get(), text);
    done = done && put_in_place(temporary, path);
    const int failure = errno;
    ::unlink(temporary.c_str());
    errno = failure;
    return done;
}

}  // namespace

KeyPair generate_key_pair() {
    KeyPair keys;
    fill_random(keys.secret_key);
    keys.public_key = public_key_of(keys.secret_key);
    return keys;
}

std::string short_name(const PublicKey& key) {
    std::array<std::uint8_t, 16> digits{};
    put_hex(std::span(key).first<8>(), digits);
    return {digits.begin(), digits.end()};
}

std::optional<KeyPair> load_or_create_key_pair(const std::string& path, std::string& error) {
    KeyPair keys;
    const Existing existing = read_existing(path, keys, error);
    if (existing == Existing::kRead) return keys;
    if (existing == Existing::kBad) return std::nullopt;

    keys = generate_key_pair();
    FileText text{};
    std::copy(kFileTitle.begin(), kFileTitle.end(), text.begin());
    put_hex(keys.secret_key, std::span(text).subspan(kFileTitle.size()));
    text.back() = '\n';
    std::error_code folder_error;
    const auto folder = std::filesystem::path(path).parent_path();
    if (!folder.empty()) std::filesystem::create_directories(folder, folder_error);
    const bool created = create_file(path, text);
    const int failure = errno;
    wipe(text);
    if (created) return keys;
    if (failure == EEXIST && read_existing(path, keys, error) == Existing::kRead) return keys;
    if (failure != EEXIST) {
        error = "cannot create the key file " + path + ": " +
                std::generic_category().message(failure) +
                "; make the folder writable or name another file";
    }
    return std::nullopt;
}

}  // namespace fts::net
