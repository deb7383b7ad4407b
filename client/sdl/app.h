// App: the program from the first frame to the last. It holds window, devices, session and, when it
// hosts, the local server; the screens themselves are pure (screens/).
#pragma once

#include <memory>
#include <string>

namespace fts::sdl {

struct AppConfig {
    std::string server;       // fills the address field; empty: the one joined last
    std::string name;         // fills the name field; empty: the one used last
    std::string data_folder;  // empty: the user's
    bool join = false;        // skip the menu
    int width_px = 1280;
    int height_px = 720;
    bool fullscreen = false;
    bool software = false;            // draw without a GPU
    bool predict = true;              // the own ball, ahead of the server
    std::string screenshot_file;      // empty: none
    double screenshot_after_s = 5.0;  // then the program quits
};

class App {
  public:
    // nullptr with `error` set to a message with a remedy.
    static std::unique_ptr<App> create(const AppConfig& config, std::string& error);
    ~App();
    // Until the player quits. The program's exit code.
    int run();

  private:
    struct Impl;
    explicit App(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace fts::sdl
