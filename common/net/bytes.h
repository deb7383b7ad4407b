// Little-endian fields in and out of a span. The writer asserts that its caller left room; the
// reader believes nothing: past the end it yields zeros and `ok()` turns false for good.
#pragma once

#include <array>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

namespace fts::net {

using Bytes = std::span<const std::uint8_t>;

class ByteWriter {
  public:
    explicit ByteWriter(std::span<std::uint8_t> out) : out_(out) {}

    template <std::unsigned_integral T>
    void put(T value) {
        assert(room() >= sizeof(T));
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            out_[size_++] = static_cast<std::uint8_t>(std::uint64_t{value} >> (8 * i));
        }
    }
    void put_bytes(Bytes bytes) {
        assert(room() >= bytes.size());
        for (const std::uint8_t byte : bytes) out_[size_++] = byte;
    }
    std::size_t size() const { return size_; }
    std::size_t room() const { return out_.size() - size_; }

  private:
    std::span<std::uint8_t> out_;
    std::size_t size_ = 0;
};

class ByteReader {
  public:
    explicit ByteReader(Bytes bytes) : rest_(bytes) {}

    template <std::unsigned_integral T>
    T take() {
        std::uint64_t value = 0;
        const Bytes field = take_bytes(sizeof(T));
        for (std::size_t i = 0; i < field.size(); ++i) value |= std::uint64_t{field[i]} << (8 * i);
        return static_cast<T>(value);
    }
    // Empty, and no longer ok, when fewer than `count` are left.
    Bytes take_bytes(std::size_t count) {
        if (rest_.size() < count) {
            ok_ = false;
            rest_ = {};
            return {};
        }
        const Bytes taken = rest_.first(count);
        rest_ = rest_.subspan(count);
        return taken;
    }
    template <std::size_t kSize>
    std::array<std::uint8_t, kSize> take_array() {
        std::array<std::uint8_t, kSize> array{};
        const Bytes taken = take_bytes(kSize);
        for (std::size_t i = 0; i < taken.size(); ++i) array[i] = taken[i];
        return array;
    }
    Bytes rest() const { return rest_; }
    bool ok() const { return ok_; }

  private:
    Bytes rest_;
    bool ok_ = true;
};

}  // namespace fts::net
