// Crowd: many bots in one process, each with its own socket and key, updated in turn by one thread.
#pragma once

#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/bot/bot.h"
#include "client/bot/script.h"
#include "client/core/data_folder.h"
#include "client/core/endpoint.h"
#include "client/core/known_servers.h"

namespace fts::bot {

inline constexpr int kMaxBots = 1000;

struct CrowdConfig {
    std::string server;  // "host:port"
    int bots = 4;
    std::string pilot = "chaser";
    std::string name_prefix = "bot";
    std::uint64_t seed = 1;
    int arena = -1;
    std::uint16_t protocol_version = net::kProtocolVersion;
    std::optional<net::LinkConditions> conditions;
    std::string data;  // folder with bot-K.key and known_servers; empty: new keys, nothing is kept
    std::string hits;  // file to write every hit to; empty: none
};

class Crowd {
  public:
    // nullptr with `error` set to what is wrong and a remedy. The script must outlive the crowd.
    static std::unique_ptr<Crowd> open(const CrowdConfig& config, const Script& script,
                                       std::string& error);

    // `now_s`: seconds since the start of the run.
    void update(double now_s);
    // Every bot leaves for good; further updates only let the goodbyes out.
    void retire(double now_s);
    // Every bot has ended, or the script's goals are reached.
    bool finished() const;

    std::vector<Tally> tallies() const;
    // What went wrong beside the game, such as a file that could not be written.
    const std::vector<std::string>& problems() const { return problems_; }

  private:
    explicit Crowd(const Script& script) : script_(script) {}
    bool prepare_files(const CrowdConfig& config, std::string& error);
    bool add_bot(int number, const CrowdConfig& config, const net::Address& server,
                 std::string& error);
    void write_hit(int bot, const replication::CollisionReport& hit);
    void pin_server_key();

    struct Member {
        std::unique_ptr<net::Transport> transport;
        std::unique_ptr<Bot> bot;
    };

    const Script& script_;
    std::optional<client::DataFolder> folder_;
    std::optional<client::KnownServers> known_servers_;
    net::Address server_;
    bool pinned_ = false;
    std::ofstream hits_;
    std::string hits_path_;
    // The bots of an arena see the same; one of them simulates it, and makes what all go by.
    std::shared_ptr<replication::SharedReplay> replays_ =
        std::make_shared<replication::SharedReplay>();
    std::shared_ptr<Fields> fields_ = std::make_shared<Fields>();
    std::vector<Member> members_;
    std::vector<std::string> problems_;
};

}  // namespace fts::bot
