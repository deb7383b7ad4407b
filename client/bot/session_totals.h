// Adds what two sessions of one bot counted.
#pragma once

#include "client/core/session.h"

namespace fts::bot {

// Counts are summed; the link's times and loss are those of `newest`.
client::SessionStats sum_of(const client::SessionStats& earlier,
                            const client::SessionStats& newest);

}  // namespace fts::bot
