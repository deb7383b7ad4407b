// How far a long task is, on one line of a terminal that is written over; nothing where stderr is
// no terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace fts::lab {

class ProgressBar {
  public:
    ProgressBar();
    ~ProgressBar();  // leaves the line empty
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(std::size_t done, std::size_t of, const std::string& what);

  private:
    bool on_terminal_;
    std::chrono::steady_clock::time_point start_;
};

// A bar of `width` characters, then "3 of 12, 0:07 left": the text of the line.
std::string progress_line(std::size_t done, std::size_t of, double elapsed_s,
                          const std::string& what);

// Ctrl-C and SIGTERM ask for an end instead of making one, from the first call on; a second Ctrl-C
// ends the program at once. True until then.
void listen_for_interruption();
bool nobody_interrupted();

}  // namespace fts::lab
