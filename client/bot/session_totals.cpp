#include "client/bot/session_totals.h"

#include <array>

namespace fts::bot {

client::SessionStats sum_of(const client::SessionStats& earlier,
                            const client::SessionStats& newest) {
    using Stats = client::SessionStats;
    using Link = net::LinkStats;
    constexpr auto kCounts = std::to_array({
        &Stats::snapshots_received,
        &Stats::snapshots_sketched,
        &Stats::snapshots_missed,
        &Stats::snapshots_late,
        &Stats::snapshots_malformed,
        &Stats::snapshots_unlike,
        &Stats::messages_malformed,
        &Stats::messages_unsent,
        &Stats::frames,
        &Stats::frames_starved,
        &Stats::inputs_sent,
        &Stats::inputs_given_up,
        &Stats::inputs_skipped,
        &Stats::inputs_late,
        &Stats::notices_dropped,
        &Stats::hits_dropped,
        &Stats::delay_limited,
        &Stats::clock_steps,
    });
    constexpr auto kLinkCounts = std::to_array(
        {&Link::packets_sent, &Link::packets_received, &Link::bytes_sent, &Link::bytes_received});
    static_assert(sizeof(Stats) == kCounts.size() * sizeof(std::uint64_t) + sizeof(Link),
                  "a new count belongs into the list");
    Stats sum = newest;
    for (const auto count : kCounts) sum.*count += earlier.*count;
    for (const auto count : kLinkCounts) sum.link.*count += earlier.link.*count;
    return sum;
}

}  // namespace fts::bot
