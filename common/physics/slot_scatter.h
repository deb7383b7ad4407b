// Writes what a solver keeps in an order of its own to where the bodies' slots are. The two orders
// have nothing to do with each other, so that of a large crowd every value goes to another line of
// memory, and none of these is at hand. Then it is done in two passes by way of sections of slots:
// each is written from its begin to its end, and is small enough to be read here and there once it
// was read as a whole.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/physics/body.h"
#include "common/physics/roomy_vector.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace fts::physics {

// Writes past the caches what would not be there any more when it is read. To be followed by
// `end_of_stream` before another thread is told.
template <typename Scalar>
void stream(const Vec2<Scalar>& from, Vec2<Scalar>& to) {
#if defined(__SSE2__)
    if constexpr (sizeof(from) == sizeof(__m128i)) {
        _mm_stream_si128(reinterpret_cast<__m128i*>(to.data()),
                         _mm_loadu_si128(reinterpret_cast<const __m128i*>(from.data())));
    } else {
        static_assert(sizeof(from) == sizeof(long long));
        long long bits = 0;
        std::memcpy(&bits, from.data(), sizeof(bits));
        _mm_stream_si64(reinterpret_cast<long long*>(to.data()), bits);
    }
#else
    to = from;
#endif
}

inline void end_of_stream() {
#if defined(__SSE2__)
    _mm_sfence();
#endif
}

template <typename Scalar>
class SlotScatter {
  public:
    using Vec = Vec2<Scalar>;

    // From now on places have other slots.
    void forget() { holds_ = false; }

    // to[id[i].index] = (x[i], y[i]) for all places i. Slots are all different.
    void write(const RoomyVector<BodyId>& id, const RoomyVector<Scalar>& x,
               const RoomyVector<Scalar>& y, RoomyVector<Vec>& to);

  private:
    static constexpr std::size_t kManyBytes = std::size_t{12} << 20;
    static constexpr unsigned kSectionBits = 8;
    static constexpr std::uint32_t kSections = 1U << kSectionBits;
    // Sections that begin at like addresses would drive each other out of the cache.
    static constexpr std::uint32_t kApart = 5;
    // How far ahead lines are asked for.
    static constexpr std::uint32_t kAhead = 128;
    static constexpr std::uint32_t kInALine = 64 / sizeof(Vec);

    void fit(const RoomyVector<BodyId>& id);
    void read_section(std::uint32_t section) const;

    bool holds_ = false;
    unsigned shift_ = 0;  // of a slot, to the number of its section
    std::array<std::uint32_t, kSections + 1> first_ = {};  // of a section, in values_
    RoomyVector<std::uint32_t> by_place_, by_slot_;        // where in values_
    RoomyVector<Vec> values_;
};

template <typename Scalar>
void SlotScatter<Scalar>::write(const RoomyVector<BodyId>& id, const RoomyVector<Scalar>& x,
                                const RoomyVector<Scalar>& y, RoomyVector<Vec>& to) {
    const auto count = static_cast<std::uint32_t>(id.size());
    if (count < to.size() || count * sizeof(Vec) < kManyBytes) {
        for (std::uint32_t i = 0; i < count; ++i) to[id[i].index] = {x[i], y[i]};
        return;
    }
    if (!holds_) fit(id);
    for (std::uint32_t i = 0; i < count; ++i) {
        __builtin_prefetch(&values_[by_place_[std::min(i + kAhead, count - 1)]], 1);
        values_[by_place_[i]] = {x[i], y[i]};
    }
    for (std::uint32_t section = 0; section < kSections; ++section) {
        read_section(section);
        const std::uint32_t end = std::min(count, (section + 1) << shift_);
        for (std::uint32_t s = section << shift_; s < end; ++s) stream(values_[by_slot_[s]], to[s]);
    }
    end_of_stream();
}

// One after the other, which is faster than to prefetch so many.
template <typename Scalar>
void SlotScatter<Scalar>::read_section(std::uint32_t section) const {
    const volatile Scalar* const values = values_.front().data();
    for (std::uint32_t i = first_[section]; i < first_[section + 1]; i += kInALine) {
        static_cast<void>(values[std::size_t{2} * i]);
    }
}

template <typename Scalar>
void SlotScatter<Scalar>::fit(const RoomyVector<BodyId>& id) {
    const auto count = static_cast<std::uint32_t>(id.size());
    shift_ = static_cast<unsigned>(std::bit_width(count - 1)) - kSectionBits;
    for (std::uint32_t section = 0; section < kSections; ++section) {
        const std::uint32_t begin = std::min(count, section << shift_);
        const std::uint32_t end = std::min(count, (section + 1) << shift_);
        first_[section + 1] = first_[section] + (end - begin) + kApart;
    }
    values_.resize(first_[kSections]);
    by_place_.resize(count);
    by_slot_.resize(count);
    std::array<std::uint32_t, kSections + 1> next = first_;
    for (std::uint32_t i = 0; i < count; ++i) {
        by_place_[i] = by_slot_[id[i].index] = next[id[i].index >> shift_]++;
    }
    holds_ = true;
}

}  // namespace fts::physics
