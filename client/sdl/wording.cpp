#include "client/sdl/wording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "client/sdl/theme.h"

namespace fts::sdl {
namespace {

using Hit = replication::CollisionReport;

constexpr const char* kMinus = "\xe2\x88\x92";

std::string printed(const char* format, int decimals, double value) {
    if (!std::isfinite(value)) return "\xe2\x80\x93";
    std::array<char, 64> buffer{};
    // Larger values cannot be met in play, and would not fit.
    const double held = std::clamp(value, -1e15, 1e15);
    std::snprintf(buffer.data(), buffer.size(), format, decimals, held);
    return buffer.data();
}

std::string superscript(int exponent) {
    static constexpr std::array<const char*, 10> kDigits = {
        "\xe2\x81\xb0", "\xc2\xb9",     "\xc2\xb2",     "\xc2\xb3",     "\xe2\x81\xb4",
        "\xe2\x81\xb5", "\xe2\x81\xb6", "\xe2\x81\xb7", "\xe2\x81\xb8", "\xe2\x81\xb9"};
    std::string text = exponent < 0 ? "\xe2\x81\xbb" : "";
    for (const char digit : std::to_string(std::abs(exponent))) {
        text += kDigits[static_cast<std::size_t>(digit - '0')];
    }
    return text;
}

double kinetic_energy_j(const Hit::Side& side, const physics::Vec2d& velocity_mps) {
    return 0.5 * side.mass_kg * velocity_mps.squaredNorm();
}

constexpr double kNearlyEqual = 0.005;  // of a mass ratio: nobody can tell

std::string percent(double share) {
    return fixed(100.0 * share, 0) + " %";
}

std::string mass_clause(double ratio) {
    if (std::abs(ratio - 1.0) < kNearlyEqual) return "Equal masses: ";
    if (ratio > 1.0) return "You were " + fixed(ratio, 2) + "\xc3\x97 heavier: ";
    return "You were " + fixed(1.0 / ratio, 2) + "\xc3\x97 lighter: ";
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
        text += names[i];
    }
    return text;
}

}  // namespace

std::string fixed(double value, int decimals) {
    std::string text = printed("%.*f", decimals, value);
    const bool zero = text.find_first_of("123456789") == std::string::npos;
    if (text.starts_with('-')) text = (zero ? "" : kMinus) + text.substr(1);
    return text;
}

std::string signed_fixed(double value, int decimals) {
    const std::string text = fixed(value, decimals);
    return text.starts_with(kMinus) ? text : "+" + text;
}

std::string scientific(double value) {
    if (value == 0.0) return "0";
    if (!std::isfinite(value)) return "\xe2\x80\x93";
    std::array<char, 32> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.1e", value);
    const std::string printed_value = buffer.data();
    const std::size_t e = printed_value.find('e');
    std::string mantissa = printed_value.substr(0, e);
    if (mantissa.starts_with('-')) mantissa = kMinus + mantissa.substr(1);
    return mantissa + " \xc3\x97 10" + superscript(std::stoi(printed_value.substr(e + 1)));
}

std::string clock_time(double seconds) {
    const double whole = std::isfinite(seconds) ? std::clamp(std::ceil(seconds), 0.0, 5999.0) : 0.0;
    const int all = static_cast<int>(whole);
    std::array<char, 16> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%d:%02d", all / 60, all % 60);
    return buffer.data();
}

std::string mass_text(double mass_kg) {
    return fixed(mass_kg, 2) + " kg";
}

std::string coins_text(int coins) {
    return std::to_string(coins) + (coins == 1 ? " coin" : " coins");
}

