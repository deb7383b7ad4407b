// What a fuzz target defines. libFuzzer feeds it whatever it makes up (presets asan and fuzz); the
// replay test feeds it everything that is kept in tests/fuzz/corpus and tests/fuzz/regressions
// (every preset).
//
// It returns 0; whatever is wrong ends the process (assert, abort, a sanitizer's report).
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
