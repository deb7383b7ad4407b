// Between levels: six upgrades for coins, each a physical quantity.
#pragma once

#include <optional>
#include <string>

#include "client/core/view.h"
#include "client/sdl/canvas.h"

namespace fts::sdl {

struct ShopState {
    std::string message;  // of the last purchase
    bool good = true;
    double open_since_s = -1.0;  // negative: closed
};
struct ShopChoice {
    std::optional<game::Stat> buy;  // an upgrade that can be bought
    bool ready = false;
};

// `slot` is the upgrade picked by key or gamepad, 0 to 5. Where it cannot be bought, the message
// says why.
ShopChoice draw_shop(Canvas& canvas, const client::View& view, ShopState& state,
                     std::optional<int> slot);

// Why this upgrade cannot be bought now; empty when it can.
std::string obstacle(const client::View& view, game::Stat stat);
std::string outcome_words(replication::PurchaseOutcome outcome);

}  // namespace fts::sdl
