// A level file is whatever a host wrote: parse_level answers with a level or with words, never
// both, and a level it accepts can be played.
#include <cstdlib>
#include <string>

#include "server/match/level_file.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const fts::server::LoadedLevels loaded = fts::server::parse_level(text, "fuzzed.level");
    if (loaded.error.empty() == loaded.levels.empty()) std::abort();
    return 0;
}
