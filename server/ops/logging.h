// The log on stderr: one calm line per event, with the time of day and a level.
#pragma once

#include <string>

#include "server/log.h"

namespace fts::server {

// `level` is one that Options::log_level may hold.
Log open_log(const std::string& level);

}  // namespace fts::server
