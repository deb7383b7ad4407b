// The handshake against what others computed.

#include "common/net/noise.h"

#include <string_view>

#include <gtest/gtest.h>

namespace fts::net {
namespace {

std::vector<std::uint8_t> from_hex(std::string_view hex) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
        bytes.push_back(
            static_cast<std::uint8_t>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    }
    return bytes;
}

KeyPair keys_from(std::string_view secret_hex) {
    KeyPair keys;
    const auto secret = from_hex(secret_hex);
    std::copy(secret.begin(), secret.end(), keys.secret_key.begin());
    keys.public_key = public_key_of(keys.secret_key);
    return keys;
}

NoiseXX initiator() {
    return {NoiseXX::Role::kInitiator,
            keys_from("e61ef9919cde45dd5f82166404bd08e38bceb5dfdfded0a34c8df7ed542214d1"),
            keys_from("893e28b9dc6ca8d611ab664754b8ceb7bac5117349a4439a6b0569da977c464a"),
            from_hex("4a6f686e2047616c74")};
}

NoiseXX responder() {
    return {NoiseXX::Role::kResponder,
            keys_from("4a3acbfdb163dec651dfa3194dece676d437029c62a408b4c5ea9114246e4893"),
            keys_from("bbdb4cdbd309f1a1f2e1456967fe288cadd6f712d65dc7b7793d5e63da6b375b"),
            from_hex("4a6f686e2047616c74")};
}

struct Step {
    std::string_view payload, ciphertext;
};

// Noise_XX_25519_ChaChaPoly_BLAKE2b of the cacophony test vectors
// (github.com/haskell-cryptography/cacophony, vectors/cacophony.txt).
constexpr std::array<Step, 3> kHandshake{{
    {"4c756477696720766f6e204d69736573",
     "ca35def5ae56cec33dc2036731ab14896bc4c75dbb07a61f879f8e3afa4c79444c756477696720766f6e204d6973"
     "6573"},
    {"4d757272617920526f746862617264",
     "95ebc60d2b1fa672c1f46a8aa265ef51bfe38e7ccb39ec5be34069f1448088430505b6745ce64a5f33f0e8e3b83f"
     "11ce8802bca507f4f2d8b564dbe277e1966116e132faa2dfd70b8b077b9f94b913df5056ae1319469b824a98d54b"
     "baa82c325595587064f978c4b6d104f7596e6f"},
    {"462e20412e20486179656b",
     "99579e1c1ee15e422a57ddd6b16d37087b17558e8369c18991b4b2ca3a824abf904cdcf5458b5431a75af034ca9e"
     "9b982de039eaaf156775e2d580cd4e5ebae89c3f8cb2594b556d8a8169"},
}};
// After it the responder speaks first; nonces count up in each direction.
constexpr std::array<Step, 3> kTransport{{
    {"4361726c204d656e676572", "fc56eea290b3f3a21aac0c70cd5787b5ee99be37d2f4d751329b55"},
    {"4a65616e2d426170746973746520536179",
     "bb31c9da10d5639a4cdb88a12f5c61de41bbc7df09bf75d94f8184fe4157f5c68f"},
    {"457567656e2042f6686d20766f6e2042617765726b",
     "f6199cadb152fb27f82be0a0891ec76a33598ae92a46cab2fb5a8ed5bf48b7f267f8370af7"},
}};

TEST(Noise, agrees_with_the_published_vector_to_the_last_byte) {
    NoiseXX alice = initiator();
    NoiseXX bob = responder();
    for (std::size_t i = 0; i < kHandshake.size(); ++i) {
        NoiseXX& writer = i % 2 == 0 ? alice : bob;
        NoiseXX& reader = i % 2 == 0 ? bob : alice;
        const auto message = writer.write(from_hex(kHandshake[i].payload));
        ASSERT_TRUE(message);
        EXPECT_EQ(*message, from_hex(kHandshake[i].ciphertext)) << "message " << i + 1;
        EXPECT_EQ(reader.read(*message), from_hex(kHandshake[i].payload));
    }
    const SessionKeys alices = alice.split();
    const SessionKeys bobs = bob.split();
    for (std::size_t i = 0; i < kTransport.size(); ++i) {
        const bool from_bob = i % 2 == 0;
        const std::uint64_t nonce = i / 2;
        const auto plaintext = from_hex(kTransport[i].payload);
        std::vector<std::uint8_t> sealed(plaintext.size() + kTagBytes);
        seal(from_bob ? bobs.send : alices.send, nonce, {}, plaintext, sealed);
        EXPECT_EQ(sealed, from_hex(kTransport[i].ciphertext)) << "transport message " << i + 1;
        std::vector<std::uint8_t> opened(plaintext.size());
        EXPECT_TRUE(open(from_bob ? alices.receive : bobs.receive, nonce, {}, sealed, opened));
        EXPECT_EQ(opened, plaintext);
    }
}

TEST(Noise, both_ends_learn_each_others_true_key) {
    NoiseXX alice = initiator();
    NoiseXX bob = responder();
    bob.read(*alice.write({}));
    alice.read(*bob.write({}));
    bob.read(*alice.write({}));
    EXPECT_EQ(
        alice.peer_identity(),
        keys_from("4a3acbfdb163dec651dfa3194dece676d437029c62a408b4c5ea9114246e4893").public_key);
    EXPECT_EQ(
        bob.peer_identity(),
        keys_from("e61ef9919cde45dd5f82166404bd08e38bceb5dfdfded0a34c8df7ed542214d1").public_key);
}

TEST(Noise, a_message_altered_anywhere_is_not_accepted_and_the_true_one_still_is) {
    NoiseXX alice = initiator();
    NoiseXX bob = responder();
    ASSERT_TRUE(bob.read(*alice.write({})));
    const auto message = *bob.write(from_hex("01020304"));
    for (std::size_t i = 0; i < message.size(); ++i) {
        auto altered = message;
        altered[i] ^= 0x40;
        EXPECT_FALSE(alice.read(altered)) << "byte " << i;
    }
    for (std::size_t size = 0; size < message.size(); ++size) {
        EXPECT_FALSE(alice.read(std::span(message).first(size))) << size << " bytes";
    }
    EXPECT_EQ(alice.read(message), from_hex("01020304"));
}

TEST(Noise, a_different_prologue_makes_the_handshake_fail) {
    NoiseXX alice = initiator();
    NoiseXX bob(NoiseXX::Role::kResponder, generate_key_pair(), generate_key_pair(), {});
    ASSERT_TRUE(bob.read(*alice.write({})));
    EXPECT_FALSE(alice.read(*bob.write({})));
}

TEST(Noise, a_worthless_ephemeral_key_is_refused) {
    NoiseXX bob = responder();
    const std::array<std::uint8_t, 32> all_zero{};
    ASSERT_TRUE(bob.read(all_zero));
    EXPECT_FALSE(bob.write({}));
}

}  // namespace
}  // namespace fts::net
