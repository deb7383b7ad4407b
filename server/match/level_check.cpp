#include "server/match/level_check.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <sstream>
#include <string_view>
#include <variant>

#include "common/replication/utf8.h"
#include "server/match/match_impl.h"

namespace fts::server {
namespace {

using Fault = std::optional<std::string>;

static_assert(kMaxLevelFieldCoins <= static_cast<int>(kMaxFieldCoins));

std::string shown(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

struct Range {
    double low = 0.0, high = 0.0;
    std::string_view noun;
};
constexpr Range kPlatformSizeM{2.0, 200.0, "a size in metres"};
constexpr Range kPlatformRadiusM{2.0, 100.0, "a radius in metres"};
constexpr Range kInnerRadiusM{0.5, 98.0, "a radius in metres"};
constexpr Range kTimeLimitS{10.0, 3600.0, "a time in seconds"};
constexpr Range kBallRadiusM{0.1, 3.0, "a radius in metres"};
constexpr Range kBallMassKg{0.05, 100.0, "a mass"};
constexpr Range kThrustN{0.0, 1000.0, "a thrust in newtons"};
constexpr Range kTopSpeedMps{0.1, 30.0, "a speed in metres per second"};

// Written so that a value that is not a number is outside.
Fault outside(const std::string& field, double value, const Range& range) {
    if (value >= range.low && value <= range.high) return std::nullopt;
    return field + " is " + shown(value) + "; give " + std::string(range.noun) + " between " +
           shown(range.low) + " and " + shown(range.high);
}

Fault text_fault(const std::string& field, const std::string& text, std::size_t max_bytes) {
    if (text.empty()) return field + " is empty; give a line of text";
    if (text.size() > max_bytes)
        return field + " is " + std::to_string(text.size()) + " bytes long; give at most " +
               std::to_string(max_bytes);
    if (!replication::is_utf8(text)) return field + " is not UTF-8; save the file as UTF-8";
    const bool has_control = std::any_of(text.begin(), text.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    });
    if (has_control) return field + " holds a control character; give plain text on one line";
    return std::nullopt;
}

Fault platform_fault(const physics::Disc& disc) {
    return outside("platform.disc.radius_m", disc.radius_m, kPlatformRadiusM);
}

Fault platform_fault(const physics::Rectangle& rectangle) {
    const physics::Vec2d size_m = rectangle.half_extents_m * 2.0;
    if (auto fault = outside("platform.rectangle.width_m", size_m.x(), kPlatformSizeM))
        return fault;
    return outside("platform.rectangle.height_m", size_m.y(), kPlatformSizeM);
}

Fault platform_fault(const physics::Ring& ring) {
    const std::string inner = "platform.ring.inner_radius_m";
    if (auto fault = outside("platform.ring.outer_radius_m", ring.outer_radius_m, kPlatformRadiusM))
        return fault;
    if (auto fault = outside(inner, ring.inner_radius_m, kInnerRadiusM)) return fault;
    constexpr double kNarrowestBandM = 2.0;
    if (ring.outer_radius_m - ring.inner_radius_m >= kNarrowestBandM) return std::nullopt;
    return inner + " is " + shown(ring.inner_radius_m) + "; give at most " +
           shown(ring.outer_radius_m - kNarrowestBandM) +
           ", 2 less than outer_radius_m, so that there is a band to stand on";
}

double area_m2(const physics::Platform& platform) {
    if (const auto* disc = std::get_if<physics::Disc>(&platform))
        return std::numbers::pi * disc->radius_m * disc->radius_m;
    if (const auto* rectangle = std::get_if<physics::Rectangle>(&platform))
        return 4.0 * rectangle->half_extents_m.x() * rectangle->half_extents_m.y();
    const auto& ring = std::get<physics::Ring>(platform);
    return std::numbers::pi *
           (ring.outer_radius_m * ring.outer_radius_m - ring.inner_radius_m * ring.inner_radius_m);
}

Fault group_fault(const std::string& prefix, const game::AiGroup& group) {
    if (group.count < 1 || group.count > kMaxAiBalls)
        return prefix + "count is " + std::to_string(group.count) + "; give a number from 1 to " +
               std::to_string(kMaxAiBalls);
    if (auto fault = outside(prefix + "radius_m", group.radius_m, kBallRadiusM)) return fault;
    if (auto fault = outside(prefix + "mass_kg", group.mass_kg, kBallMassKg)) return fault;
    if (auto fault = outside(prefix + "thrust_n", group.thrust_n, kThrustN)) return fault;
    return outside(prefix + "top_speed_mps", group.top_speed_mps, kTopSpeedMps);
}

Fault ai_fault(const game::Level& level) {
    if (level.ai.empty())
        return "ai is empty; give at least one group, or there is nobody to knock off";
    int count = 0;
    double covered_m2 = 0.0;
    for (std::size_t i = 0; i < level.ai.size(); ++i) {
        const game::AiGroup& group = level.ai[i];
        if (auto fault = group_fault("ai[" + std::to_string(i) + "].", group)) return fault;
        count += group.count;
        covered_m2 += group.count * std::numbers::pi * group.radius_m * group.radius_m;
        if (count > kMaxAiBalls)
            return "ai counts " + std::to_string(count) + " balls; give at most " +
                   std::to_string(kMaxAiBalls) + " in all groups together";
    }
    const double cover = covered_m2 / area_m2(level.platform);
    if (cover <= kMaxCover) return std::nullopt;
    return "ai covers " + shown(cover * 100.0) +
           " % of the platform; give fewer or smaller balls, or " +
           "a larger platform, for at most " + shown(kMaxCover * 100.0) + " %";
}

}  // namespace

std::optional<std::string> fault_of(const game::Level& level) {
    if (level.number < 1 || level.number > 999)
        return "number is " + std::to_string(level.number) + "; give a number from 1 to 999";
    if (auto fault = text_fault("name", level.name, kMaxLevelNameBytes)) return fault;
    if (auto fault = text_fault("hint", level.hint, kMaxLevelHintBytes)) return fault;
    if (auto fault =
            std::visit([](const auto& shape) { return platform_fault(shape); }, level.platform))
        return fault;
    if (level.field_coins < 0 || level.field_coins > kMaxLevelFieldCoins)
        return "field_coins is " + std::to_string(level.field_coins) +
               "; give a number from 0 to " + std::to_string(kMaxLevelFieldCoins);
    if (auto fault = outside("time_limit_s", level.time_limit_s, kTimeLimitS)) return fault;
    return ai_fault(level);
}

}  // namespace fts::server
