// fts-lab replication: what a snapshot costs on the wire.
#pragma once

namespace CLI {
class App;
}

namespace fts::lab {

// When the subcommand is given, `exit_code` becomes what the program ends with (exit_codes.h).
void add_replication(CLI::App& app, int& exit_code);

}  // namespace fts::lab
