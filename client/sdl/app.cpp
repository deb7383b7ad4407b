#include "client/sdl/app.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "client/core/data_folder.h"
#include "client/core/endpoint.h"
#include "client/core/known_servers.h"
#include "client/core/session.h"
#include "client/core/settings.h"
#include "client/sdl/input_devices.h"
#include "client/sdl/local_server.h"
#include "client/sdl/lookup.h"
#include "client/sdl/screens/match.h"
#include "client/sdl/screens/menu.h"
#include "client/sdl/screens/notice.h"
#include "client/sdl/window.h"
#include "common/game/rules.h"

namespace fts::sdl {
namespace {

constexpr const char* kDefaultServer = "localhost";
constexpr int kExitFailure = 1;

double monotonic_s() {
    using Clock = std::chrono::steady_clock;
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

const char* title_for(net::DisconnectReason reason) {
    switch (reason) {
        case net::DisconnectReason::kClosed:
            return "The server ended the session";
        case net::DisconnectReason::kTimeout:
            return "The connection is lost";
        case net::DisconnectReason::kUnreachable:
            return "The server does not answer";
        case net::DisconnectReason::kServerFull:
            return "The server is full";
        case net::DisconnectReason::kWrongVersion:
            return "The server speaks another version";
        case net::DisconnectReason::kRefused:
            return "The server did not let you in";
        case net::DisconnectReason::kKeyChanged:
            return "The server's key has changed";
        case net::DisconnectReason::kProtocolError:
            return "The server made no sense";
        case net::DisconnectReason::kKicked:
            return "The host removed you";
    }
    return "The session has ended";
}

}  // namespace

struct App::Impl {
    enum class Stage { kMenu, kLookingUp, kHosting, kSession, kEnded };
    struct Ending {
        std::string title, words;
    };

    Impl(const AppConfig& app_config, client::DataFolder data_folder, const net::KeyPair& pair)
        : config(app_config),
          folder(std::move(data_folder)),
          key(pair),
          settings(client::load_settings(folder.settings_path()).settings),
          known_servers(client::KnownServers::load(folder.known_servers_path())) {
        menu.name = config.name.empty() ? settings.player_name : config.name;
        menu.address = config.server.empty() ? settings.last_server : config.server;
    }

    int run();
    void poll_events();
    void update(double now_s);
    void update_lookup();
    void update_hosting();
    void update_session(double now_s);
    void draw(Canvas& canvas);
    void draw_session(Canvas& canvas);

    void join();
    void host();
    void start_server(int port);
    void connect(const std::string& name, const std::optional<net::PublicKey>& pin);
    void pin_server();
    void leave(double now_s);
    void remember();
    void end(const std::string& title, const std::string& words) {
        ending = {title, words};
        if (!words.empty()) {
            ending.words[0] =
                static_cast<char>(std::toupper(static_cast<unsigned char>(ending.words[0])));
        }
        stage = Stage::kEnded;
    }

    AppConfig config;
    client::DataFolder folder;
    net::KeyPair key;
    client::Settings settings;
    client::KnownServers known_servers;
    std::unique_ptr<Window> window;
    std::unique_ptr<InputDevices> devices = std::make_unique<InputDevices>();

    Stage stage = Stage::kMenu;
    bool quit = false;
    MenuState menu;
    MatchState match;
    Ending ending;
    client::View view;
    std::optional<int> slot;  // picked in this frame

