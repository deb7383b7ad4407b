#include "server/match/event_log.h"

#include <algorithm>
#include <tuple>

namespace fts::server {
namespace {

using replication::Tick;

template <typename Event>
void forget(std::deque<Event>& events, Tick before) {
    while (!events.empty() && events.front().tick < before) events.pop_front();
}

template <typename Event>
std::vector<Event> between_ticks(const std::deque<Event>& events, Tick after, Tick up_to) {
    return {std::ranges::upper_bound(events, after, {}, &Event::tick),
            std::ranges::upper_bound(events, up_to, {}, &Event::tick)};
}

}  // namespace

void EventLog::begin(Tick tick) {
    begin_ = tick;
    controls_.clear();
    changes_.clear();
}

void EventLog::forget_before(Tick tick) {
    forget(controls_, tick);
    forget(changes_, tick);
    begin_ = std::max(begin_, tick);
}

replication::ArenaEvents EventLog::between(Tick after, Tick up_to) const {
    replication::ArenaEvents events{between_ticks(controls_, after, up_to),
                                    between_ticks(changes_, after, up_to)};
    std::ranges::sort(events.controls, [](const auto& a, const auto& b) {
        return std::tie(a.ball, a.tick) < std::tie(b.ball, b.tick);
    });
    return events;
}

}  // namespace fts::server
