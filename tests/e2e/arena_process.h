// A real fts-server and real fts-bot processes for end-to-end tests, on loopback UDP.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/harness/process.h"
#include "tests/harness/temp_folder.h"

namespace fts::e2e {

// fts-server on a free port, its data under `data_folder`.
class ServerProcess {
  public:
    explicit ServerProcess(const std::string& data_folder,
                           const std::vector<std::string>& more_arguments = {});

    const std::string& address() const {
        return address_;
    }  // "127.0.0.1:PORT"; empty: did not start
    harness::Process& process() { return *process_; }
    // SIGTERM, wait, and the report it wrote. Fails the test when it does not end cleanly.
    nlohmann::json stop();

  private:
    std::string report_file_;
    std::unique_ptr<harness::Process> process_;
    std::string address_;
};

struct BotRun {
    int exit_code = -1;
    std::string output;
    nlohmann::json report;  // null when none was written
};

// Runs fts-bot to its end. `script` is the text of its script file, empty for none.
BotRun run_bots(const std::string& address, const std::vector<std::string>& arguments,
                const std::string& script, double timeout_s);

// The same, left running.
class BotProcess {
  public:
    BotProcess(const std::string& address, const std::vector<std::string>& arguments,
               const std::string& script = "");
    BotRun finish(double timeout_s);
    harness::Process& process() { return *process_; }

  private:
    harness::TempFolder folder_;
    std::string report_file_;
    std::unique_ptr<harness::Process> process_;
};

}  // namespace fts::e2e
