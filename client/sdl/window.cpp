#include "client/sdl/window.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <imgui_impl_sdl.h>

#include "client/sdl/screenshot.h"

namespace fts::sdl {
namespace {

// Smaller changes of the window's size than this stretch the fonts a little instead of making them
// anew.
constexpr float kSmallestRescale = 0.02F;
constexpr int kMinWidth = 800, kMinHeight = 450;

bool is_software(SDL_Renderer* renderer) {
    SDL_RendererInfo info{};
    return SDL_GetRendererInfo(renderer, &info) != 0 || (info.flags & SDL_RENDERER_SOFTWARE) != 0;
}

// SDL falls back on drivers that nobody can see, which is of use only to those who ask for it.
bool nobody_can_see() {
    if (SDL_getenv("SDL_VIDEODRIVER") != nullptr) return false;
    const std::string driver = SDL_GetCurrentVideoDriver();
    return driver == "offscreen" || driver == "dummy" || driver == "evdev";
}

std::string no_display_message() {
    const std::string why = SDL_GetError();
    return "There is no display to open a window on" + (why.empty() ? "" : " (" + why + ")") +
           ". Without one, run `./play --headless`.";
}

}  // namespace

void apply_style() {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard | ImGuiConfigFlags_NavEnableGamepad;
    ImGuiStyle& style = ImGui::GetStyle();
    style.AntiAliasedLinesUseTex = false;
    style.CircleTessellationMaxError = 0.15F;
    style.WindowPadding = {0, 0};
    style.WindowBorderSize = 0.0F;
}

std::unique_ptr<Window> Window::open(const WindowConfig& config, std::string& error) {
    SDL_SetHint(SDL_HINT_APP_NAME, config.title.c_str());
    SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    if (SDL_Init(SDL_INIT_VIDEO) != 0) {
        error = no_display_message();
        return nullptr;
    }
    if (nobody_can_see()) {
        SDL_ClearError();
        error = no_display_message();
        SDL_Quit();
        return nullptr;
    }
    // A machine without gamepads, or without the right to see them, can still play.
    SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER);
    Uint32 flags = SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI;
    int width = config.width_px, height = config.height_px;
    SDL_DisplayMode desktop{};
    if (config.fullscreen) {
        flags |= SDL_WINDOW_FULLSCREEN_DESKTOP;
        // Where no window manager makes it as large as the screen, it must start so.
        if (SDL_GetDesktopDisplayMode(0, &desktop) == 0) {
            width = desktop.w;
            height = desktop.h;
        }
    }
    SDL_Window* window = SDL_CreateWindow(config.title.c_str(), SDL_WINDOWPOS_CENTERED,
                                          SDL_WINDOWPOS_CENTERED, width, height, flags);
    if (window == nullptr) {
        error = no_display_message();
        SDL_Quit();
        return nullptr;
    }
    SDL_SetWindowMinimumSize(window, kMinWidth, kMinHeight);
    std::unique_ptr<Window> opened(new Window(window));
    opened->choose_renderer(config.software);
    if (opened->renderer_ == nullptr && SDL_GetWindowSurface(window) == nullptr) {
        error = no_display_message();
        return nullptr;
    }
    // Where no window manager hands out the focus, keys would go nowhere.
    SDL_SetWindowInputFocus(window);
    return opened;
}

Window::Window(SDL_Window* window) : window_(window) {
    ImGui::CreateContext();
    apply_style();
    ImGui_ImplSDL2_InitForSDLRenderer(window_);
}

Window::~Window() {
    im_renderer_.reset();
    ImGui_ImplSDL2_Shutdown();
    ImGui::DestroyContext();
    if (renderer_ != nullptr) SDL_DestroyRenderer(renderer_);
    SDL_DestroyWindow(window_);
    SDL_Quit();
}

void Window::choose_renderer(bool software) {
    if (software) return;
    renderer_ =
        SDL_CreateRenderer(window_, -1, SDL_RENDERER_ACCELERATED | SDL_RENDERER_PRESENTVSYNC);
    if (renderer_ == nullptr) return;
    if (is_software(renderer_)) {
        SDL_DestroyRenderer(renderer_);
        renderer_ = nullptr;
        return;
    }
    SDL_RendererInfo info{};
    SDL_GetRendererInfo(renderer_, &info);
    waits_for_display_ = (info.flags & SDL_RENDERER_PRESENTVSYNC) != 0;
    im_renderer_ = std::make_unique<ImRenderer>(*renderer_);
}

bool Window::handle(const SDL_Event& event) {
    ImGui_ImplSDL2_ProcessEvent(&event);
    const bool key = event.type == SDL_KEYDOWN || event.type == SDL_TEXTINPUT;
    return key && ImGui::GetIO().WantTextInput;
}

