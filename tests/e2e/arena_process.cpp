#include "tests/e2e/arena_process.h"

#include <csignal>
#include <fstream>

#include <gtest/gtest.h>

namespace fts::e2e {

namespace {

constexpr double kStartTimeoutS = 120.0;
constexpr double kStopTimeoutS = 120.0;

nlohmann::json read_json(const std::string& path) {
    std::ifstream file(path);
    if (!file) return nullptr;
    return nlohmann::json::parse(file, nullptr, false);
}

std::string port_in(const std::string& line) {
    const std::size_t begin = line.find_last_not_of("0123456789") + 1;
    return line.substr(begin);
}

}  // namespace

ServerProcess::ServerProcess(const std::string& data_folder,
                             const std::vector<std::string>& more_arguments)
    : report_file_(data_folder + "/report.json") {
    std::vector<std::string> arguments = {"--port", "0",         "--bind",   "127.0.0.1",
                                          "--data", data_folder, "--report", report_file_,
                                          "--seed", "1"};
    arguments.insert(arguments.end(), more_arguments.begin(), more_arguments.end());
    process_ = std::make_unique<harness::Process>(FTS_SERVER_PROGRAM, arguments);
    const auto line = process_->wait_for_line("listening on UDP port", kStartTimeoutS);
    if (!line) {
        ADD_FAILURE() << "fts-server did not start; it printed:\n" << process_->output();
        return;
    }
    address_ = "127.0.0.1:" + port_in(*line);
}

nlohmann::json ServerProcess::stop() {
    process_->signal(SIGTERM);
    EXPECT_EQ(process_->wait(kStopTimeoutS), 0) << process_->output();
    const nlohmann::json report = read_json(report_file_);
    EXPECT_TRUE(report.is_object()) << "no report in " << report_file_;
    return report;
}

BotProcess::BotProcess(const std::string& address, const std::vector<std::string>& arguments,
                       const std::string& script)
    : report_file_(folder_.file("report.json")) {
    std::vector<std::string> all = {"--server", address, "--json", report_file_};
    all.insert(all.end(), arguments.begin(), arguments.end());
    if (!script.empty()) {
        const std::string script_file = folder_.file("script.json");
        std::ofstream(script_file) << script;
        all.insert(all.end(), {"--script", script_file});
    }
    process_ = std::make_unique<harness::Process>(FTS_BOT_PROGRAM, all);
}

BotRun BotProcess::finish(double timeout_s) {
    BotRun run;
    run.exit_code = process_->wait(timeout_s);
    run.output = process_->output();
    run.report = read_json(report_file_);
    return run;
}

BotRun run_bots(const std::string& address, const std::vector<std::string>& arguments,
                const std::string& script, double timeout_s) {
    return BotProcess(address, arguments, script).finish(timeout_s);
}

}  // namespace fts::e2e
