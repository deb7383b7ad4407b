#include "common/net/noise.h"

#include <algorithm>
#include <cassert>
#include <string_view>

namespace fts::net {
namespace {

constexpr std::string_view kProtocolName = "Noise_XX_25519_ChaChaPoly_BLAKE2b";
static_assert(kProtocolName.size() <= kHashBytes, "a longer name would have to be hashed");

}  // namespace

NoiseXX::NoiseXX(Role role, const KeyPair& identity, const KeyPair& ephemeral, Bytes prologue)
    : role_(role), identity_(identity), ephemeral_(ephemeral) {
    std::copy(kProtocolName.begin(), kProtocolName.end(), transcript_.begin());
    chaining_key_ = transcript_;
    mix_hash(prologue);
}

NoiseXX::~NoiseXX() {
    wipe(identity_.secret_key);
    wipe(ephemeral_.secret_key);
    wipe(chaining_key_);
}

bool NoiseXX::is_our_turn() const {
    const bool initiators_turn = messages_done_ % 2 == 0;
    return !is_complete() && initiators_turn == (role_ == Role::kInitiator);
}

std::optional<std::vector<std::uint8_t>> NoiseXX::write(Bytes payload) {
    assert(is_our_turn());
    std::vector<std::uint8_t> message;
    if (messages_done_ < 2) {
        message.insert(message.end(), ephemeral_.public_key.begin(), ephemeral_.public_key.end());
        mix_hash(ephemeral_.public_key);
    }
    if (messages_done_ == 1) {
        if (!mix_shared(ephemeral_.secret_key, peer_ephemeral_)) return std::nullopt;
        append_encrypted(identity_.public_key, message);
        if (!mix_shared(identity_.secret_key, peer_ephemeral_)) return std::nullopt;
    } else if (messages_done_ == 2) {
        append_encrypted(identity_.public_key, message);
        if (!mix_shared(identity_.secret_key, peer_ephemeral_)) return std::nullopt;
    }
    append_encrypted(payload, message);
    ++messages_done_;
    return message;
}

std::optional<std::vector<std::uint8_t>> NoiseXX::read(Bytes message) {
    if (is_complete() || is_our_turn()) return std::nullopt;
    NoiseXX attempt = *this;
    auto payload = attempt.read_tokens(message);
    if (payload) *this = attempt;
    return payload;
}

std::optional<std::vector<std::uint8_t>> NoiseXX::read_tokens(Bytes message) {
    ByteReader reader(message);
    if (messages_done_ < 2) {
        peer_ephemeral_ = reader.take_array<32>();
        mix_hash(peer_ephemeral_);
    }
    if (messages_done_ == 1 && !mix_shared(ephemeral_.secret_key, peer_ephemeral_)) {
        return std::nullopt;
    }
    if (messages_done_ >= 1) {
        const Bytes sealed_identity = reader.take_bytes(peer_identity_.size() + kTagBytes);
        if (!reader.ok() || !take_decrypted(sealed_identity, peer_identity_) ||
            !mix_shared(ephemeral_.secret_key, peer_identity_)) {
            return std::nullopt;
        }
    }
    const std::size_t overhead = has_key_ ? kTagBytes : 0;
    if (!reader.ok() || reader.rest().size() < overhead) return std::nullopt;
    std::vector<std::uint8_t> payload(reader.rest().size() - overhead);
    if (!take_decrypted(reader.rest(), payload)) return std::nullopt;
    ++messages_done_;
    return payload;
}

SessionKeys NoiseXX::split() const {
    assert(is_complete());
    const HkdfOutput keys = hkdf(chaining_key_, {});
    const SymmetricKey from_initiator(std::span(keys.first).first<32>());
    const SymmetricKey from_responder(std::span(keys.second).first<32>());
    if (role_ == Role::kInitiator) return {from_initiator, from_responder};
    return {from_responder, from_initiator};
}

void NoiseXX::mix_hash(Bytes data) {
    transcript_ = blake2b({transcript_, data});
}

void NoiseXX::mix_key(Bytes input) {
    const HkdfOutput output = hkdf(chaining_key_, input);
    chaining_key_ = output.first;
    key_ = SymmetricKey(std::span(output.second).first<32>());
    has_key_ = true;
    nonce_ = 0;
}

bool NoiseXX::mix_shared(const SecretKey& ours, const PublicKey& theirs) {
    SymmetricKey shared;
    if (!diffie_hellman(ours, theirs, shared)) return false;
    mix_key(shared.bytes);
    return true;
}

void NoiseXX::append_encrypted(Bytes plaintext, std::vector<std::uint8_t>& out) {
    const std::size_t start = out.size();
    if (has_key_) {
        out.resize(start + plaintext.size() + kTagBytes);
        seal(key_, nonce_++, transcript_, plaintext, std::span(out).subspan(start));
    } else {
        out.insert(out.end(), plaintext.begin(), plaintext.end());
    }
    mix_hash(std::span(out).subspan(start));
}

bool NoiseXX::take_decrypted(Bytes ciphertext, std::span<std::uint8_t> out) {
    if (!has_key_) {
        std::copy(ciphertext.begin(), ciphertext.end(), out.begin());
    } else if (!open(key_, nonce_++, transcript_, ciphertext, out)) {
        return false;
    }
    mix_hash(ciphertext);
    return true;
}

}  // namespace fts::net
