// The one place where end-to-end tests read a clock.
#pragma once

#include <chrono>

namespace fts::harness {

inline double now_s() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace fts::harness