HitSums sums_of(const Hit& hit) {
    const auto momentum = [](const Hit::Side& side, const physics::Vec2d& velocity) {
        return physics::Vec2d(side.mass_kg * velocity);
    };
    const auto change = [](double after, double before, double scale) {
        return scale > 0.0 ? (after - before) / scale : 0.0;
    };
    HitSums sums;
    const physics::Vec2d own = momentum(hit.own, hit.own.velocity_before_mps);
    const physics::Vec2d other = momentum(hit.other, hit.other.velocity_before_mps);
    sums.momentum_before_ns = own + other;
    sums.momentum_after_ns = momentum(hit.own, hit.own.velocity_after_mps) +
                             momentum(hit.other, hit.other.velocity_after_mps);
    sums.energy_before_j = kinetic_energy_j(hit.own, hit.own.velocity_before_mps) +
                           kinetic_energy_j(hit.other, hit.other.velocity_before_mps);
    sums.energy_after_j = kinetic_energy_j(hit.own, hit.own.velocity_after_mps) +
                          kinetic_energy_j(hit.other, hit.other.velocity_after_mps);
    sums.relative_energy_change =
        change(sums.energy_after_j, sums.energy_before_j, sums.energy_before_j);
    sums.relative_momentum_change = change(
        (sums.momentum_after_ns - sums.momentum_before_ns).norm(), 0.0, own.norm() + other.norm());
    return sums;
}

std::string player_name(const client::View& view, std::uint16_t player_id) {
    if (player_id == view.own_player_id) return "You";
    const auto found =
        std::ranges::find(view.players, player_id, &replication::PlayerInfo::player_id);
    if (found != view.players.end() && !found->name.empty()) return found->name;
    return "Player " + std::to_string(player_id);
}

std::string other_name(const client::View& view, const Hit& hit) {
    if (hit.other.player_id != 0) return player_name(view, hit.other.player_id);
    const auto ball = std::ranges::find(view.balls, hit.other.ball, &client::BallView::id);
    if (ball == view.balls.end()) return "AI ball";
    return behaviour_name(ball->behaviour);
}

std::string explain(const Hit& hit) {
    const double own_kg = hit.own.mass_kg, other_kg = hit.other.mass_kg;
    if (!(own_kg > 0.0) || !(other_kg > 0.0)) return "";
    if (hit.contacts_at_once > 1) {
        return "One of " + std::to_string(hit.contacts_at_once) +
               " contacts of one instant, resolved together so that no order decides: what you two "
               "did not keep between you, the others have.";
    }
    const physics::Vec2d towards = -hit.normal;
    const double own_mps = hit.own.velocity_before_mps.dot(towards);
    const double other_mps = hit.other.velocity_before_mps.dot(towards);
    const double closing_mps = own_mps - other_mps;
    const double given = 2.0 * own_kg / (own_kg + other_kg);
    const double taken = 2.0 * other_kg / (own_kg + other_kg);
    const std::string start = mass_clause(own_kg / other_kg);

    constexpr double kAtRest = 0.03;
    if (std::abs(other_mps) < kAtRest * std::abs(own_mps)) {
        const double energy = own_kg * other_kg * 4.0 / ((own_kg + other_kg) * (own_kg + other_kg));
        return start + "it left with " + percent(given) +
               " of your speed along the line of centres, and " + percent(energy) +
               " of the energy you brought along it.";
    }
    if (std::abs(own_mps) < kAtRest * std::abs(other_mps)) {
        return start + "you left with " + percent(taken) +
               " of its speed along the line of centres. You were the one being hit.";
    }
    if (std::abs(own_kg / other_kg - 1.0) < kNearlyEqual) {
        return start + "you closed at " + fixed(closing_mps, 2) +
               " m/s along the line of centres, and simply swapped your speeds along it.";
    }
    return start + "you closed at " + fixed(closing_mps, 2) +
           " m/s along the line of centres and parted at the same rate. Your speed along it "
           "changed by " +
           percent(taken) + " of that, the other's by " + percent(given) + ".";
}

std::string knock_off_line(const client::View& view, const replication::KnockOff& knock_off,
                           const std::string& victim) {
    std::vector<std::string> scorers, assists;
    int coins = 0;
    for (const auto& share : knock_off.shares) {
        (share.assist ? assists : scorers).push_back(player_name(view, share.player_id));
        if (share.player_id == view.own_player_id) coins += share.coins;
    }
    std::string line;
    if (scorers.empty() && assists.empty()) {
        line = victim + " fell";
    } else {
        line = joined(scorers.empty() ? assists : scorers) + " knocked off " +
               (victim == "You" ? "you" : victim);
        if (!assists.empty() && !scorers.empty()) line += ", helped by " + joined(assists);
    }
    if (coins > 0) line += "  +" + coins_text(coins);
    return line;
}

}  // namespace fts::sdl
