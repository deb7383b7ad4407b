// Who somebody is: an X25519 key pair, kept in a file of the user's. No passwords, no names.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace fts::net {

using PublicKey = std::array<std::uint8_t, 32>;
using SecretKey = std::array<std::uint8_t, 32>;
struct KeyPair {
    PublicKey public_key{};
    SecretKey secret_key{};
};
KeyPair generate_key_pair();
// Hex of the first 8 bytes, for logs and screens.
std::string short_name(const PublicKey& key);

// Reads the key pair kept at `path`, or makes one (file mode 0600, missing folders included). Empty
// with `error` set to a message that names the path and a remedy. A file that is there is never
// replaced, whatever it holds; of two programs that create it at once, both get the same key.
std::optional<KeyPair> load_or_create_key_pair(const std::string& path, std::string& error);

}  // namespace fts::net
