#include "client/core/view.h"

#include <algorithm>

namespace fts::client {

const replication::PlayerInfo* View::own_player() const {
    const auto own = std::ranges::find(players, own_player_id, &replication::PlayerInfo::player_id);
    return own == players.end() ? nullptr : &*own;
}

}  // namespace fts::client
