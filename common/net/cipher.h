// The cryptographic primitives that the handshake and the sealed packets are made of: X25519,
// BLAKE2b, ChaCha20-Poly1305. All of libsodium that the project uses is in cipher.cpp. No protocol
// here.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "common/net/bytes.h"
#include "common/net/identity.h"

namespace fts::net {

inline constexpr std::size_t kTagBytes = 16;
inline constexpr std::size_t kHashBytes = 64;

using Hash = std::array<std::uint8_t, kHashBytes>;
using Mac = std::array<std::uint8_t, 32>;

void wipe(std::span<std::uint8_t> secret);

// 32 secret bytes that are wiped when they go out of scope.
struct SymmetricKey {
    std::array<std::uint8_t, 32> bytes{};

    SymmetricKey() = default;
    explicit SymmetricKey(std::span<const std::uint8_t, 32> from);
    SymmetricKey(const SymmetricKey&) = default;
    SymmetricKey& operator=(const SymmetricKey&) = default;
    ~SymmetricKey() { wipe(bytes); }
};

void fill_random(std::span<std::uint8_t> out);
bool equal_in_constant_time(Bytes a, Bytes b);

PublicKey public_key_of(const SecretKey& secret);
// False when `theirs` is a point of low order, whose result would be known to everybody.
bool diffie_hellman(const SecretKey& ours, const PublicKey& theirs, SymmetricKey& shared);

// BLAKE2b-512 of the parts, one after the other.
Hash blake2b(std::initializer_list<Bytes> parts);
// Keyed BLAKE2b-256 of the parts.
Mac keyed_mac(const SymmetricKey& key, std::initializer_list<Bytes> parts);
// HKDF of the Noise specification, section 4.3, over HMAC-BLAKE2b: two outputs.
struct HkdfOutput {
    Hash first{}, second{};
    HkdfOutput() = default;
    HkdfOutput(const HkdfOutput&) = default;
    HkdfOutput& operator=(const HkdfOutput&) = default;
    ~HkdfOutput() {
        wipe(first);
        wipe(second);
    }
};
HkdfOutput hkdf(const Hash& chaining_key, Bytes input);

// ChaCha20-Poly1305 with the Noise nonce (32 zero bits, then `nonce` little-endian). `out` must
// have kTagBytes more than `plaintext`. A nonce must never be used twice with one key.
void seal(const SymmetricKey& key, std::uint64_t nonce, Bytes header, Bytes plaintext,
          std::span<std::uint8_t> out);
// `out` must have kTagBytes fewer than `ciphertext`. False when anything was altered.
bool open(const SymmetricKey& key, std::uint64_t nonce, Bytes header, Bytes ciphertext,
          std::span<std::uint8_t> out);

}  // namespace fts::net
