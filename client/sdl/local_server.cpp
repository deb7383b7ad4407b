#include "client/sdl/local_server.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <string_view>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <type_traits>
#include <unistd.h>
#include <vector>

namespace fts::sdl {
namespace {

constexpr std::string_view kListening = "fts-server: listening on UDP port ";
constexpr std::size_t kMaxSaid = 8192;  // the newest part of its output that is kept
constexpr auto kPatience = std::chrono::seconds(10);
constexpr int kCannotExecute = 127;  // as a shell says it
static_assert(std::is_same_v<pid_t, int>);
constexpr auto kNap = std::chrono::milliseconds(20);

// The last line with something in it.
std::string last_line(const std::string& text) {
    const std::size_t end = text.find_last_not_of("\r\n ");
    if (end == std::string::npos) return "";
    const std::size_t start = text.rfind('\n', end);
    return text.substr(start == std::string::npos ? 0 : start + 1,
                       end - (start == std::string::npos ? 0 : start + 1) + 1);
}

// In the child: only calls that are safe between fork and exec. The server is told to end when this
// client does, whatever the client dies of.
[[noreturn]] void become_server(pid_t parent, int output, const std::vector<char*>& arguments) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(kCannotExecute);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execv(arguments.front(), arguments.data());
    ::_exit(kCannotExecute);
}

}  // namespace

std::filesystem::path server_program() {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::filesystem::path("fts-server") : self.parent_path() / "fts-server";
}

std::unique_ptr<LocalServer> LocalServer::start(const LocalServerConfig& config,
                                                std::string& error) {
    const std::string program = config.program.string();
    if (::access(program.c_str(), X_OK) != 0) {
        error = "Cannot start " + program + " (" + std::strerror(errno) +
                "). Build fts-server, or join a server by its address.";
        return nullptr;
    }
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
        error = std::string("Cannot make a pipe for the server (") + std::strerror(errno) +
                "). Close some programs and try again.";
        return nullptr;
    }
    std::vector<std::string> words = {program, "--port", std::to_string(config.port)};
    if (!config.data_folder.empty()) {
        words.insert(words.end(), {"--data", config.data_folder.string()});
    }
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    std::unique_ptr<LocalServer> server(new LocalServer);
    server->program_ = config.program;
    const pid_t parent = ::getpid();
    server->process_ = ::fork();
    if (server->process_ == 0) become_server(parent, pipe[1], arguments);
    const int failure = server->process_ < 0 ? errno : 0;
    ::close(pipe[1]);
    server->output_ = pipe[0];
    ::fcntl(server->output_, F_SETFL, O_NONBLOCK);
    if (failure != 0) {
        server->process_ = -1;
        error = "Cannot start " + program + " (" + std::strerror(failure) +
                "). Join a server by its address instead.";
        return nullptr;
    }
    return server;
}

LocalServer::~LocalServer() {
    if (process_ > 0) {
        ::kill(process_, SIGTERM);
        const auto deadline = std::chrono::steady_clock::now() + kPatience;
        while (::waitpid(process_, nullptr, WNOHANG) == 0) {
            // It must not block on a full pipe while it says goodbye.
            read_output();
            if (std::chrono::steady_clock::now() > deadline) {
                ::kill(process_, SIGKILL);
                ::waitpid(process_, nullptr, 0);
                break;
            }
            std::this_thread::sleep_for(kNap);
        }
    }
    if (output_ >= 0) ::close(output_);
}

void LocalServer::read_output() {
    std::array<char, 1024> buffer{};
    while (true) {
        const ssize_t got = ::read(output_, buffer.data(), buffer.size());
        if (got <= 0) break;
        said_.append(buffer.data(), static_cast<std::size_t>(got));
    }
    if (said_.size() > kMaxSaid) said_.erase(0, said_.size() - kMaxSaid);
}

LocalServer::State LocalServer::poll() {
    read_output();
    if (state_ == State::kStarting) {
        const std::size_t at = said_.find(kListening);
        const std::size_t end = at == std::string::npos ? at : said_.find('\n', at);
        if (end != std::string::npos) {
            const char* digits = said_.data() + at + kListening.size();
            std::from_chars(digits, said_.data() + end, port_);
            state_ = State::kListening;
        }
    }
    int status = 0;
    if (process_ > 0 && ::waitpid(process_, &status, WNOHANG) == process_) {
        process_ = -1;
        read_output();
        fail(WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                               : "signal " + std::to_string(WTERMSIG(status)));
    }
    return state_;
}

void LocalServer::fail(const std::string& how) {
    state_ = State::kFailed;
    error_ = "The server on this machine ended (" + how + ").";
    const std::string words = last_line(said_);
    if (!words.empty()) error_ += " It said: " + words;
}

}  // namespace fts::sdl
