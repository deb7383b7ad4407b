#include "server/lab/replication_study.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <deque>
#include <map>
#include <memory>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "common/physics/splitmix.h"
#include "common/replication/snapshot_codec.h"
#include "server/lab/snapshot_coders.h"

namespace fts::lab {
namespace {

// Tells the luck of the link from that of the traces.
constexpr std::uint64_t kLinkStream = 6;
constexpr replication::Tick kGreatestAge = replication::kMaxPredictedTicks;
// So many snapshots in a row may be lost before a client is sent one of nothing.
constexpr std::size_t kSparedSnapshots = 61;
// Beyond the delay: sent before any are measured, so that every client has acknowledged something.
constexpr std::size_t kFirstExchange = 38;
constexpr std::uint64_t kDamagedEvery = 8;

// From a snapshot to the first that can be sent against it, in snapshots.
std::size_t delay_in_snapshots(double delay_ms, replication::Tick snapshot_ticks) {
    const double ticks = delay_ms / 1000.0 * kTraceTickRateHz;
    return static_cast<std::size_t>(std::max(1.0, std::ceil(ticks / snapshot_ticks - 1e-9)));
}

// How snapshots follow on each other, and how long a server needs them.
struct Pace {
    explicit Pace(const ReplicationRequest& request)
        : snapshot_ticks(
              static_cast<replication::Tick>(std::lround(kTraceTickRateHz / request.rate_hz))),
          delay(delay_in_snapshots(request.delay_ms, snapshot_ticks)) {}

    double rate_hz() const { return static_cast<double>(kTraceTickRateHz) / snapshot_ticks; }
    // With the newest.
    std::size_t kept() const { return std::min(delay + kSparedSnapshots, greatest_age()) + 1; }
    std::size_t unmeasured() const {
        return static_cast<std::size_t>(std::ceil(kUnmeasuredS * rate_hz()));
    }
    // Why no snapshot could be acknowledged in time to be a baseline; empty: they can.
    std::string refusal(const ReplicationRequest& request) const {
        if (delay <= greatest_age()) return {};
        const double most_ms = 1000.0 * static_cast<double>(greatest_age()) / rate_hz();
        return fmt::format(
            "--delay-ms {:g} is too long for --rate {:g}: no baseline may be older than {} ticks; "
            "give a --delay-ms of at most {:g}, or a greater --rate",
            request.delay_ms, request.rate_hz, kGreatestAge, std::floor(most_ms));
    }

    std::size_t greatest_age() const { return kGreatestAge / snapshot_ticks; }

    replication::Tick snapshot_ticks;
    std::size_t delay;  // in snapshots
};

// Of this thread: what else the machine does meanwhile is no cost of ours.
double cpu_us() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

// What one client has acknowledged, as the server knows it.
struct Client {
    struct Acknowledgement {
        double arrives_s;
        replication::Tick tick;
    };
    std::deque<Acknowledgement> under_way;
    replication::Tick acknowledged = 0;  // 0: none

    void hear_until(double now_s) {
        while (!under_way.empty() && under_way.front().arrives_s <= now_s + 1e-9) {
            acknowledged = under_way.front().tick;
            under_way.pop_front();
        }
    }
};

struct Encoded {
    std::vector<Datagram> payloads;
    std::size_t bytes = 0;
    std::size_t datagrams = 0;
};

std::size_t datagrams_of(std::size_t bytes) {
    return std::max<std::size_t>(1, (bytes + kMaxDatagramBytes - 1) / kMaxDatagramBytes);
}

// One coder, its clients and its sums.
class Exchange {
  public:
    Exchange(std::unique_ptr<SnapshotCoder> coder, const ReplicationRequest& request)
        : coder_(std::move(coder)),
          request_(request),
          random_(request.seed ^ kLinkStream),
          clients_(kStudyClients) {
        row_.coder = coder_->name();
        row_.snapped = coder_->wants_lattice();
    }

    bool wants_lattice() const { return coder_->wants_lattice(); }
    // The newest of `history` is sent to all.
    void send(const std::vector<TraceSnapshot>& kept, bool measured);
    CoderRow row() const;

  private:
    void damage(const TraceSnapshot* baseline, std::vector<Datagram> payloads);
    Encoded encoded(std::span<const TraceSnapshot> since_baseline, bool measured);
    void tell(Client& client, const Encoded& sent, replication::Tick tick, double now_s,
              bool measured);
    bool lost() { return random_.uniform() < request_.loss; }

