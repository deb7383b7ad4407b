// What a server has to show at the end: a scoreboard, proof that energy, momentum and coins were
// conserved, and how fast it was. For people on stdout, for programs as JSON.
#pragma once

#include <string>

#include "common/net/udp_transport.h"
#include "server/duration_histogram.h"
#include "server/server.h"

namespace fts::server {

// What the program knows of its run beside the server's own report.
struct RunFacts {
    DurationHistogram tick_durations;
    double cpu_s = 0.0;  // of all threads
    net::UdpStats traffic;
};

// All arenas taken together: sums, and the worst of the worst.
physics::CollisionAudit combined_audit(const ServerReport& report);

std::string text_of(const ServerReport& report, const RunFacts& run);
std::string json_of(const ServerReport& report, const RunFacts& run);

// False with `error` set to a message that names the file and a remedy.
bool write_report(const std::string& path, const std::string& json, std::string& error);

}  // namespace fts::server
