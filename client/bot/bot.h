// Bot: one headless player. It plays through client/core as a person's client does, only that it
// goes by the newest snapshot instead of a picture: it decides with a pilot, does what its script
// says, and counts what it sees. Time and transport are passed in.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/bot/pilot.h"
#include "client/bot/script.h"
#include "client/bot/tally.h"
#include "client/core/session.h"

namespace fts::bot {

struct BotConfig {
    int number = 0;
    client::SessionConfig session;
    std::string pilot = "chaser";  // a name that make_pilot knows
    std::uint64_t seed = 1;
    // Shared by the bots of one server; null: its own.
    std::shared_ptr<Fields> fields;
};

class Bot {
  public:
    using HitListener = std::function<void(int bot, const replication::CollisionReport& hit)>;

    // Script and transport must outlive the bot.
    Bot(const BotConfig& config, const Script& script, net::Transport& transport,
        HitListener on_hit);

    // Several times a tick or less: receives, acts, sends. `now_s` is seconds since the start of
    // the run.
    void update(double now_s);
    // For good, whatever the script says; further updates only let the goodbye out.
    void retire(double now_s);

    // Has ended, and no step of its script is left to bring it back.
    bool finished() const;
    Tally tally() const;
    // Of the newest session; once connected.
    std::optional<net::PublicKey> server_key() const { return session_->server_key(); }

  private:
    void leave(double now_s);
    void note_status();
    void note_notices();
    void note_glance(const client::Glance& glance, double now_s);
    void note_hit(const replication::CollisionReport& hit);
    void note_purchase(const replication::PurchaseResult& result);
    void happened(Moment moment, double now_s);
    void run_due_steps(double now_s);
    void act(const Action& action, double now_s);
    void go_shopping();
    void steer(const client::Glance& glance);
    void buy(game::Stat stat);
    void start_session();

    struct Scheduled {
        double at_s = 0.0;
        std::size_t step = 0;
    };

    BotConfig config_;
    const Script& script_;
    net::Transport& transport_;
    HitListener on_hit_;
    std::unique_ptr<client::Session> session_;
    std::unique_ptr<Pilot> pilot_;
    std::optional<game::InputCommand> held_command_;
    Rng rng_;

    std::vector<Scheduled> scheduled_;  // by time, then by step
    std::vector<bool> step_has_fired_;
    client::Status last_status_ = client::Status::kConnecting;
    std::optional<game::Phase> last_phase_;
    std::vector<Moment> moments_;  // since the last update
    game::Tiers tiers_{};
    double next_frame_s_ = 0.0;
    std::shared_ptr<const replication::Snapshot> decided_on_;

    bool is_retired_ = false;
    bool is_ready_ = false;
    bool was_refused_ = false;  // in this visit to the shop: asking again would not help
    std::optional<std::pair<std::uint64_t, int>> pending_purchase_;  // request id, price in coins

    Tally tally_;  // but for `session`
    client::SessionStats earlier_sessions_;
};

}  // namespace fts::bot
