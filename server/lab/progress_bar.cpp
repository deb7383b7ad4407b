#include "server/lab/progress_bar.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <unistd.h>

namespace fts::lab {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void note_interruption(int signal) {
    interrupted = 1;
    std::signal(signal, SIG_DFL);
}

}  // namespace

ProgressBar::ProgressBar()
    : on_terminal_(isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
    if (on_terminal_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::show(std::size_t done, std::size_t of, const std::string& what) {
    if (!on_terminal_) return;
    const double elapsed_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    std::fprintf(stderr, "\r\033[K%s", progress_line(done, of, elapsed_s, what).c_str());
    std::fflush(stderr);
}

std::string progress_line(std::size_t done, std::size_t of, double elapsed_s,
                          const std::string& what) {
    constexpr std::size_t kWidth = 24;
    const std::size_t full = of == 0 ? 0 : kWidth * std::min(done, of) / of;
    std::string line = "[" + std::string(full, '#') + std::string(kWidth - full, '.') + "] " +
                       std::to_string(done) + " of " + std::to_string(of);
    if (done > 0 && done < of) {
        const auto left_s = static_cast<long>(elapsed_s * static_cast<double>(of - done) /
                                              static_cast<double>(done));
        char text[64];
        std::snprintf(text, sizeof text, ", about %ld:%02ld left", left_s / 60, left_s % 60);
        line += text;
    }
    return line + "  " + what;
}

void listen_for_interruption() {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, note_interruption);
}

bool nobody_interrupted() {
    return interrupted == 0;
}

}  // namespace fts::lab
