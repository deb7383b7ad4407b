// Bytes out and bytes in: the little-endian integers and varints that every payload of this room is
// made of. A varint is LEB128: seven bits a byte, least significant first, the top bit set on all
// but the last byte; at most kMaxVarintBytes, and never longer than the value needs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace fts::replication {

inline constexpr std::size_t kMaxVarintBytes = 5;  // of 32 bits

class ByteWriter {
  public:
    void u8(std::uint8_t value) { bytes_.push_back(value); }
    void little_endian(std::uint64_t value, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) u8(static_cast<std::uint8_t>(value >> (8 * i)));
    }
    void varint(std::uint32_t value) {
        for (; value >= 0x80; value >>= 7) u8(static_cast<std::uint8_t>(value | 0x80));
        u8(static_cast<std::uint8_t>(value));
    }
    void append(std::span<const std::uint8_t> bytes) {
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }

    std::size_t size() const { return bytes_.size(); }
    std::vector<std::uint8_t>& bytes() { return bytes_; }
    std::vector<std::uint8_t> take() { return std::exchange(bytes_, {}); }

  private:
    std::vector<std::uint8_t> bytes_;
};

// Failure sticks: once the bytes have run out or a value was refused, every read gives 0 and
// `failed` stays true. A loop that reads must look at it.
class ByteReader {
  public:
    explicit ByteReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

    std::uint8_t u8() { return static_cast<std::uint8_t>(little_endian(1)); }
    std::uint64_t little_endian(std::size_t size) {
        if (failed_ || rest_.size() < size) return fail();
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{rest_[i]} << (8 * i);
        rest_ = rest_.subspan(size);
        return value;
    }
    std::uint32_t varint() {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < kMaxVarintBytes; ++i) {
            const std::uint8_t byte = u8();
            if (failed_) return fail();
            value |= std::uint64_t{byte & 0x7FU} << (7 * i);
            if (byte >= 0x80) continue;
            const bool longer_than_needed = byte == 0 && i > 0;
            if (longer_than_needed || value > 0xFFFFFFFFU) return fail();
            return static_cast<std::uint32_t>(value);
        }
        return fail();
    }
    // A varint that must not exceed `greatest`.
    std::uint32_t varint_up_to(std::uint32_t greatest) {
        const std::uint32_t value = varint();
        return value <= greatest ? value : fail();
    }

    std::uint32_t fail() {
        failed_ = true;
        rest_ = {};
        return 0;
    }
    bool failed() const { return failed_; }
    // Whether the bytes were read to their end, and all was well.
    bool complete() const { return !failed_ && rest_.empty(); }
    std::span<const std::uint8_t> rest() const { return rest_; }

  private:
    std::span<const std::uint8_t> rest_;
    bool failed_ = false;
};

}  // namespace fts::replication