    std::unique_ptr<SnapshotCoder> coder_;
    ReplicationRequest request_;
    physics::SplitMix random_;
    std::vector<Client> clients_;
    CoderRow row_;  // sums, until `row`
    std::size_t snapshots_ = 0, sent_ = 0;
};

Encoded Exchange::encoded(std::span<const TraceSnapshot> since_baseline, bool measured) {
    Encoded result;
    const double start_us = cpu_us();
    result.payloads = coder_->encode(since_baseline);
    const double encode_us = cpu_us() - start_us;
    for (const Datagram& payload : result.payloads) {
        result.bytes += payload.size();
        result.datagrams += datagrams_of(payload.size());
    }
    const TraceSnapshot* const baseline =
        since_baseline.size() > 1 ? &since_baseline.front() : nullptr;
    const double decode_start_us = cpu_us();
    const auto decoded = coder_->decode(baseline, result.payloads);
    const double decode_us = cpu_us() - decode_start_us;
    row_.wrong += decoded && *decoded == coder_->shown(since_baseline.back()) ? 0U : 1U;
    if (!measured) return result;
    row_.encode_us += encode_us;
    row_.decode_us += decode_us;
    row_.baselines += 1.0;
    if (row_.decoded++ % kDamagedEvery == 0) damage(baseline, result.payloads);
    return result;
}

// Every other one is cut short, the others have a bit turned.
void Exchange::damage(const TraceSnapshot* baseline, std::vector<Datagram> payloads) {
    Datagram& payload = payloads[random_.below(payloads.size())];
    if (row_.damaged++ % 2 == 0) {
        payload.resize(random_.below(payload.size()));
    } else {
        std::uint8_t& byte = payload[random_.below(payload.size())];
        byte = static_cast<std::uint8_t>(byte ^ (1U << random_.below(8)));
    }
    row_.damaged_shown += coder_->decode(baseline, payloads) ? 1U : 0U;
}

void Exchange::tell(Client& client, const Encoded& sent, replication::Tick tick, double now_s,
                    bool measured) {
    bool whole = true;
    for (std::size_t i = 0; i < sent.datagrams; ++i) whole = !lost() && whole;
    if (whole && !lost()) {
        client.under_way.push_back({now_s + request_.delay_ms / 1000.0, tick});
    }
    if (!measured) return;
    ++sent_;
    row_.bytes_per_snapshot += static_cast<double>(sent.bytes);
    row_.datagrams += static_cast<double>(sent.datagrams);
    row_.usable += whole ? 1.0 : 0.0;
    row_.keyframes += client.acknowledged == 0 ? 1U : 0U;
}

void Exchange::send(const std::vector<TraceSnapshot>& kept, bool measured) {
    const replication::Tick tick = kept.back().tick;
    const double now_s = static_cast<double>(tick) / kTraceTickRateHz;
    std::map<replication::Tick, Encoded> by_baseline;
    for (Client& client : clients_) {
        client.hear_until(now_s);
        const replication::Tick oldest =
            std::max(kept.front().tick, tick > kGreatestAge ? tick - kGreatestAge : 1);
        if (client.acknowledged < oldest) client.acknowledged = 0;
        const auto at = by_baseline.find(client.acknowledged);
        if (at == by_baseline.end()) {
            const auto baseline =
                client.acknowledged == 0
                    ? kept.end() - 1
                    : std::find_if(kept.begin(), kept.end(), [&](const TraceSnapshot& snapshot) {
                          return snapshot.tick == client.acknowledged;
                      });
            const Encoded encoded_now = encoded({baseline, kept.end()}, measured);
            tell(client, encoded_now, tick, now_s, measured);
            by_baseline.emplace(client.acknowledged, encoded_now);
        } else {
            tell(client, at->second, tick, now_s, measured);
        }
    }
    if (measured) ++snapshots_;
}

CoderRow Exchange::row() const {
    CoderRow row = row_;
    const double sent = std::max(1.0, static_cast<double>(sent_));
    row.bytes_per_snapshot /= sent;
    row.datagrams /= sent;
    row.usable /= sent;
    row.bits_per_ball = 8.0 * row.bytes_per_snapshot / static_cast<double>(request_.count);
    row.decode_us /= std::max(1.0, static_cast<double>(row_.decoded));
    row.encode_us /= sent;
    row.baselines /= std::max(1.0, static_cast<double>(snapshots_));
    return row;
}

}  // namespace

ReplicationStudy study_replication(
    const ReplicationRequest& request, const std::function<bool()>& go_on,
    const std::function<void(std::size_t done, std::size_t of)>& progress) {
    ReplicationStudy study;
    const Pace pace(request);
    study.error = pace.refusal(request);
    if (!study.error.empty()) return study;
    const auto trace = [&](bool snaps) {
        return ArenaTrace::make(request.count, request.seed, pace.snapshot_ticks, snaps,
                                study.error);
    };
    auto free = trace(false), snapped = trace(true);
    if (!free || !snapped) return study;
    std::vector<Exchange> exchanges;
    for (auto& coder : all_coders(pace.snapshot_ticks)) {
        exchanges.emplace_back(std::move(coder), request);
    }
    study.of = static_cast<std::size_t>(std::floor(request.seconds * pace.rate_hz()));
    const std::size_t unmeasured = pace.unmeasured();
    std::vector<TraceSnapshot> free_history, snapped_history;
    double squares = 0.0;
    while (study.done < study.of && go_on()) {
        progress(study.done, study.of);
        for (auto [moving, history] :
             {std::pair{&*free, &free_history}, {&*snapped, &snapped_history}}) {
            history->push_back(moving->next());
            if (history->size() > pace.kept()) history->erase(history->begin());
        }
        const bool measured = study.done >= unmeasured;
        if (study.done + pace.delay + kFirstExchange >= unmeasured) {
            for (Exchange& exchange : exchanges) {
                exchange.send(exchange.wants_lattice() ? snapped_history : free_history, measured);
            }
        }
        if (measured) squares += free->rms_speed_mps() * free->rms_speed_mps();
        ++study.done;
    }
    for (const Exchange& exchange : exchanges) study.rows.push_back(exchange.row());
    if (study.done > unmeasured) {
        study.rms_speed_mps = std::sqrt(squares / static_cast<double>(study.done - unmeasured));
    }
    if (study.done > 0) {
        study.snapping_energy_per_s =
            snapped->energy_added_by_snapping() * pace.rate_hz() / static_cast<double>(study.done);
    }
    return study;
}

}  // namespace fts::lab
