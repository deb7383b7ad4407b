// Window: one resizable SDL window that ImGui draws into, with whatever can draw: a GPU where SDL
// has one, else our own rasteriser. One at a time: it holds the ImGui context.
#pragma once

#include <memory>
#include <string>

#include <SDL.h>

#include "client/sdl/canvas.h"
#include "client/sdl/im_renderer.h"
#include "client/sdl/rasteriser.h"

namespace fts::sdl {

struct WindowConfig {
    std::string title = "Fear The Sphere";
    int width_px = 1280;
    int height_px = 720;
    bool fullscreen = false;
    bool software = false;  // do not try a GPU
};

class Window {
  public:
    // nullptr with `error` set to a message with a remedy.
    static std::unique_ptr<Window> open(const WindowConfig& config, std::string& error);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Hands an event to ImGui. True when ImGui wants it for itself (a key while text is typed).
    bool handle(const SDL_Event& event);
    // Makes ready to draw a frame at `time_s`.
    Canvas begin_frame(double time_s);
    // Draws what begin_frame's canvas was given and shows it. With `screenshot_path`, also writes
    // it to that file (PNG); false with `error` set when that fails.
    bool end_frame(const std::string& screenshot_path, std::string& error);

    // No frame need be shorter. Where presenting waits for the display this is a little less than
    // its refresh takes, and only catches displays that do not keep their word.
    double shortest_frame_s() const;

  private:
    explicit Window(SDL_Window* window);
    void choose_renderer(bool software);
    void fit_type_scale();
    float pixel_ratio() const;
    bool present_accelerated(const std::string& screenshot_path, std::string& error);
    bool present_software(const std::string& screenshot_path, std::string& error);

    SDL_Window* window_ = nullptr;
    SDL_Renderer* renderer_ = nullptr;
    std::unique_ptr<ImRenderer> im_renderer_;
    Rasteriser rasteriser_;
    TypeScale type_;
    float type_ratio_ = 0.0F;
    bool waits_for_display_ = false;
};

// The style that all controls are drawn in; expects an ImGui context.
void apply_style();

}  // namespace fts::sdl