float Window::pixel_ratio() const {
    int width = 0, drawn = 0, height = 0;
    SDL_GetWindowSize(window_, &width, &height);
    if (renderer_ != nullptr) {
        SDL_GetRendererOutputSize(renderer_, &drawn, &height);
    } else if (const SDL_Surface* surface = SDL_GetWindowSurface(window_)) {
        drawn = surface->w;
    }
    if (width <= 0 || drawn <= 0) return 1.0F;
    return static_cast<float>(drawn) / static_cast<float>(width);
}

void Window::fit_type_scale() {
    const ImGuiIO& io = ImGui::GetIO();
    const float unit = unit_for(io.DisplaySize), ratio = io.DisplayFramebufferScale.x;
    if (ratio == type_ratio_ && std::abs(unit - type_.unit) < kSmallestRescale * unit) {
        type_.unit = unit;
        return;
    }
    type_ = build_type_scale(unit, ratio);
    type_ratio_ = ratio;
    if (im_renderer_) {
        im_renderer_->upload_fonts();
    } else {
        rasteriser_.upload_fonts();
    }
}

double Window::shortest_frame_s() const {
    constexpr double kUsualHz = 60.0;
    if (!waits_for_display_) return 1.0 / kUsualHz;
    SDL_DisplayMode mode{};
    const bool known = SDL_GetWindowDisplayMode(window_, &mode) == 0 && mode.refresh_rate > 0;
    constexpr double kSlack = 1.1;
    return 1.0 / (kSlack * (known ? mode.refresh_rate : kUsualHz));
}

Canvas Window::begin_frame(double time_s) {
    ImGui_ImplSDL2_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    const float ratio = pixel_ratio();
    io.DisplayFramebufferScale = {ratio, ratio};
    // A minimised window has no size; the screens must still have somewhere to go.
    io.DisplaySize.x = std::max(io.DisplaySize.x, 320.0F);
    io.DisplaySize.y = std::max(io.DisplaySize.y, 180.0F);
    fit_type_scale();
    ImGui::NewFrame();
    return {ImGui::GetBackgroundDrawList(), io.DisplaySize, type_, time_s};
}

bool Window::end_frame(const std::string& screenshot_path, std::string& error) {
    ImGui::Render();
    return renderer_ != nullptr ? present_accelerated(screenshot_path, error)
                                : present_software(screenshot_path, error);
}

bool Window::present_accelerated(const std::string& screenshot_path, std::string& error) {
    SDL_SetRenderDrawColor(renderer_, 0x0a, 0x10, 0x20, 0xff);
    SDL_RenderClear(renderer_);
    im_renderer_->render(*ImGui::GetDrawData());
    bool written = true;
    if (!screenshot_path.empty()) {
        int width = 0, height = 0;
        SDL_GetRendererOutputSize(renderer_, &width, &height);
        std::vector<std::uint32_t> pixels(static_cast<std::size_t>(width) *
                                          static_cast<std::size_t>(height));
        SDL_RenderReadPixels(renderer_, nullptr, SDL_PIXELFORMAT_ARGB8888, pixels.data(),
                             width * 4);
        written = write_png({pixels.data(), width, height, width}, screenshot_path, error);
    }
    SDL_RenderPresent(renderer_);
    return written;
}

bool Window::present_software(const std::string& screenshot_path, std::string& error) {
    SDL_Surface* surface = SDL_GetWindowSurface(window_);
    if (surface == nullptr) return true;  // between two sizes; the next frame has one
    std::vector<std::uint32_t> converted;
    const bool direct = surface->format->format == SDL_PIXELFORMAT_ARGB8888 ||
                        surface->format->format == SDL_PIXELFORMAT_RGB888;
    PixelView target{static_cast<std::uint32_t*>(surface->pixels), surface->w, surface->h,
                     surface->pitch / 4};
    if (!direct) {
        converted.resize(static_cast<std::size_t>(surface->w) *
                         static_cast<std::size_t>(surface->h));
        target = {converted.data(), surface->w, surface->h, surface->w};
    }
    rasteriser_.clear(target, palette::kBackground);
    rasteriser_.render(*ImGui::GetDrawData(), target);
    if (!direct) {
        SDL_ConvertPixels(surface->w, surface->h, SDL_PIXELFORMAT_ARGB8888, converted.data(),
                          surface->w * 4, surface->format->format, surface->pixels, surface->pitch);
    }
    const bool written = screenshot_path.empty() || write_png(target, screenshot_path, error);
    SDL_UpdateWindowSurface(window_);
    return written;
}

}  // namespace fts::sdl
