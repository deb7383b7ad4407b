// A server of our own as a child process, played by small shell scripts.
#include "client/sdl/local_server.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

namespace fts::sdl {
namespace {

namespace fs = std::filesystem;

class LocalServerProcess : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "fts-local-server.XXXXXX").string();
        ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path script(const std::string& body) const {
        const fs::path path = folder_ / "fts-server";
        std::ofstream(path) << "#!/bin/sh\n" << body << '\n';
        ::chmod(path.c_str(), 0755);
        return path;
    }
    static LocalServer::State settled(LocalServer& server) {
        LocalServer::State state = server.poll();
        for (int i = 0; i < 1000 && state == LocalServer::State::kStarting; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            state = server.poll();
        }
        return state;
    }
    static bool happens(const std::function<bool()>& condition) {
        for (int i = 0; i < 1000 && !condition(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return condition();
    }

    fs::path folder_;
    std::string error_;
};

TEST_F(LocalServerProcess, tells_the_port_that_it_listens_on) {
    const auto server = LocalServer::start(
        {script("echo starting; echo 'fts-server: listening on UDP port 41234'; sleep 30"), folder_,
         0},
        error_);
    ASSERT_NE(server, nullptr) << error_;
    EXPECT_EQ(settled(*server), LocalServer::State::kListening);
    EXPECT_EQ(server->port(), 41234);
}

TEST_F(LocalServerProcess, is_given_port_and_folder) {
    const auto server = LocalServer::start(
        {script("echo \"$@\" > " + (folder_ / "arguments").string()), folder_ / "coins", 7788},
        error_);
    ASSERT_NE(server, nullptr) << error_;
    EXPECT_EQ(settled(*server), LocalServer::State::kFailed);
    std::string arguments;
    std::getline(std::ifstream(folder_ / "arguments"), arguments);
    EXPECT_EQ(arguments, "--port 7788 --data " + (folder_ / "coins").string());
}

TEST_F(LocalServerProcess, repeats_its_last_words_when_it_ends) {
    const auto server = LocalServer::start(
        {script("echo hello; echo 'UDP port 7777 is in use' >&2; exit 3"), folder_, 0}, error_);
    ASSERT_NE(server, nullptr) << error_;
    EXPECT_EQ(settled(*server), LocalServer::State::kFailed);
    EXPECT_NE(server->error().find("UDP port 7777 is in use"), std::string::npos)
        << server->error();
    EXPECT_NE(server->error().find("exit code 3"), std::string::npos) << server->error();
}

TEST_F(LocalServerProcess, names_the_program_that_is_not_there) {
    const fs::path missing = folder_ / "nothing";
    EXPECT_EQ(LocalServer::start({missing, folder_, 0}, error_), nullptr);
    EXPECT_NE(error_.find(missing.string()), std::string::npos) << error_;
}

TEST_F(LocalServerProcess, is_asked_to_stop_when_it_is_no_longer_wanted) {
    const fs::path ready = folder_ / "ready", stopped = folder_ / "stopped";
    auto server =
        LocalServer::start({script("trap 'touch " + stopped.string() + "; exit 0' TERM; touch " +
                                   ready.string() + "; while :; do sleep 0.05; done"),
                            folder_, 0},
                           error_);
    ASSERT_NE(server, nullptr) << error_;
    ASSERT_TRUE(happens([&] { return fs::exists(ready); }));
    server.reset();
    EXPECT_TRUE(fs::exists(stopped));
}

TEST_F(LocalServerProcess, may_say_more_than_a_pipe_holds) {
    const auto server =
        LocalServer::start({script("yes 'a line of no interest' | head -n 20000; "
                                   "echo 'fts-server: listening on UDP port 5'; sleep 30"),
                            folder_, 0},
                           error_);
    ASSERT_NE(server, nullptr) << error_;
    EXPECT_EQ(settled(*server), LocalServer::State::kListening);
    EXPECT_EQ(server->port(), 5);
}

}  // namespace
}  // namespace fts::sdl
