// What came of a run: for people, aligned and calm, and for programs as JSON.
#pragma once

#include <string>

#include "server/lab/run.h"

namespace fts::lab {

struct RunReport {
    std::string scene;
    RunSettings settings;
    std::string plan;  // the sentence that says why, when the setting was chosen for the user
    RunResult result;
};

std::string text_of(const RunReport& report);
std::string json_of(const RunReport& report);

}  // namespace fts::lab
