// What a server has to show at the end: a scoreboard, proof that energy, momentum and coins were
// conserved, and how fast it was. For people on stdout, for programs as JSON.
#pragma once

#include <string>

#include "server/duration_histogram.h"
#include "server/server.h"

namespace fts::server {

// All arenas taken together: sums, and the worst of the worst.
physics::CollisionAudit combined_audit(const ServerReport& report);

std::string text_of(const ServerReport& report, const DurationHistogram& tick_durations);
std::string json_of(const ServerReport& report, const DurationHistogram& tick_durations);

// False with `error` set to a message that names the file and a remedy.
bool write_report(const std::string& path, const std::string& json, std::string& error);

}  // namespace fts::server
