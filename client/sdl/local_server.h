// LocalServer: an fts-server of our own on this machine, as a child process. It is asked to stop
// when this goes out of scope.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace fts::sdl {

struct LocalServerConfig {
    std::filesystem::path program;      // fts-server
    std::filesystem::path data_folder;  // of its key and ledger; empty: where it keeps them itself
    int port = 0;                       // 0: any free one
};

class LocalServer {
  public:
    // Starts it. nullptr with `error` set to a message that names the program and a remedy.
    static std::unique_ptr<LocalServer> start(const LocalServerConfig& config, std::string& error);
    ~LocalServer();
    LocalServer(const LocalServer&) = delete;
    LocalServer& operator=(const LocalServer&) = delete;

    enum class State { kStarting, kListening, kFailed };
    // Reads what the server has said by now; never blocks.
    State poll();
    int port() const { return port_; }                   // once it listens
    const std::string& error() const { return error_; }  // once it failed

  private:
    LocalServer() = default;
    void read_output();
    void fail(const std::string& how);

    std::filesystem::path program_;
    int process_ = -1;  // its process id; -1 when it runs no more
    int output_ = -1;   // read end of the pipe from its standard output and error
    std::string said_;
    State state_ = State::kStarting;
    int port_ = 0;
    std::string error_;
};

// Where fts-server is expected: beside the program that is running.
std::filesystem::path server_program();

}  // namespace fts::sdl
