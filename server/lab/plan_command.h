// fts-lab plan: the cheapest way to advance a scene that meets a tolerance, and why.
#pragma once

namespace CLI {
class App;
}

namespace fts::lab {

// Adds the subcommand. When it was given, `exit_code` is what the program should end with.
void add_plan(CLI::App& app, int& exit_code);

}  // namespace fts::lab
