// fts-lab as a process of its own.
#pragma once

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/harness/process.h"

namespace fts::lab {

struct Ended {
    int code = 0;
    std::string output;
};

inline Ended lab(const std::vector<std::string>& arguments) {
    harness::Process process(FTS_LAB_PROGRAM, arguments);
    const int code = process.wait(120.0);
    return {code, process.output()};
}

inline std::string content_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace fts::lab
