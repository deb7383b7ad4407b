#include "server/match/attribution.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>

#include "common/game/rules.h"

namespace fts::server {
namespace {

constexpr std::uint32_t ticks(double seconds) {
    return static_cast<std::uint32_t>(seconds * game::kTickRateHz + 0.5);
}
constexpr std::uint32_t kExpiryTicks = ticks(Attribution::kExpiryS);
constexpr std::uint32_t kCalmTicks = ticks(Attribution::kCalmS);
constexpr std::uint32_t kBilliardTicks = ticks(Attribution::kBilliardS);

// 2^(-1 / 120): a tick's decay. A table of products keeps libm out of the result.
constexpr double kDecayPerTick = 0.9942404238175473;
static_assert(ticks(Attribution::kHalfLifeS) == 120);

constexpr auto kDecay = [] {
    std::array<double, kExpiryTicks + 1> table{};
    double factor = 1.0;
    for (double& entry : table) {
        entry = factor;
        factor *= kDecayPerTick;
    }
    return table;
}();

}  // namespace

void Attribution::record(const Hit& hit) {
    assert(hit.victim != hit.actor);
    auto& contacts = victims_[hit.victim].contacts;
    if (contacts.size() == kMaxContacts) {
        contacts.pop_front();
        ++forgotten_early_;
    }
    contacts.push_back({.actor = hit.actor,
                        .tick = hit.tick,
                        .order = next_order_++,
                        .impulse_ns = hit.impulse_ns,
                        .decisive = hit.impulse_ns >= kDecisiveShare * hit.victim_full_momentum_ns,
                        .actor_came = hit.actor_came});
}

void Attribution::observe(Actor actor, std::uint32_t tick, bool well_inside) {
    const auto found = victims_.find(actor);
    if (found == victims_.end()) return;
    Victim& victim = found->second;
    if (well_inside && !victim.inside) victim.inside_since = tick;
    victim.inside = well_inside;
    if (!well_inside) return;
    auto& contacts = victim.contacts;
    while (!contacts.empty() &&
           tick - std::max(contacts.front().tick, victim.inside_since) >= kCalmTicks) {
        contacts.pop_front();
    }
}

void Attribution::respawned(Actor victim) {
    victims_.erase(victim);
}

void Attribution::expire(std::uint32_t now) {
    for (auto& [actor, victim] : victims_) {
        auto& contacts = victim.contacts;
        while (!contacts.empty() && now - contacts.front().tick > kExpiryTicks) {
            contacts.pop_front();
        }
    }
    std::erase_if(victims_, [](const auto& entry) { return entry.second.contacts.empty(); });
}

void Attribution::clear() {
    victims_.clear();
}

const Attribution::Contact* Attribution::knock_before(Actor holder, const Contact& contact,
                                                      const std::vector<Actor>& chain) const {
    const auto found = victims_.find(holder);
    if (found == victims_.end()) return nullptr;
    const Contact* latest = nullptr;
    for (const Contact& knock : found->second.contacts) {
        const bool in_time =
            knock.order < contact.order && contact.tick - knock.tick <= kBilliardTicks;
        const bool in_chain = std::find(chain.begin(), chain.end(), knock.actor) != chain.end();
        if (in_time && knock.decisive && knock.actor_came && !in_chain) latest = &knock;
    }
    return latest;
}

std::vector<Actor> Attribution::pass_on(Pass pass, Actor victim,
                                        std::map<Actor, double>& fractions) const {
    std::vector<Actor> chain{victim, pass.holder};
    for (int link = 0; link < kMaxLinks; ++link) {
        const Contact* knock = knock_before(pass.holder, *pass.contact, chain);
        if (knock == nullptr) break;
        pass.fraction /= 2.0;
        fractions[pass.holder] += pass.fraction;
        pass.holder = knock->actor;
        pass.contact = knock;
        chain.push_back(pass.holder);
    }
    fractions[pass.holder] += pass.fraction;
    chain.erase(chain.begin());
    return chain;
}

std::vector<Attribution::Share> Attribution::credit(Actor victim, std::uint32_t now) const {
    const auto found = victims_.find(victim);
    if (found == victims_.end()) return {};

    struct Claim {
        double weight = 0.0;
        const Contact* latest = nullptr;
    };
    std::map<Actor, Claim> claims;
    double total_weight = 0.0;
    const Contact* owner = nullptr;
    for (const Contact& contact : found->second.contacts) {
        const std::uint32_t age = now - contact.tick;
        if (age > kExpiryTicks) continue;
        const double weight = contact.impulse_ns * kDecay[age];
        total_weight += weight;
        claims[contact.actor].weight += weight;
        claims[contact.actor].latest = &contact;
        if (contact.decisive) owner = &contact;
    }
    if (owner == nullptr) return {};

    claims.erase(owner->actor);
    std::erase_if(claims, [total_weight](const auto& entry) {
        return entry.second.weight < kAssistShare * total_weight;
    });
    const double assist_weight =
        std::accumulate(claims.begin(), claims.end(), 0.0,
                        [](double sum, const auto& entry) { return sum + entry.second.weight; });

    std::map<Actor, double> fractions;
    const double owner_fraction = claims.empty() ? 1.0 : kOwnerShare;
    const std::vector<Actor> owner_chain =
        pass_on({owner->actor, owner, owner_fraction}, victim, fractions);
    for (const auto& [actor, claim] : claims)
        pass_on({actor, claim.latest, (1.0 - kOwnerShare) * claim.weight / assist_weight}, victim,
                fractions);

    const auto scorer = std::find_if(owner_chain.begin(), owner_chain.end(),
                                     [](const Actor& actor) { return actor.is_player(); });
    std::vector<Share> shares;
    shares.reserve(fractions.size());
    for (const auto& [actor, fraction] : fractions)
        shares.push_back({actor, fraction, scorer == owner_chain.end() || actor != *scorer});
    std::stable_sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
        if (a.assist != b.assist) return b.assist;
        return a.fraction > b.fraction;
    });
    return shares;
}

bool came_at(const physics::Vec2d& actor_velocity_mps, const physics::Vec2d& victim_velocity_mps,
             const physics::Vec2d& towards_victim) {
    return actor_velocity_mps.dot(towards_victim) > -victim_velocity_mps.dot(towards_victim);
}

std::vector<int> split_coins(int coins, const std::vector<Attribution::Share>& shares) {
    assert(coins >= 0);
    if (shares.empty()) return {};
    std::vector<int> result;
    std::vector<double> remainders;
    for (const auto& share : shares) {
        const double exact = share.fraction * coins;
        // Thirds that add up to a whole coin must not lose it to the last bit.
        const double whole = std::floor(exact + 1e-9);
        result.push_back(static_cast<int>(whole));
        remainders.push_back(exact - whole);
    }
    int left = coins - std::accumulate(result.begin(), result.end(), 0);
    for (; left > 0; --left) {
        const auto most = std::max_element(remainders.begin(), remainders.end(),
                                           [](double a, double b) { return a < b - 1e-9; });
        const auto index = most - remainders.begin();
        ++result[static_cast<std::size_t>(index)];
        *most -= 1.0;
    }
    return result;
}

}  // namespace fts::server
