// fts-lab interpolation: how far what is drawn between snapshots is from what happened.
#pragma once

namespace CLI {
class App;
}

namespace fts::lab {

// When the subcommand is given, `exit_code` becomes what the program ends with (exit_codes.h).
void add_interpolation(CLI::App& app, int& exit_code);

}  // namespace fts::lab
