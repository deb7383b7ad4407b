#include "common/net/cipher.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <cstdlib>

#include <sodium.h>

namespace fts::net {
namespace {

// BLAKE2b's input block, which HMAC pads its key to (RFC 2104, RFC 7693).
constexpr std::size_t kHashBlockBytes = 128;

void require_sodium() {
    static const bool ready = sodium_init() >= 0;
    if (!ready) {
        std::fputs("libsodium could not be initialised: the system gives no random bytes\n",
                   stderr);
        std::abort();
    }
}

Hash hmac(Bytes key, std::initializer_list<Bytes> parts) {
    assert(key.size() <= kHashBlockBytes);
    std::array<std::uint8_t, kHashBlockBytes> inner_pad{};
    std::array<std::uint8_t, kHashBlockBytes> outer_pad{};
    inner_pad.fill(0x36);
    outer_pad.fill(0x5c);
    for (std::size_t i = 0; i < key.size(); ++i) {
        inner_pad[i] ^= key[i];
        outer_pad[i] ^= key[i];
    }
    crypto_generichash_blake2b_state state;
    crypto_generichash_blake2b_init(&state, nullptr, 0, kHashBytes);
    crypto_generichash_blake2b_update(&state, inner_pad.data(), inner_pad.size());
    for (const Bytes part : parts) {
        crypto_generichash_blake2b_update(&state, part.data(), part.size());
    }
    Hash inner;
    crypto_generichash_blake2b_final(&state, inner.data(), inner.size());
    const Hash result = blake2b({outer_pad, inner});
    wipe(inner_pad);
    wipe(outer_pad);
    wipe(inner);
    sodium_memzero(&state, sizeof(state));
    return result;
}

std::array<std::uint8_t, crypto_aead_chacha20poly1305_ietf_NPUBBYTES> noise_nonce(
    std::uint64_t nonce) {
    std::array<std::uint8_t, crypto_aead_chacha20poly1305_ietf_NPUBBYTES> bytes{};
    ByteWriter writer(bytes);
    writer.put(std::uint32_t{0});
    writer.put(nonce);
    return bytes;
}

}  // namespace

static_assert(kTagBytes == crypto_aead_chacha20poly1305_ietf_ABYTES);
static_assert(kHashBytes == crypto_generichash_blake2b_BYTES_MAX);

SymmetricKey::SymmetricKey(std::span<const std::uint8_t, 32> from) {
    std::copy(from.begin(), from.end(), bytes.begin());
}

void wipe(std::span<std::uint8_t> secret) {
    sodium_memzero(secret.data(), secret.size());
}

void fill_random(std::span<std::uint8_t> out) {
    require_sodium();
    randombytes_buf(out.data(), out.size());
}

bool equal_in_constant_time(Bytes a, Bytes b) {
    return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

PublicKey public_key_of(const SecretKey& secret) {
    require_sodium();
    PublicKey key;
    crypto_scalarmult_base(key.data(), secret.data());
    return key;
}

bool diffie_hellman(const SecretKey& ours, const PublicKey& theirs, SymmetricKey& shared) {
    require_sodium();
    return crypto_scalarmult(shared.bytes.data(), ours.data(), theirs.data()) == 0;
}

Hash blake2b(std::initializer_list<Bytes> parts) {
    require_sodium();
    crypto_generichash_blake2b_state state;
    crypto_generichash_blake2b_init(&state, nullptr, 0, kHashBytes);
    for (const Bytes part : parts) {
        crypto_generichash_blake2b_update(&state, part.data(), part.size());
    }
    Hash result;
    crypto_generichash_blake2b_final(&state, result.data(), result.size());
    sodium_memzero(&state, sizeof(state));
    return result;
}

Mac keyed_mac(const SymmetricKey& key, std::initializer_list<Bytes> parts) {
    require_sodium();
    Mac mac;
    crypto_generichash_blake2b_state state;
    crypto_generichash_blake2b_init(&state, key.bytes.data(), key.bytes.size(), mac.size());
    for (const Bytes part : parts) {
        crypto_generichash_blake2b_update(&state, part.data(), part.size());
    }
    crypto_generichash_blake2b_final(&state, mac.data(), mac.size());
    sodium_memzero(&state, sizeof(state));
    return mac;
}

HkdfOutput hkdf(const Hash& chaining_key, Bytes input) {
    const std::array<std::uint8_t, 1> one{1};
    const std::array<std::uint8_t, 1> two{2};
    Hash temporary_key = hmac(chaining_key, {input});
    HkdfOutput output;
    output.first = hmac(temporary_key, {one});
    output.second = hmac(temporary_key, {output.first, two});
    wipe(temporary_key);
    return output;
}

void seal(const SymmetricKey& key, std::uint64_t nonce, Bytes header, Bytes plaintext,
          std::span<std::uint8_t> out) {
    require_sodium();
    assert(out.size() == plaintext.size() + kTagBytes);
    crypto_aead_chacha20poly1305_ietf_encrypt(out.data(), nullptr, plaintext.data(),
                                              plaintext.size(), header.data(), header.size(),
                                              nullptr, noise_nonce(nonce).data(), key.bytes.data());
}

bool open(const SymmetricKey& key, std::uint64_t nonce, Bytes header, Bytes ciphertext,
          std::span<std::uint8_t> out) {
    require_sodium();
    assert(out.size() + kTagBytes == ciphertext.size());
    return crypto_aead_chacha20poly1305_ietf_decrypt(
               out.data(), nullptr, nullptr, ciphertext.data(), ciphertext.size(), header.data(),
               header.size(), noise_nonce(nonce).data(), key.bytes.data()) == 0;
}

}  // namespace fts::net
