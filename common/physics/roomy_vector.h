// A vector for what is read here and there and may be large: from some size on its memory is asked
// for in huge pages, where the system has them. With small ones a good part of the time of a crowd
// of 100,000 would go into finding out where they are.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace fts::physics {

// Aligned, and rounded up, to such pages. Throws std::bad_alloc.
void* allocate_huge_pages(std::size_t bytes);
void release_huge_pages(void* memory);

template <typename T>
struct RoomyAllocator {
    using value_type = T;

    RoomyAllocator() = default;
    template <typename Other>
    explicit RoomyAllocator(const RoomyAllocator<Other>&) {}

    T* allocate(std::size_t count) {
        if (!is_large(count)) return std::allocator<T>().allocate(count);
        return static_cast<T*>(allocate_huge_pages(count * sizeof(T)));
    }
    void deallocate(T* memory, std::size_t count) {
        if (!is_large(count)) return std::allocator<T>().deallocate(memory, count);
        release_huge_pages(memory);
    }
    friend bool operator==(const RoomyAllocator&, const RoomyAllocator&) { return true; }

  private:
    static constexpr std::size_t kLargeBytes = std::size_t{1} << 19;
    static bool is_large(std::size_t count) { return count >= kLargeBytes / sizeof(T); }
};

template <typename T>
using RoomyVector = std::vector<T, RoomyAllocator<T>>;

}  // namespace fts::physics
