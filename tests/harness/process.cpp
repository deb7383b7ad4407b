#include "tests/harness/process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/harness/clock.h"

extern char** environ;

namespace fts::harness {

namespace {

int exit_code_of(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

Process::Process(const std::string& program, const std::vector<std::string>& arguments) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
        ADD_FAILURE() << "pipe: " << std::strerror(errno);
        return;
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);

    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);

    const int error =
        posix_spawn(&pid_, program.c_str(), &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    output_fd_ = ends[0];
    if (error != 0) {
        pid_ = -1;
        ADD_FAILURE() << "cannot start " << program << ": " << std::strerror(error);
    }
}

Process::~Process() {
    if (pid_ > 0 && !exit_code_) {
        kill(pid_, SIGKILL);
        int status = 0;
        waitpid(pid_, &status, 0);
    }
    if (output_fd_ >= 0) close(output_fd_);
}

bool Process::read_some(double timeout_s) {
    pollfd waiting{.fd = output_fd_, .events = POLLIN, .revents = 0};
    const int ready = poll(&waiting, 1, static_cast<int>(timeout_s * 1000.0) + 1);
    if (ready <= 0) return ready == 0 || errno == EINTR;
    std::array<char, 4096> buffer{};
    const ssize_t count = read(output_fd_, buffer.data(), buffer.size());
    if (count <= 0) return false;
    output_.append(buffer.data(), static_cast<std::size_t>(count));
    return true;
}

std::optional<std::string> Process::wait_for_line(std::string_view text, double timeout_s) {
    const double deadline_s = now_s() + timeout_s;
    bool open = true;
    while (true) {
        const std::size_t found = output_.find(text);
        const std::size_t end = found == std::string::npos ? found : output_.find('\n', found);
        if (end != std::string::npos) {
            const std::size_t before = output_.rfind('\n', found);
            const std::size_t begin = before == std::string::npos ? 0 : before + 1;
            return output_.substr(begin, end - begin);
        }
        const double left_s = deadline_s - now_s();
        if (!open || left_s <= 0.0) return std::nullopt;
        open = read_some(left_s);
    }
}

int Process::wait(double timeout_s) {
    if (exit_code_) return *exit_code_;
    if (pid_ <= 0) return -1;
    const double deadline_s = now_s() + timeout_s;
    while (now_s() < deadline_s && read_some(deadline_s - now_s())) {
    }
    int status = 0;
    while (waitpid(pid_, &status, WNOHANG) == 0) {
        if (now_s() > deadline_s) {
            ADD_FAILURE() << "process " << pid_ << " did not end within " << timeout_s
                          << " s; its output was:\n"
                          << output_;
            kill(pid_, SIGKILL);
            waitpid(pid_, &status, 0);
            break;
        }
        usleep(5'000);
    }
    exit_code_ = exit_code_of(status);
    return *exit_code_;
}

void Process::signal(int number) {
    if (pid_ > 0 && !exit_code_) kill(pid_, number);
}

}  // namespace fts::harness
