// What fts-bench left in files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "server/lab/bench/bench.h"

namespace fts::bench {

struct KeptSet {
    std::vector<lab::BenchResult> results;  // the medians, and what was not run
    std::string machine;                    // what it was measured on
};

// By name, of those sets that have a file in the folder. `error` says which file cannot be read, or
// holds an engine that this build does not have.
std::map<std::string, KeptSet> read_sets(const std::filesystem::path& folder, std::string& error);

}  // namespace fts::bench
