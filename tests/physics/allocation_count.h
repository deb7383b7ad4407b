// Counts every allocation of the test program. In a file of its own, so that the compiler does not
// look through the replaced operators.
#pragma once

#include <cstddef>

namespace fts::physics {

std::size_t allocations();

}  // namespace fts::physics
