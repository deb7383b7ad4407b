// fts-client: the game's window.
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "client/sdl/app.h"

namespace {

constexpr int kExitFailure = 1;
constexpr int kExitUsage = 2;

void declare(CLI::App& app, fts::sdl::AppConfig& config) {
    app.add_option("--server", config.server, "Server to join, HOST or HOST:PORT")
        ->envname("FTS_SERVER");
    app.add_flag("--join", config.join, "Join at once, without the menu")->envname("FTS_JOIN");
    app.add_option("--name", config.name, "Your name in the arena")->envname("FTS_NAME");
    app.add_option("--data", config.data_folder, "Folder of your key, settings and known servers")
        ->envname("FTS_DATA");
    app.add_option("--width", config.width_px, "Width of the window, pixels")
        ->envname("FTS_WIDTH")
        ->check(CLI::Range(800, 16384))
        ->capture_default_str();
    app.add_option("--height", config.height_px, "Height of the window, pixels")
        ->envname("FTS_HEIGHT")
        ->check(CLI::Range(450, 16384))
        ->capture_default_str();
    app.add_flag("--fullscreen", config.fullscreen, "Fill the screen")->envname("FTS_FULLSCREEN");
    app.add_flag("--software", config.software, "Draw without a GPU")->envname("FTS_SOFTWARE");
    app.add_flag("!--no-prediction", config.predict,
                 "Draw your ball where the server has it, not where it will be by now")
        ->envname("FTS_PREDICTION");
    CLI::Option* screenshot =
        app.add_option("--screenshot", config.screenshot_file,
                       "Write the window to this PNG file after --after seconds, then quit")
            ->envname("FTS_SCREENSHOT");
    app.add_option("--after", config.screenshot_after_s, "Seconds until --screenshot")
        ->envname("FTS_AFTER")
        ->check(CLI::Range(0.0, 86400.0))
        ->needs(screenshot)
        ->capture_default_str();
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Fear The Sphere: knock every ball off the platform, lose no momentum.",
                 "fts-client");
    fts::sdl::AppConfig config;
    declare(app, config);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kExitUsage;
    }
    std::string error;
    const auto client = fts::sdl::App::create(config, error);
    if (client == nullptr) {
        std::fprintf(stderr, "fts-client: %s\n", error.c_str());
        return kExitFailure;
    }
    return client->run();
}
