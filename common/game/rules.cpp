#include "common/game/rules.h"

#include <cassert>

namespace fts::game {

int knock_off_coins(int level) {
    assert(level >= 1);
    const int tenths = 40 + 4 * (level - 1);
    return (tenths + 5) / 10;
}

}  // namespace fts::game
