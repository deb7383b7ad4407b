// A file that results go to, or stdout for "-". It is opened before anything is computed, so that a
// long run does not end with nowhere to go.
#pragma once

#include <fstream>
#include <memory>
#include <ostream>
#include <string>

namespace fts::lab {

class Output {
  public:
    // `flag` is how messages call it: "--json". Empty with `error` set when it cannot be written.
    static std::unique_ptr<Output> open(const std::string& path, const std::string& flag,
                                        std::string& error);

    std::ostream& stream();
    bool is_stdout() const { return path_ == "-"; }
    // Empties all buffers; false with `error` set when not everything was written.
    bool finish(std::string& error);

  private:
    std::string path_, flag_;
    std::ofstream file_;
};

}  // namespace fts::lab
