#include "client/bot/tally.h"

#include <algorithm>
#include <array>

namespace fts::bot {
namespace {

using Tallies = std::span<const Tally>;

template <auto Member>
double sum(Tallies tallies) {
    double total = 0.0;
    for (const Tally& tally : tallies) total += static_cast<double>(tally.*Member);
    return total;
}

template <auto Member>
double session_sum(Tallies tallies) {
    double total = 0.0;
    for (const Tally& tally : tallies) total += static_cast<double>(tally.session.*Member);
    return total;
}

template <auto Member>
double link_sum(Tallies tallies) {
    double total = 0.0;
    for (const Tally& tally : tallies) total += static_cast<double>(tally.session.link.*Member);
    return total;
}

template <auto Member>
double greatest(Tallies tallies) {
    double most = 0.0;
    for (const Tally& tally : tallies) most = std::max(most, static_cast<double>(tally.*Member));
    return most;
}

double share(double part, double rest) {
    return part > 0.0 ? part / (part + rest) : 0.0;
}

using Stats = client::SessionStats;

double lost_snapshots(Tallies tallies) {
    return std::max(0.0, session_sum<&Stats::snapshots_missed>(tallies) -
                             session_sum<&Stats::snapshots_late>(tallies));
}

double loss(Tallies tallies) {
    const double late = session_sum<&Stats::snapshots_late>(tallies);
    return share(lost_snapshots(tallies), session_sum<&Stats::snapshots_received>(tallies) + late);
}

double starved(Tallies tallies) {
    const double starved_frames = session_sum<&Stats::frames_starved>(tallies);
    return share(starved_frames, session_sum<&Stats::frames>(tallies) - starved_frames);
}

RttHistogram all_rtt(Tallies tallies) {
    RttHistogram all;
    for (const Tally& tally : tallies) all.add(tally.rtt);
    return all;
}

double rtt_mean_ms(Tallies tallies) {
    return all_rtt(tallies).mean_s() * 1e3;
}
double rtt_p99_ms(Tallies tallies) {
    return all_rtt(tallies).quantile_s(0.99) * 1e3;
}

template <auto SumS>
double mean_ms(Tallies tallies) {
    const double samples = sum<&Tally::delay_samples>(tallies);
    return samples > 0.0 ? sum<SumS>(tallies) / samples * 1e3 : 0.0;
}

constexpr auto kMetrics = std::to_array<Metric>({
    {"joined", "joined", "bots that got in", 0, 1.0, sum<&Tally::joined>},
    {"snapshots", "snapshots", "whole snapshots received", 0, 1.0,
     session_sum<&Stats::snapshots_received>},
    {"missed", "missed", "snapshots that never came in time", 0, 1.0,
     session_sum<&Stats::snapshots_missed>},
    {"late", "late", "of the missed, those that came after a newer one", 0, 1.0,
     session_sum<&Stats::snapshots_late>},
    {"sketched", "sketched", "snapshots of which some balls were told and the rest guessed", 0, 1.0,
     session_sum<&Stats::snapshots_sketched>},
    {"malformed", "malformed", "snapshots and messages that made no sense or led elsewhere", 0, 1.0,
     [](Tallies t) {
         return session_sum<&Stats::snapshots_malformed>(t) +
                session_sum<&Stats::snapshots_unlike>(t) +
                session_sum<&Stats::messages_malformed>(t);
     }},
    {"loss", "loss %", "share of snapshots that never came at all, 0 to 1", 1, 100.0, loss},
    {"rtt_mean_ms", "RTT ms", "mean of the smoothed round-trip time", 1, 1.0, rtt_mean_ms},
    {"rtt_p99_ms", "p99 ms", "99th percentile of the smoothed round-trip time", 1, 1.0, rtt_p99_ms},
    {"delay_mean_ms", "delay ms", "mean interpolation delay", 1, 1.0, mean_ms<&Tally::delay_sum_s>},
    {"frames", "frames", "views made while playing", 0, 1.0, session_sum<&Stats::frames>},
    {"starved", "starved %", "share of frames with no snapshot to draw towards, 0 to 1", 2, 100.0,
     starved},
    {"clock_steps", "steps", "times the moment drawn stepped ahead", 0, 1.0,
     session_sum<&Stats::clock_steps>},
    {"inputs", "inputs", "inputs sent, each once", 0, 1.0, session_sum<&Stats::inputs_sent>},
    {"input_slack_ms", "slack ms", "mean of the least time that inputs waited for their tick", 1,
     1.0, mean_ms<&Tally::input_slack_sum_s>},
    {"inputs_late", "in late", "snapshots that say that a tick found no input", 0, 1.0,
     session_sum<&Stats::inputs_late>},
    {"inputs_given_up", "given up", "inputs that were never acknowledged", 0, 1.0,
     session_sum<&Stats::inputs_given_up>},
    {"packets_sent", "sent", "datagrams sent", 0, 1.0, link_sum<&net::LinkStats::packets_sent>},
    {"packets_received", "received", "datagrams received", 0, 1.0,
     link_sum<&net::LinkStats::packets_received>},
    {"bytes_sent", "bytes out", "bytes sent", 0, 1.0, link_sum<&net::LinkStats::bytes_sent>},
    {"bytes_received", "bytes in", "bytes received", 0, 1.0,
     link_sum<&net::LinkStats::bytes_received>},
    {"knock_offs", "knock-offs", "as the roster says", 0, 1.0, sum<&Tally::knock_offs>},
    {"assists", "assists", "as the roster says", 0, 1.0, sum<&Tally::assists>},
    {"falls", "falls", "as the roster says", 0, 1.0, sum<&Tally::falls>},
    {"coins", "coins", "held when last heard of", 0, 1.0, sum<&Tally::coins>},
    {"coins_spent", "spent", "coins paid for upgrades in this run", 0, 1.0,
     sum<&Tally::coins_spent>},
    {"purchases", "bought", "upgrades bought in this run", 0, 1.0, sum<&Tally::purchases>},
    {"purchases_refused", "refused", "purchases that the server refused", 0, 1.0,
     sum<&Tally::purchases_refused>},
    {"levels_started", "started", "level starts seen; of several bots, the most", 0, 1.0,
     greatest<&Tally::levels_started>},
    {"levels_cleared", "cleared", "levels cleared; of several bots, the most", 0, 1.0,
     greatest<&Tally::levels_cleared>},
    {"levels_lost", "lost", "levels lost or out of time; of several bots, the most", 0, 1.0,
     greatest<&Tally::levels_lost>},
    {"highest_level", "level", "the highest level seen", 0, 1.0, greatest<&Tally::highest_level>},
    {"chat_lines", "chat", "lines of chat received", 0, 1.0, sum<&Tally::chat_lines>},
    {"hits", "hits", "hits of own balls, as reported by the server", 0, 1.0, sum<&Tally::hits>},
    {"hits_malformed", "bad hits", "reported hits that are not finite", 0, 1.0,
     sum<&Tally::hits_malformed>},
    {"worst_momentum_error", "dp/p", "greatest relative change of momentum in a hit", -1, 1.0,
     greatest<&Tally::worst_momentum_error>},
    {"worst_energy_error", "dE/E", "greatest relative change of kinetic energy in a hit", -1, 1.0,
     greatest<&Tally::worst_energy_error>},
});

}  // namespace

std::span<const Metric> metrics() {
    return kMetrics;
}

const Metric* metric_named(std::string_view name) {
    const auto found = std::ranges::find(kMetrics, name, &Metric::name);
    return found == kMetrics.end() ? nullptr : &*found;
}

}  // namespace fts::bot
