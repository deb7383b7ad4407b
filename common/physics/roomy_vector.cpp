#include "common/physics/roomy_vector.h"

#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace fts::physics {
namespace {

constexpr std::align_val_t kHugePage{std::size_t{2} << 20};

}  // namespace

void* allocate_huge_pages(std::size_t bytes) {
    constexpr auto kPageBytes = static_cast<std::size_t>(kHugePage);
    const std::size_t rounded = (bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
    void* const memory = ::operator new(rounded, kHugePage);
#if defined(__linux__)
    // A wish; where it is not granted, pages are small.
    static_cast<void>(::madvise(memory, rounded, MADV_HUGEPAGE));
#endif
    return memory;
}

void release_huge_pages(void* memory) {
    ::operator delete(memory, kHugePage);
}

}  // namespace fts::physics
