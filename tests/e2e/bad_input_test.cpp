// What programs say to bad flags, files, ports and folders: the thing, the remedy, a non-zero exit.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/net/udp_transport.h"
#include "tests/e2e/arena_process.h"

namespace fts::e2e {
namespace {

using ::testing::HasSubstr;

struct Outcome {
    int exit_code = 0;
    std::string output;
};

Outcome run(const std::string& program, const std::vector<std::string>& arguments) {
    harness::Process process(program, arguments);
    const int exit_code = process.wait(120.0);
    return {exit_code, process.output()};
}

TEST(BadInput, AnUnknownFlagOfTheServerIsNamed) {
    const Outcome outcome = run(FTS_SERVER_PROGRAM, {"--gravity", "9.81"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.output, HasSubstr("--gravity"));
}

TEST(BadInput, AnUnknownFlagOfTheBotIsNamed) {
    const Outcome outcome = run(FTS_BOT_PROGRAM, {"--server", "127.0.0.1:1", "--fly"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.output, HasSubstr("--fly"));
}

TEST(BadInput, AnUnknownPilotIsAnsweredWithTheKnownOnes) {
    const Outcome outcome = run(FTS_BOT_PROGRAM, {"--server", "127.0.0.1:1", "--pilot", "ace"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.output, HasSubstr("ace"));
    EXPECT_THAT(outcome.output, HasSubstr("chaser"));
}

TEST(BadInput, AServerThatIsNotThereIsReportedWithARemedy) {
    const Outcome outcome = run(FTS_BOT_PROGRAM, {"--server", "127.0.0.1:9", "--seconds", "20"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr("127.0.0.1:9"));
}

TEST(BadInput, ABusyPortIsNamed) {
    std::string error;
    const auto holder = net::UdpTransport::open("127.0.0.1", 0, error);
    ASSERT_TRUE(holder) << error;
    const std::string port = std::to_string(holder->local_port());
    const harness::TempFolder data;
    const Outcome outcome = run(FTS_SERVER_PROGRAM, {"--bind", "127.0.0.1", "--port", port,
                                                     "--data", data.path().string()});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr(port));
    EXPECT_THAT(outcome.output, HasSubstr("--port"));
}

TEST(BadInput, ADataFolderThatCannotBeWrittenIsNamed) {
    const harness::TempFolder data;
    std::ofstream(data.file("plain")) << "a file, not a folder";
    const std::string below_a_file = data.file("plain") + "/data";
    const Outcome outcome = run(FTS_SERVER_PROGRAM, {"--port", "0", "--data", below_a_file});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr(below_a_file));
    EXPECT_THAT(outcome.output, HasSubstr("--data"));
}

TEST(BadInput, ACorruptLedgerIsNamedAndLeftAsItIs) {
    const harness::TempFolder data;
    const std::string database = data.file("ledger.sqlite3");
    const std::string rubbish(8192, 'x');
    std::ofstream(database) << rubbish;
    const Outcome outcome =
        run(FTS_SERVER_PROGRAM, {"--port", "0", "--data", data.path().string()});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr(database));
    std::ifstream file(database);
    const std::string content((std::istreambuf_iterator<char>(file)), {});
    EXPECT_EQ(content, rubbish);
}

TEST(BadInput, ALevelThatMakesNoSenseIsNamedByFileAndField) {
    const harness::TempFolder levels;
    const harness::TempFolder data;
    std::ofstream(levels.file("01_bad.level"))
        << "number: 1 name: \"Bad\" hint: \"None.\" platform { disc { radius_m: 10 } }\n"
           "ai { behaviour: CHASER difficulty: EASY count: 1 radius_m: 0.5 mass_kg: -2\n"
           "     thrust_n: 5 top_speed_mps: 5 }\n"
           "time_limit_s: 60\n";
    const Outcome outcome = run(FTS_SERVER_PROGRAM, {"--port", "0", "--data", data.path().string(),
                                                     "--levels", levels.path().string()});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr("01_bad.level"));
    EXPECT_THAT(outcome.output, HasSubstr("mass_kg"));
    EXPECT_THAT(outcome.output, HasSubstr("-2"));
}

TEST(BadInput, AFolderWithoutLevelsIsNamed) {
    const harness::TempFolder levels;
    const harness::TempFolder data;
    const Outcome outcome = run(FTS_SERVER_PROGRAM, {"--port", "0", "--data", data.path().string(),
                                                     "--levels", levels.path().string()});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr(levels.path().string()));
}

TEST(BadInput, ASecondServerOnTheSameLedgerIsRefused) {
    const harness::TempFolder data;
    ServerProcess first(data.path());
    const Outcome outcome =
        run(FTS_SERVER_PROGRAM, {"--port", "0", "--data", data.path().string()});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr(data.path().string()));
    first.stop();
}

TEST(BadInput, AScriptThatMakesNoSenseIsNamedByFileAndPlace) {
    const harness::TempFolder folder;
    const std::string script = folder.file("script.json");
    std::ofstream(script) << R"({"steps": [{"at_s": 1, "do": "levitate"}]})";
    const Outcome outcome = run(FTS_BOT_PROGRAM, {"--server", "127.0.0.1:1", "--script", script});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.output, HasSubstr(script));
    EXPECT_THAT(outcome.output, HasSubstr("levitate"));
}

}  // namespace
}  // namespace fts::e2e
