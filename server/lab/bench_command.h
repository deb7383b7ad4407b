// fts-lab bench: what solvers cost over the size, density and speed of a scene, beside Box2D and
// Chipmunk where they were there at build time.
#pragma once

namespace CLI {
class App;
}

namespace fts::lab {

// When the subcommand is given, `exit_code` becomes what the program ends with (exit_codes.h).
void add_bench(CLI::App& app, int& exit_code);

}  // namespace fts::lab
