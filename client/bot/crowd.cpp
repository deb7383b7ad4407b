#include "client/bot/crowd.h"

#include <algorithm>

#include "client/bot/conservation.h"
#include "client/bot/expectations.h"

namespace fts::bot {

std::unique_ptr<Crowd> Crowd::open(const CrowdConfig& config, const Script& script,
                                   std::string& error) {
    const net::Resolved resolved = client::resolve_server(config.server);
    if (!resolved.address) {
        error = resolved.error;
        return nullptr;
    }
    std::unique_ptr<Crowd> crowd(new Crowd(script));
    crowd->server_ = *resolved.address;
    if (!crowd->prepare_files(config, error)) return nullptr;
    for (int number = 0; number < config.bots; ++number) {
        if (!crowd->add_bot(number, config, *resolved.address, error)) return nullptr;
    }
    return crowd;
}

bool Crowd::prepare_files(const CrowdConfig& config, std::string& error) {
    if (!config.data.empty()) {
        folder_ = client::DataFolder::open(config.data, error);
        if (!folder_) return false;
        known_servers_ = client::KnownServers::load(folder_->known_servers_path());
        problems_ = known_servers_->problems();
    }
    if (!config.hits.empty()) {
        hits_path_ = config.hits;
        hits_.open(config.hits);
        if (!(hits_ << hits_csv_heading() << '\n')) {
            error = "Cannot write " + config.hits + ". Give --hits a file that can be written.";
            return false;
        }
    }
    return true;
}

bool Crowd::add_bot(int number, const CrowdConfig& config, const net::Address& server,
                    std::string& error) {
    BotConfig bot;
    bot.number = number;
    bot.pilot = config.pilot;
    bot.seed = config.seed * std::uint64_t{kMaxBots} + static_cast<std::uint64_t>(number);
    bot.session.name = config.name_prefix + "-" + std::to_string(number);
    bot.session.server = server;
    bot.session.arena = config.arena;
    bot.session.protocol_version = config.protocol_version;
    bot.session.replays = replays_;
    bot.fields = fields_;
    if (folder_) {
        const auto key = folder_->player_key(error, "bot-" + std::to_string(number) + ".key");
        if (!key) return false;
        bot.session.key = *key;
        bot.session.pinned_server_key = known_servers_->find(server);
    } else {
        bot.session.key = net::generate_key_pair();
    }
    auto conditions = config.conditions;
    if (conditions) conditions->seed = bot.seed;
    Member member;
    member.transport = client::open_endpoint(conditions, error);
    if (!member.transport) return false;
    Bot::HitListener listener;
    if (hits_.is_open()) {
        listener = [this](int who, const replication::CollisionReport& hit) {
            write_hit(who, hit);
        };
    }
    member.bot = std::make_unique<Bot>(bot, script_, *member.transport, std::move(listener));
    members_.push_back(std::move(member));
    return true;
}

void Crowd::update(double now_s) {
    for (Member& member : members_) member.bot->update(now_s);
    if (known_servers_ && !pinned_) pin_server_key();
}

void Crowd::retire(double now_s) {
    for (Member& member : members_) member.bot->retire(now_s);
    if (hits_.is_open()) hits_.flush();
}

bool Crowd::finished() const {
    const bool all_ended =
        std::ranges::all_of(members_, [](const Member& member) { return member.bot->finished(); });
    return all_ended || (!script_.until.empty() && reached(script_.until, tallies()));
}

std::vector<Tally> Crowd::tallies() const {
    std::vector<Tally> tallies;
    tallies.reserve(members_.size());
    for (const Member& member : members_) tallies.push_back(member.bot->tally());
    return tallies;
}

void Crowd::write_hit(int bot, const replication::CollisionReport& hit) {
    if (!hits_) return;
    if (hits_ << hits_csv_line(bot, hit) << '\n') return;
    problems_.push_back("Cannot write to " + hits_path_ +
                        "; hits from here on are not in it. Make room on the disk.");
}

void Crowd::pin_server_key() {
    for (const Member& member : members_) {
        const auto key = member.bot->server_key();
        if (!key) continue;
        std::string error;
        if (!known_servers_->pin(server_, *key, error)) problems_.push_back(error);
        pinned_ = true;
        return;
    }
}

}  // namespace fts::bot
