// fts-lab: scenes without a network, as fast as they go, for whoever wants to know what a solver
// does to them and what it costs.
#include <string>

#include <CLI/CLI.hpp>

#include "server/lab/bench_command.h"
#include "server/lab/compare_command.h"
#include "server/lab/exit_codes.h"
#include "server/lab/interpolation_command.h"
#include "server/lab/plan_command.h"
#include "server/lab/replication_command.h"
#include "server/lab/run_command.h"

int main(int argc, char** argv) {
    CLI::App app("Runs scenes of colliding balls and measures accuracy and speed.", "fts-lab");
    app.require_subcommand(1);
    app.failure_message([](const CLI::App*, const CLI::Error& error) {
        return "fts-lab: " + std::string(error.what()) +
               "\nfts-lab --help, and fts-lab run --help, list what can be asked.\n";
    });
    int exit_code = 0;
    fts::lab::add_run(app, exit_code);
    fts::lab::add_compare(app, exit_code);
    fts::lab::add_plan(app, exit_code);
    fts::lab::add_bench(app, exit_code);
    fts::lab::add_replication(app, exit_code);
    fts::lab::add_interpolation(app, exit_code);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : fts::lab::kExitUsage;
    }
    return exit_code;
}
