// The rules of the house as data: which room may include which, where each third party is confined,
// and how long things may be. To change the architecture, change a row here.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace fts::tidy {

inline constexpr std::size_t kMaxFileLines = 500;
inline constexpr std::size_t kMaxFunctionLines = 70;

// Lists are names separated by blanks. A path belongs to the longest room that it starts with.
struct Room {
    std::string_view path;
    std::string_view may_include;  // besides itself
};
inline constexpr auto kRooms = std::to_array<Room>({
    {"common/physics", ""},
    {"common/game", "common/physics"},
    {"common/replication", "common/physics common/game"},
    {"common/net", ""},
    {"server", "common"},
    {"client/core", "common"},
    {"client/sdl", "client/core common/game common/physics"},
    {"client/bot", "client/core common/game common/physics"},
    {"tests", "client common server"},
});

// Single headers that a room may include beyond its row.
struct Exception {
    std::string_view room;
    std::string_view headers;
    std::string_view reason;
};
inline constexpr auto kExceptions = std::to_array<Exception>({
    {"client/sdl", "common/net/connection.h common/net/transport.h common/net/udp_transport.h",
     "a program opens the socket and the key pair that it hands to client/core"},
    {"client/sdl", "common/replication/messages.h",
     "the view and the notices of client/core are made of these values"},
    {"client/bot", "common/net/connection.h common/net/transport.h common/net/udp_transport.h",
     "a program opens the socket and the key pair that it hands to client/core"},
    {"client/bot", "common/replication/messages.h",
     "the view and the notices of client/core are made of these values"},
});

// Headers from outside and the only files and folders that may include them. Every header that has
// a slash or an extension and is not ours needs a row: a new dependency is a decision.
struct ThirdParty {
    std::string_view name;
    std::string_view headers;   // how they start
    std::string_view homes;     // files, or folders; empty: everywhere
    bool sources_only = false;  // not in headers, so that nobody gets it through an include
};
inline constexpr auto kThirdParties = std::to_array<ThirdParty>({
    {"Eigen", "Eigen/", "", false},
    {"Asio", "asio.hpp asio/", "common/net", true},
    {"libsodium", "sodium.h sodium/", "common/net", true},
    {"Protobuf", "google/protobuf/ arena.pb.h scene.pb.h",
     "common/replication/wire.cpp server/match/level_file.cpp server/lab/scene_text.cpp", true},
    {"SDL", "SDL", "client/sdl tests/client_sdl", false},
    {"Dear ImGui", "imgui", "client/sdl tests/client_sdl", false},
    {"stb", "stb_", "client/sdl", true},
    {"stb", "stb_", "client/sdl", true},
    {"SQLite", "sqlite3.h", "server/economy", true},
    {"CLI11", "CLI/",
     "server/main.cpp tests/accuracy/main.cpp tests/bench/speed_page.cpp server/lab server/ops "
     "client/sdl/main.cpp client/bot/main.cpp",
     false},
    {"spdlog", "spdlog/ fmt/",
     "server/main.cpp server/lab server/ops client/sdl/main.cpp client/bot/main.cpp", false},
    {"nlohmann::json", "nlohmann/", "client/bot server/lab server/ops tests", false},
    {"Box2D", "box2d/", "server/lab/peers/box2d_engine.cpp", true},
    {"Chipmunk", "chipmunk/", "server/lab/peers/chipmunk_engine.cpp", true},
    {"Google Benchmark", "benchmark/", "tests/bench", true},
    {"GoogleTest", "gtest/ gmock/", "tests", false},
    {"the compiler's vector instructions", "emmintrin.h immintrin.h",
     "common/physics/crowd_loops.h common/physics/crowd_kernels_avx2.cpp "
     "common/physics/crowd_kernels_avx512.cpp common/physics/swept_lanes.cpp "
     "common/physics/slot_scatter.h common/physics/swept_lanes_avx2.cpp "
     "common/physics/swept_start.h "
     "common/physics/event_cells.cpp common/physics/flight_filter_avx2.cpp "
     "common/physics/flight_filter_avx512.cpp common/physics/path_kernels_avx2.cpp "
     "common/physics/path_kernels_avx512.cpp",
     false},
    {"POSIX", "sys/ netinet/ arpa/ unistd.h fcntl.h poll.h signal.h spawn.h dirent.h pwd.h",
     "server/main.cpp server/lab server/ops server/economy client/sdl client/bot common/net tests "
     "common/physics/roomy_vector.cpp",
     true},
});

// Rooms in which the same calls must give the same bits: no clock, no global random numbers, no
// threads, and no container whose order of iteration is not defined.
inline constexpr std::string_view kDeterministicRooms =
    "common/physics common/game common/replication server/match server/ai";
inline constexpr std::string_view kIndeterminateHeaders =
    "chrono ctime random thread mutex atomic future unordered_map unordered_set";

inline constexpr std::string_view kEmptyNames =
    "util utils helper helpers misc stuff common_functions";

}  // namespace fts::tidy
