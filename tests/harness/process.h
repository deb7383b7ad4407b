// A child process of a test: started with arguments, its output read line by line, ended for sure
// when the value goes out of scope.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <vector>

namespace fts::harness {

class Process {
  public:
    // Starts `program` with `arguments`; stdout and stderr go to one pipe. Fails the test when it
    // cannot be started.
    Process(const std::string& program, const std::vector<std::string>& arguments);
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    // Waits until a line of the output holds `text` and returns that line; nothing when the output
    // ends or `timeout_s` passes first.
    std::optional<std::string> wait_for_line(std::string_view text, double timeout_s);
    // Reads on until the process has ended, and returns its exit code (128 + signal when killed).
    // Kills it and fails the test after `timeout_s`.
    int wait(double timeout_s);

    void signal(int number);
    // Everything printed so far.
    const std::string& output() const { return output_; }
    pid_t pid() const { return pid_; }

  private:
    bool read_some(double timeout_s);

    pid_t pid_ = -1;
    int output_fd_ = -1;
    std::string output_;
    std::optional<int> exit_code_;
};

}  // namespace fts::harness
