// client-cost [ROUNDS]: what one client costs a server per tick beside the simulation: an input
// that is received, opened and decoded, a snapshot of 200 bytes that is wrapped, sealed and sent.
// CPU time of the server's end alone, over loopback sockets, with one datagram a call of the system
// and with many. Rounds of both take turns; what is printed is the median round.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "common/net/connection.h"
#include "common/net/udp_transport.h"
#include "common/replication/wire.h"

namespace {

using namespace fts;
using Received = std::span<const std::uint8_t>;

constexpr int kClients = 64;
constexpr int kTicksPerRound = 60;
constexpr std::size_t kSnapshotBytes = 200;
// An input packet repeats what is not acknowledged yet: the ticks of a round trip of 50 ms.
constexpr std::size_t kInputsPerPacket = 3;
constexpr double kTickS = 1.0 / 60.0;

enum Stage : std::size_t { kReceive, kWrite, kSend, kUpkeep, kStages };
constexpr std::array<const char*, kStages> kStageNames{"receive, open, decode", "wrap, seal",
                                                       "give to the system", "upkeep"};

double cpu_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::unique_ptr<net::UdpTransport> open_socket(net::UdpCalls calls) {
    std::string error;
    auto socket = net::UdpTransport::open("", 0, error, calls);
    if (socket) return socket;
    std::fprintf(stderr, "client-cost: %s\n", error.c_str());
    std::exit(1);
}

class Table {
  public:
    explicit Table(net::UdpCalls calls) : socket_(open_socket(calls)) {
        const auto address =
            net::resolve("127.0.0.1:" + std::to_string(socket_->local_port()), 0).address;
        for (int i = 0; i < kClients; ++i) {
            Client client;
            client.socket = open_socket(net::UdpCalls::kBatched);
            client.dialer = std::make_unique<net::Dialer>(
                net::DialerConfig{.key = net::generate_key_pair(), .server = *address},
                *client.socket);
            clients_.push_back(std::move(client));
        }
        while (ids_.size() < clients_.size()) play_tick();
    }

    // Microseconds of the server's CPU per client and tick.
    std::array<double, kStages> play_round() {
        spent_s_ = {};
        for (int i = 0; i < kTicksPerRound; ++i) play_tick();
        auto cost_us = spent_s_;
        for (double& cost : cost_us) cost *= 1e6 / (kClients * kTicksPerRound);
        return cost_us;
    }
    net::UdpStats stats() const { return socket_->stats(); }

  private:
    struct Client {
        std::unique_ptr<net::UdpTransport> socket;
        std::unique_ptr<net::Dialer> dialer;
        std::uint32_t sequence = 0;
    };

    void play_tick() {
        now_s_ += kTickS;
        for (Client& client : clients_) play_client(client);
        measured(kReceive, [this] { receive(); });
        measured(kWrite, [this] { write(); });
        measured(kSend, [this] { socket_->flush(); });
        measured(kUpkeep, [this] { listener_.update(now_s_); });
        socket_->flush();
    }
    void play_client(Client& client) {
        client.socket->poll(now_s_, [&](const net::Address& from, Received bytes) {
            client.dialer->receive(from, bytes, now_s_);
        });
        client.dialer->drain_events();
        client.dialer->update(now_s_);
        if (client.dialer->state() == net::Dialer::State::kConnected) {
            const replication::InputPacket packet{
                .acked_snapshot_tick = ++client.sequence,
                .first_sequence = client.sequence,
                .inputs = std::vector<game::InputCommand>(kInputsPerPacket)};
            client.dialer->send_unreliable(replication::encode(packet));
        }
        client.socket->flush();
    }
    void receive() {
        socket_->poll(now_s_, [this](const net::Address& from, Received bytes) {
            listener_.receive(from, bytes, now_s_);
        });
        for (const net::Event& event : listener_.drain_events()) {
            if (const auto* connected = std::get_if<net::Connected>(&event)) {
                ids_.push_back(connected->id);
            } else if (const auto* payload = std::get_if<net::UnreliablePayload>(&event)) {
                if (!replication::decode_input_packet(payload->bytes)) std::abort();
            }
        }
    }
    void write() {
        for (const net::ConnectionId id : ids_) {
            const auto packet = replication::encode(replication::SnapshotPacket{
                .acked_input_sequence = 1, .input_slack = 8, .part = snapshot_});
            listener_.send_unreliable(id, packet);
        }
    }
    template <typename Work>
    void measured(Stage stage, const Work& work) {
        const double began_s = cpu_s();
        work();
        spent_s_[stage] += cpu_s() - began_s;
    }

    std::unique_ptr<net::UdpTransport> socket_;
    net::Listener listener_{{.key = net::generate_key_pair()}, *socket_};
    std::vector<Client> clients_;
    std::vector<net::ConnectionId> ids_;
    const std::vector<std::uint8_t> snapshot_ = std::vector<std::uint8_t>(kSnapshotBytes, 0x5a);
    double now_s_ = 0.0;
    std::array<double, kStages> spent_s_{};
};

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

struct Measured {
    explicit Measured(net::UdpCalls calls) : table(calls) {}
    void play_round() {
        const auto cost_us = table.play_round();
        double sum_us = 0.0;
        for (std::size_t i = 0; i < kStages; ++i) {
            stage_us[i].push_back(cost_us[i]);
            sum_us += cost_us[i];
        }
        whole_us.push_back(sum_us);
    }
    Table table;
    std::array<std::vector<double>, kStages> stage_us;
    std::vector<double> whole_us;
};

double calls_per_datagram(const net::UdpStats& stats) {
    return static_cast<double>(stats.send_calls + stats.receive_calls) /
           static_cast<double>(stats.datagrams_sent + stats.datagrams_received);
}

}  // namespace

int main(int argc, char** argv) {
    const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 21;
    Measured one_by_one(net::UdpCalls::kOneByOne);
    Measured batched(net::UdpCalls::kBatched);
    for (int i = 0; i < rounds; ++i) {
        one_by_one.play_round();
        batched.play_round();
    }
    std::printf(
        "us of CPU per client and tick; %d clients, snapshots of %zu bytes, medians of %d\n",
        kClients, kSnapshotBytes, rounds);
    std::printf("%-24s %12s %12s\n", "", "one by one", "batched");
    for (std::size_t i = 0; i < kStages; ++i) {
        std::printf("%-24s %12.2f %12.2f\n", kStageNames[i], median(one_by_one.stage_us[i]),
                    median(batched.stage_us[i]));
    }
    const double before_us = median(one_by_one.whole_us), after_us = median(batched.whole_us);
    std::printf("%-24s %12.2f %12.2f   %.2f of it\n", "together", before_us, after_us,
                after_us / before_us);
    std::printf("%-24s %12.2f %12.2f\n", "calls per datagram",
                calls_per_datagram(one_by_one.table.stats()),
                calls_per_datagram(batched.table.stats()));
}
