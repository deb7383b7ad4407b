#include "server/lab/output.h"

#include <cerrno>
#include <cstring>
#include <iostream>

namespace fts::lab {

std::unique_ptr<Output> Output::open(const std::string& path, const std::string& flag,
                                     std::string& error) {
    auto output = std::make_unique<Output>();
    output->path_ = path;
    output->flag_ = flag;
    if (output->is_stdout()) return output;
    errno = 0;
    output->file_.open(path, std::ios::binary | std::ios::trunc);
    if (output->file_) return output;
    error = "cannot write to '" + path + "' (" + std::strerror(errno) + "); choose another file (" +
            flag + "), or - for the terminal";
    return nullptr;
}

std::ostream& Output::stream() {
    return is_stdout() ? std::cout : file_;
}

bool Output::finish(std::string& error) {
    errno = 0;
    stream().flush();
    if (file_.is_open()) file_.close();
    if (stream()) return true;
    error = "not all of '" + path_ + "' could be written (" + std::strerror(errno) +
            "); see that its disk is not full, or choose another file (" + flag_ + ")";
    return false;
}

StudyFiles StudyFiles::open(const std::string& json_path, const std::string& svg_path,
                            std::string& error) {
    StudyFiles files;
    if (json_path == "-" && svg_path == "-") {
        error = "--json and --svg both go to the terminal; give one of them a file";
        return files;
    }
    if (!json_path.empty()) files.json = Output::open(json_path, "--json", error);
    if (error.empty() && !svg_path.empty()) files.svg = Output::open(svg_path, "--svg", error);
    return files;
}

bool StudyFiles::on_stdout() const {
    return (json && json->is_stdout()) || (svg && svg->is_stdout());
}

bool StudyFiles::write(const std::string& json_text, const std::string& svg_text,
                       std::string& error) const {
    if (json) json->stream() << json_text;
    if (svg) svg->stream() << svg_text;
    return (!json || json->finish(error)) && (!svg || svg->finish(error));
}

}  // namespace fts::lab
