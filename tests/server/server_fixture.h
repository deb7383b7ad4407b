// A server and its clients on an in-memory network, moved forward tick by tick.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "server/server.h"
#include "tests/server/fake_client.h"
#include "tests/server/memory_store.h"

namespace fts::server {

class ServerTest : public ::testing::Test {
  protected:
    // One AI ball, and lost by time after `kPlayS`: so that the shop opens soon.
    static constexpr double kPlayS = 0.5;
    static game::Level short_level() {
        game::Level level;
        level.name = "short";
        level.platform = physics::Disc{30.0};
        level.ai = {game::AiGroup{}};
        level.field_coins = 3;
        level.time_limit_s = kPlayS;
        return level;
    }

    void SetUp() override {
        config.key = net::generate_key_pair();
        config.levels = {short_level()};
        config.journal.first_retry_s = 0.001;
        config.journal.slowest_retry_s = 0.002;
        config.journal.finish_within_s = 1.0;
    }

    void start() {
        server = std::make_unique<Server>(
            config, server_transport_, std::make_unique<MemoryStore>(disk),
            [this](LogLevel, const std::string& line) { log.push_back(line); });
    }
    // The same machine after a stop.
    void restart() {
        server->shut_down(now_s, "restart");
        clients.clear();
        start();
    }

    FakeClient& dial(const net::KeyPair& key, std::uint16_t version = net::kProtocolVersion) {
        clients.push_back(
            std::make_unique<FakeClient>(network, server_address_, next_host_++, key, version));
        return *clients.back();
    }
    FakeClient& connect(const net::KeyPair& key = net::generate_key_pair()) {
        FakeClient& client = dial(key);
        EXPECT_TRUE(run_until([&] { return client.is_connected(); }));
        return client;
    }
    FakeClient& join(const std::string& name, int arena = -1,
                     const net::KeyPair& key = net::generate_key_pair()) {
        FakeClient& client = connect(key);
        client.say(replication::JoinRequest{name, arena});
        EXPECT_TRUE(run_until([&] { return client.welcome() && client.snapshots > 0; }))
            << name << " was not let in";
        return client;
    }

    void step() {
        now_s += game::kTickDurationS;
        for (const auto& client : clients) client->update(now_s);
        server->tick(now_s);
        network.sent.clear();
    }
    void run(double duration_s) {
        for (const double end_s = now_s + duration_s; now_s < end_s;) step();
    }
    // Leaves the journal's thread time to do its part. False when it has not come about in time.
    bool run_until(const std::function<bool()>& condition, double patience_s = 8.0) {
        const double hurry_until_s = now_s + patience_s / 2;
        for (const double end_s = now_s + patience_s; !condition() && now_s < end_s;) {
            step();
            std::this_thread::sleep_for(std::chrono::milliseconds(now_s < hurry_until_s ? 1 : 20));
        }
        return condition();
    }
    bool run_until_shop() {
        return run_until([&] { return clients.back()->snapshot.phase == game::Phase::kShop; });
    }
    std::uint64_t dropped(const std::string& what) const {
        const auto drops = server->report().drops;
        const auto found = drops.find(what);
        return found == drops.end() ? 0 : found->second;
    }
    // Puts coins into a player's purse before the server starts.
    net::KeyPair rich_player(std::int64_t coins) {
        PlayerRecord record;
        const net::KeyPair key = net::generate_key_pair();
        record.key = key.public_key;
        record.coins = coins;
        disk.put(record);
        return key;
    }

    ServerConfig config;
    MemoryDisk disk;
    net::MemoryNetwork network;
    std::unique_ptr<Server> server;
    std::vector<std::unique_ptr<FakeClient>> clients;
    std::vector<std::string> log;
    double now_s = 1000.0;

  private:
    net::Address server_address_ = net::address_of(1);
    net::MemoryTransport server_transport_{network, server_address_};
    std::uint8_t next_host_ = 2;
};

}  // namespace fts::server
