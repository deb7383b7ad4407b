// Feeds every decoder what its fuzzer has kept: seeds, and the inputs that once broke it.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#define FUZZ_TARGET(name) \
    extern "C" int name##_one_input(const std::uint8_t* data, std::size_t size);
#include "tests/fuzz/target_list.h"
#undef FUZZ_TARGET

namespace {

namespace fs = std::filesystem;

struct Target {
    std::string name;
    int (*one_input)(const std::uint8_t*, std::size_t);
};
std::ostream& operator<<(std::ostream& out, const Target& target) {
    return out << target.name;
}

std::vector<Target> all_targets() {
    std::vector<Target> targets;
#define FUZZ_TARGET(name) targets.push_back({#name, name##_one_input});
#include "tests/fuzz/target_list.h"
#undef FUZZ_TARGET
    return targets;
}

std::vector<fs::path> kept_inputs(const std::string& target) {
    std::vector<fs::path> files;
    for (const char* kind : {"corpus", "regressions"}) {
        const fs::path folder = fs::path(FTS_FUZZ_FOLDER) / kind / target;
        if (!fs::exists(folder)) continue;
        for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

std::vector<std::uint8_t> bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class FuzzReplay : public testing::TestWithParam<Target> {};

TEST_P(FuzzReplay, withstands_everything_that_was_kept) {
    const std::vector<fs::path> files = kept_inputs(GetParam().name);
    EXPECT_FALSE(files.empty()) << "tests/fuzz/corpus/" << GetParam().name << " has no seed";
    for (const fs::path& file : files) {
        SCOPED_TRACE(file.string());
        const std::vector<std::uint8_t> bytes = bytes_of(file);
        EXPECT_EQ(GetParam().one_input(bytes.data(), bytes.size()), 0);
    }
}

// Cut anywhere, a message is as foreign as any other: what was kept is replayed shortened, too.
TEST_P(FuzzReplay, withstands_everything_that_was_kept_cut_short) {
    for (const fs::path& file : kept_inputs(GetParam().name)) {
        SCOPED_TRACE(file.string());
        const std::vector<std::uint8_t> bytes = bytes_of(file);
        const std::size_t step = std::max<std::size_t>(1, bytes.size() / 64);
        for (std::size_t size = 0; size < bytes.size(); size += step) {
            SCOPED_TRACE(size);
            EXPECT_EQ(GetParam().one_input(bytes.data(), size), 0);
        }
    }
}

std::string name_of(const testing::TestParamInfo<Target>& target) {
    return target.param.name;
}

INSTANTIATE_TEST_SUITE_P(Decoders, FuzzReplay, testing::ValuesIn(all_targets()), name_of);

}  // namespace
