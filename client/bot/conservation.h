// Whether a hit kept momentum and kinetic energy, from nothing but what the server reported of it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/replication/messages.h"

namespace fts::bot {

struct ConservationError {
    double momentum = 0.0;  // |change of p1 + p2| / (|p1| + |p2|) before
    double energy = 0.0;    // |change of E1 + E2| / (E1 + E2) before
};

// Empty when the report holds values that are not finite or a mass that is not above 0, and for a
// contact that was resolved together with others: those two alone keep nothing.
std::optional<ConservationError> conservation_error(const replication::CollisionReport& hit);

// A line of comma-separated values for each hit; every double with all its digits.
std::string_view hits_csv_heading();
std::string hits_csv_line(int bot, const replication::CollisionReport& hit);

}  // namespace fts::bot