    std::string server;  // as shown
    std::optional<Lookup> lookup;
    std::optional<net::Address> address;
    bool hosted = false;  // the session plays on the local server
    bool pinned = false;
    int host_port = 0;
    std::unique_ptr<net::Transport> transport;
    std::unique_ptr<client::Session> session;
    std::unique_ptr<LocalServer> local_server;
    double updated_s = 0.0;
};

void App::Impl::remember() {
    settings.player_name = menu.name;
    settings.last_server = menu.address;
    menu.problem.clear();
    std::string error;
    if (!client::save_settings(settings, folder.settings_path(), error)) menu.problem = error;
}

void App::Impl::join() {
    remember();
    hosted = false;
    server = menu.address.empty() ? kDefaultServer : menu.address;
    lookup.emplace(server);
    stage = Stage::kLookingUp;
}

void App::Impl::update_lookup() {
    const std::optional<net::Resolved> resolved = lookup->poll();
    if (!resolved) return;
    lookup.reset();
    if (!resolved->address) {
        end("That address leads nowhere", resolved->error);
        return;
    }
    address = resolved->address;
    connect(server, known_servers.find(*address));
}

void App::Impl::connect(const std::string& name, const std::optional<net::PublicKey>& pin) {
    server = name;
    pinned = pin.has_value();
    match = {};
    view = {};
    session.reset();
    std::string error;
    transport = client::open_endpoint(std::nullopt, error);
    if (transport == nullptr) {
        end("The network cannot be used", error);
        return;
    }
    client::SessionConfig session_config;
    session_config.name = menu.name.empty() ? "player" : menu.name;
    session_config.key = key;
    session_config.server = *address;
    session_config.pinned_server_key = pin;
    session_config.predicts_own_ball = config.predict;
    session = std::make_unique<client::Session>(session_config, *transport);
    stage = Stage::kSession;
}

void App::Impl::host() {
    remember();
    hosted = true;
    stage = Stage::kHosting;
    server = "a server on this machine";
    if (local_server == nullptr) start_server(game::kDefaultPort);
}

void App::Impl::start_server(int port) {
    host_port = port;
    LocalServerConfig server_config{server_program(), {}, port};
    if (!config.data_folder.empty()) server_config.data_folder = folder.path() / "server";
    std::string error;
    local_server = LocalServer::start(server_config, error);
    if (local_server == nullptr) end("No server on this machine", error);
}

void App::Impl::update_hosting() {
    switch (local_server->poll()) {
        case LocalServer::State::kStarting:
            break;
        case LocalServer::State::kListening: {
            const std::string name = "localhost:" + std::to_string(local_server->port());
            const net::Resolved resolved = client::resolve_server(name);
            if (!resolved.address) {
                end("No server on this machine", resolved.error);
                break;
            }
            address = resolved.address;
            // Started by us just now: whatever key it has is the right one.
            connect(name, std::nullopt);
            match.hud.chat.push_back({"Others join at this machine's address, port " +
                                          std::to_string(local_server->port()) + ".",
                                      palette::kAccent, updated_s});
            break;
        }
        case LocalServer::State::kFailed: {
            const std::string why = local_server->error();
            local_server.reset();
            // Most often somebody else has the usual port.
            if (host_port != 0) {
                start_server(0);
            } else {
                end("No server on this machine", why);
            }
            break;
        }
    }
}

void App::Impl::pin_server() {
    if (pinned || hosted || !session->server_key()) return;
    pinned = true;
    std::string error;
    if (!known_servers.pin(*address, *session->server_key(), error)) {
        match.hud.chat.push_back({error, palette::kBad, updated_s});
    }
}

void App::Impl::leave(double now_s) {
    if (session) session->leave(now_s);
    session.reset();
    transport.reset();
    stage = Stage::kMenu;
}

// ImGui looks at keys once a frame and would miss a tap that is shorter: the release of a key waits
// for the frame after its press.
void App::Impl::poll_events() {
    std::vector<SDL_Scancode> pressed;
    SDL_Event event;
    SDL_PumpEvents();
    while (SDL_PeepEvents(&event, 1, SDL_PEEKEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT) == 1) {
        const SDL_Scancode scancode = event.key.keysym.scancode;
        if (event.type == SDL_KEYUP && std::ranges::count(pressed, scancode) > 0) break;
        if (event.type == SDL_KEYDOWN) pressed.push_back(scancode);
        SDL_PeepEvents(&event, 1, SDL_GETEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT);
        const bool typing = window->handle(event);
        devices->handle(event, typing);
        if (event.type == SDL_QUIT) quit = true;
    }
}

void App::Impl::update_session(double now_s) {
    if (hosted && local_server && local_server->poll() == LocalServer::State::kFailed) {
        const std::string why = local_server->error();
        local_server.reset();
        leave(now_s);
        end("The server on this machine ended", why);
        return;
    }
    std::optional<ImVec2> own_px;
    if (view.own_ball) own_px = match.camera.to_screen(view.balls[*view.own_ball].position_m);
    game::InputCommand command;
    if (steers(match, view)) {
        command = devices->command(own_px, unit_for(ImGui::GetIO().DisplaySize));
    }
    count_dash(command, view, now_s - updated_s, match.hud);
    session->set_input(command);
    session->show_prediction(!shows_laws(match));
    session->update(now_s);
    pin_server();
    if (session->status() == client::Status::kEnded) {
        end(title_for(session->end_reason()), session->ended_because());
        return;
    }
    view = session->view(now_s);
    take_notices(session->drain_notices(), view, match, now_s);
}

void App::Impl::update(double now_s) {
    const Actions actions = devices->take_actions();
    slot.reset();
    if (stage == Stage::kLookingUp) update_lookup();
    if (stage == Stage::kHosting) update_hosting();
    if (stage == Stage::kSession) {
        update_session(now_s);
        if (session && session->status() == client::Status::kPlaying) {
            apply(actions, match, view);
            slot = actions.slot;
        } else if (actions.back) {
            leave(now_s);
        }
    } else if (actions.back && stage != Stage::kMenu) {
        stage = Stage::kMenu;
    }
    // The server must not wait for somebody to read its output.
    if (stage != Stage::kSession && stage != Stage::kHosting && local_server) local_server->poll();
    updated_s = now_s;
}

void App::Impl::draw_session(Canvas& canvas) {
    if (session->status() != client::Status::kPlaying) {
        const bool joining = session->status() == client::Status::kJoining;
        if (draw_connecting(canvas, server, joining)) leave(updated_s);
        return;
    }
    const MatchChoice choice = draw_match(canvas, view, match, slot);
    if (choice.buy) session->buy(*choice.buy);
    if (choice.ready) session->ready();
    if (choice.chat) session->chat(*choice.chat);
    if (choice.quit) quit = true;
    if (choice.leave) leave(updated_s);
}

void App::Impl::draw(Canvas& canvas) {
    switch (stage) {
        case Stage::kMenu:
            switch (draw_menu(canvas, menu)) {
                case MenuChoice::kJoin:
                    join();
                    break;
                case MenuChoice::kHost:
                    host();
                    break;
                case MenuChoice::kQuit:
                    quit = true;
                    break;
                case MenuChoice::kNone:
                    break;
            }
            break;
        case Stage::kLookingUp:
        case Stage::kHosting:
            if (draw_connecting(canvas, server, false)) stage = Stage::kMenu;
            break;
        case Stage::kSession:
            draw_session(canvas);
            break;
        case Stage::kEnded:
            switch (draw_ended(canvas, ending.title, ending.words)) {
                case NoticeChoice::kRetry:
                    hosted ? host() : join();
                    break;
                case NoticeChoice::kBack:
                    stage = Stage::kMenu;
                    break;
                case NoticeChoice::kNone:
                    break;
            }
            break;
    }
}

int App::Impl::run() {
    const double start_s = monotonic_s();
    if (config.join) join();
    while (!quit) {
        const double now_s = monotonic_s();
        poll_events();
        update(now_s);
        Canvas canvas = window->begin_frame(now_s);
        draw(canvas);
        const bool shoot =
            !config.screenshot_file.empty() && now_s - start_s >= config.screenshot_after_s;
        std::string error;
        if (!window->end_frame(shoot ? config.screenshot_file : "", error)) {
            std::fprintf(stderr, "fts-client: %s\n", error.c_str());
            return kExitFailure;
        }
        if (shoot) quit = true;
        const double spare_s = window->shortest_frame_s() - (monotonic_s() - now_s);
        if (spare_s > 0.0) {
            std::this_thread::sleep_for(std::chrono::duration<double>(spare_s));
        }
    }
    if (session) session->leave(monotonic_s());
    return 0;
}

std::unique_ptr<App> App::create(const AppConfig& config, std::string& error) {
    auto folder = client::DataFolder::open(config.data_folder, error);
    if (!folder) return nullptr;
    const auto key = folder->player_key(error);
    if (!key) return nullptr;
    auto impl = std::make_unique<Impl>(config, *std::move(folder), *key);
    impl->window = Window::open(
        {"Fear The Sphere", config.width_px, config.height_px, config.fullscreen, config.software},
        error);
    if (impl->window == nullptr) return nullptr;
    return std::unique_ptr<App>(new App(std::move(impl)));
}

App::App(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

App::~App() {
    // Gamepads are closed before the window takes SDL down.
    impl_->devices.reset();
}

int App::run() {
    return impl_->run();
}

}  // namespace fts::sdl
