#include "client/bot/bot.h"

#include <algorithm>
#include <cassert>

#include "client/bot/conservation.h"
#include "client/bot/session_totals.h"
#include "client/bot/shopping.h"
#include "common/game/rules.h"

namespace fts::bot {
namespace {

bool was_bought(replication::PurchaseOutcome outcome) {
    return outcome == replication::PurchaseOutcome::kBought ||
           outcome == replication::PurchaseOutcome::kAlreadyBought;
}

bool was_cleared(replication::LevelOutcome outcome) {
    return outcome == replication::LevelOutcome::kCleared ||
           outcome == replication::LevelOutcome::kCampaignComplete;
}

std::optional<Moment> moment_of(game::Phase phase) {
    switch (phase) {
        case game::Phase::kCountdown:
            return Moment::kCountdown;
        case game::Phase::kPlaying:
            return Moment::kPlaying;
        case game::Phase::kShop:
            return Moment::kShop;
        case game::Phase::kWaiting:
            break;
    }
    return std::nullopt;
}

}  // namespace

Bot::Bot(const BotConfig& config, const Script& script, net::Transport& transport,
         HitListener on_hit)
    : config_(config),
      script_(script),
      transport_(transport),
      on_hit_(std::move(on_hit)),
      pilot_(make_pilot(config.pilot)),
      rng_(config.seed),
      step_has_fired_(script.steps.size(), false) {
    assert(pilot_);
    if (!config_.fields) config_.fields = std::make_shared<Fields>();
    tally_.name = config_.session.name;
    for (std::size_t i = 0; i < script_.steps.size(); ++i) {
        const Step& step = script_.steps[i];
        const bool mine = !step.bot || *step.bot == config_.number;
        if (mine && !step.when) scheduled_.push_back({step.at_s, i});
    }
    start_session();
}

void Bot::start_session() {
    if (session_) earlier_sessions_ = sum_of(earlier_sessions_, session_->stats());
    session_ = std::make_unique<client::Session>(config_.session, transport_);
    last_status_ = client::Status::kConnecting;
    last_phase_.reset();
    tiers_ = {};
    decided_on_.reset();
    pending_purchase_.reset();
    is_ready_ = was_refused_ = false;
    tally_.ended_because.clear();
}

void Bot::update(double now_s) {
    session_->update(now_s);
    if (is_retired_) return;
    note_status();
    note_notices();
    if (session_->status() == client::Status::kPlaying && now_s >= next_frame_s_) {
        next_frame_s_ = std::max(next_frame_s_ + game::kTickDurationS, now_s);
        const client::Glance glance = session_->glance(now_s);
        note_glance(glance, now_s);
        steer(glance);
        go_shopping();
    }
    for (const Moment moment : std::exchange(moments_, {})) happened(moment, now_s);
    run_due_steps(now_s);
}

void Bot::retire(double now_s) {
    is_retired_ = true;
    leave(now_s);
}

void Bot::leave(double now_s) {
    session_->leave(now_s);
    note_status();
}

Tally Bot::tally() const {
    Tally tally = tally_;
    tally.session = sum_of(earlier_sessions_, session_->stats());
    return tally;
}

bool Bot::finished() const {
    // What has just happened may still set a step off.
    if (session_->status() != client::Status::kEnded || !moments_.empty()) return false;
    return std::ranges::none_of(scheduled_, [&](const Scheduled& item) {
        return std::holds_alternative<Join>(script_.steps[item.step].action);
    });
}

void Bot::note_status() {
    const client::Status status = session_->status();
    if (status == last_status_) return;
    last_status_ = status;
    if (status == client::Status::kPlaying) {
        tally_.joined = true;
        moments_.push_back(Moment::kJoined);
    } else if (status == client::Status::kEnded) {
        tally_.ended_because = session_->ended_because();
        moments_.push_back(Moment::kEnded);
    }
}

void Bot::note_notices() {
    for (const client::Notice& notice : session_->drain_notices()) {
        if (const auto* level = std::get_if<replication::LevelStarted>(&notice.message)) {
            ++tally_.levels_started;
            tally_.highest_level = std::max(tally_.highest_level, level->number);
        } else if (const auto* end = std::get_if<replication::LevelEnded>(&notice.message)) {
            const bool cleared = was_cleared(end->outcome);
            ++(cleared ? tally_.levels_cleared : tally_.levels_lost);
            moments_.push_back(cleared ? Moment::kLevelCleared : Moment::kLevelLost);
        } else if (const auto* hit = std::get_if<replication::CollisionReport>(&notice.message)) {
            note_hit(*hit);
        } else if (const auto* result = std::get_if<replication::PurchaseResult>(&notice.message)) {
            note_purchase(*result);
        } else if (notice.kind == client::Notice::Kind::kChat) {
            ++tally_.chat_lines;
        }
    }
}

void Bot::note_hit(const replication::CollisionReport& hit) {
    ++tally_.hits;
    if (const auto error = conservation_error(hit)) {
        tally_.worst_momentum_error = std::max(tally_.worst_momentum_error, error->momentum);
        tally_.worst_energy_error = std::max(tally_.worst_energy_error, error->energy);
    } else {
        ++tally_.hits_malformed;
    }
    if (on_hit_) on_hit_(config_.number, hit);
}

void Bot::note_purchase(const replication::PurchaseResult& result) {
    const bool bought = was_bought(result.outcome);
    ++(bought ? tally_.purchases : tally_.purchases_refused);
    if (!pending_purchase_ || pending_purchase_->first != result.request_id) return;
    if (bought) tally_.coins_spent += pending_purchase_->second;
    was_refused_ = !bought;
    pending_purchase_.reset();
}

void Bot::note_glance(const client::Glance& glance, double now_s) {
    if (glance.link.rtt_s > 0.0) tally_.rtt.add(glance.link.rtt_s);
    tally_.delay_sum_s += glance.link.interpolation_delay_s;
    tally_.input_slack_sum_s += glance.link.input_slack_s;
    ++tally_.delay_samples;
    tally_.coins = glance.coins_held;
    tiers_ = glance.tiers;
    if (glance.own_player) {
        tally_.knock_offs = glance.own_player->knock_offs;
        tally_.assists = glance.own_player->assists;
        tally_.falls = glance.own_player->falls;
    }
    const game::Phase phase = glance.newest ? glance.newest->phase : game::Phase::kWaiting;
    if (last_phase_ == phase) return;
    last_phase_ = phase;
    is_ready_ = was_refused_ = false;
    if (const auto moment = moment_of(phase)) happened(*moment, now_s);
}

void Bot::happened(Moment moment, double now_s) {
    for (std::size_t i = 0; i < script_.steps.size(); ++i) {
        const Step& step = script_.steps[i];
        const bool mine = !step.bot || *step.bot == config_.number;
        if (!mine || step.when != moment || (step_has_fired_[i] && !step.each_time)) continue;
        step_has_fired_[i] = true;
        scheduled_.push_back({now_s + step.at_s, i});
    }
}

void Bot::run_due_steps(double now_s) {
    std::ranges::stable_sort(scheduled_, {}, &Scheduled::at_s);
    // An action may schedule another one, but only for the next update.
    const auto first_later =
        std::ranges::find_if(scheduled_, [&](const Scheduled& item) { return item.at_s > now_s; });
    const std::vector<Scheduled> due(scheduled_.begin(), first_later);
    scheduled_.erase(scheduled_.begin(), first_later);
    for (const Scheduled& item : due) act(script_.steps[item.step].action, now_s);
}

void Bot::act(const Action& action, double now_s) {
    if (const auto* purchase = std::get_if<Buy>(&action)) {
        buy(purchase->stat);
    } else if (const auto* line = std::get_if<Chat>(&action)) {
        session_->chat(line->text);
    } else if (const auto* choice = std::get_if<UsePilot>(&action)) {
        pilot_ = make_pilot(choice->name);
        held_command_.reset();
        decided_on_.reset();
    } else if (const auto* hold = std::get_if<Steer>(&action)) {
        held_command_ = hold->command;
    } else if (std::holds_alternative<Ready>(action)) {
        session_->ready();
        is_ready_ = true;
    } else if (std::holds_alternative<Leave>(action)) {
        leave(now_s);
    } else if (session_->status() == client::Status::kEnded) {
        start_session();
    }
}

void Bot::buy(game::Stat stat) {
    const auto price = game::price_coins(tiers_[static_cast<std::size_t>(stat)]);
    pending_purchase_ = {session_->buy(stat), price.value_or(0)};
}

void Bot::go_shopping() {
    if (last_phase_ != game::Phase::kShop || is_ready_ || pending_purchase_) return;
    std::optional<game::Stat> wanted;
    if (script_.auto_shop && !was_refused_) {
        wanted = next_purchase(pilot_->shopping_list(), tiers_, tally_.coins);
    }
    if (wanted) {
        buy(*wanted);
    } else if (script_.auto_ready) {
        session_->ready();
        is_ready_ = true;
    }
}

void Bot::steer(const client::Glance& glance) {
    if (held_command_) {
        session_->set_input(*held_command_);
        return;
    }
    if (glance.newest == decided_on_) return;
    decided_on_ = glance.newest;
    const auto field = last_phase_ == game::Phase::kPlaying ? config_.fields->of(glance) : nullptr;
    game::InputCommand command;
    if (field) {
        const double lag_s = glance.age_s + glance.link.rtt_s;
        const Sight sight = sight_of(*field, glance.own_player_id, glance.tiers, lag_s);
        if (sight.own != nullptr) command = pilot_->decide(sight, rng_);
    }
    session_->set_input(command);
}

}  // namespace fts::bot
