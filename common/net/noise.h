// The handshake Noise_XX_25519_ChaChaPoly_BLAKE2b (noiseprotocol.org, revision 34): three messages
// after which both ends have proven that they hold their key and share two new ones.
//
//     -> e        <- e, ee, s, es        -> s, se
//
// Knows neither datagram nor time. Messages that are not valid leave it as it was, so the true one
// may still come.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/net/cipher.h"

namespace fts::net {

// What seals and opens packets after the handshake, one key for each direction.
struct SessionKeys {
    SymmetricKey send, receive;
};

class NoiseXX {
  public:
    enum class Role : std::uint8_t { kInitiator, kResponder };

    // What messages cost on top of their payload.
    static constexpr std::size_t kMessage1Bytes = 32;
    static constexpr std::size_t kMessage2Bytes = 32 + 32 + kTagBytes + kTagBytes;
    static constexpr std::size_t kMessage3Bytes = 32 + kTagBytes + kTagBytes;

    // `ephemeral` must be fresh for each handshake. Both ends must pass the same prologue.
    NoiseXX(Role role, const KeyPair& identity, const KeyPair& ephemeral, Bytes prologue);
    NoiseXX(const NoiseXX&) = default;
    NoiseXX& operator=(const NoiseXX&) = default;
    ~NoiseXX();

    bool is_our_turn() const;
    bool is_complete() const { return messages_done_ == 3; }

    // The next message. Must be our turn. Empty when the other end's key turned out to be
    // worthless.
    std::optional<std::vector<std::uint8_t>> write(Bytes payload);
    // The payload of the other end's next message, or nothing when it is not valid (or not
    // expected).
    std::optional<std::vector<std::uint8_t>> read(Bytes message);

    // Known once message 2 (initiator) or message 3 (responder) has been read.
    const PublicKey& peer_identity() const { return peer_identity_; }
    // Only when complete.
    SessionKeys split() const;

  private:
    void mix_hash(Bytes data);
    void mix_key(Bytes input);
    bool mix_shared(const SecretKey& ours, const PublicKey& theirs);
    void append_encrypted(Bytes plaintext, std::vector<std::uint8_t>& out);
    bool take_decrypted(Bytes ciphertext, std::span<std::uint8_t> out);
    std::optional<std::vector<std::uint8_t>> read_tokens(Bytes message);

    Role role_;
    KeyPair identity_;
    KeyPair ephemeral_;
    PublicKey peer_identity_{};
    PublicKey peer_ephemeral_{};
    Hash chaining_key_{};
    Hash transcript_{};
    SymmetricKey key_;
    bool has_key_ = false;
    std::uint64_t nonce_ = 0;
    int messages_done_ = 0;
};

}  // namespace fts::net
