#include "server/ops/logging.h"

#include <memory>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace fts::server {

namespace {

spdlog::level::level_enum spdlog_level(LogLevel level) {
    switch (level) {
        case LogLevel::kDebug:
            return spdlog::level::debug;
        case LogLevel::kInfo:
            return spdlog::level::info;
        case LogLevel::kWarning:
            return spdlog::level::warn;
        case LogLevel::kError:
            return spdlog::level::err;
    }
    return spdlog::level::err;
}

}  // namespace

Log open_log(const std::string& level) {
    const auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_st>();
    const auto logger = std::make_shared<spdlog::logger>("fts-server", sink);
    logger->set_level(spdlog::level::from_str(level));
    logger->set_pattern("%H:%M:%S %^%-7l%$ %v");
    return [logger](LogLevel line_level, const std::string& line) {
        logger->log(spdlog_level(line_level), "{}", line);
    };
}

}  // namespace fts::server
