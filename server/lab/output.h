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

// The files of a study: all figures for programs, and a picture. An empty path: not wanted.
struct StudyFiles {
    // `error` is set when one cannot be written, or both are to go to stdout.
    static StudyFiles open(const std::string& json_path, const std::string& svg_path,
                           std::string& error);

    bool on_stdout() const;
    // False with `error` set when not everything was written.
    bool write(const std::string& json_text, const std::string& svg_text, std::string& error) const;

    std::unique_ptr<Output> json, svg;
};

}  // namespace fts::lab
