// fts-lab run: one scene, one solver.
#pragma once

namespace CLI {
class App;
}

namespace fts::lab {

// Adds the subcommand. When it was given, `exit_code` is what the program should end with.
void add_run(CLI::App& app, int& exit_code);

}  // namespace fts::lab
