#include "server/snapshot_courier.h"

#include <algorithm>
#include <deque>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "common/replication/lattice_world.h"
#include "common/replication/snapshot_receiver.h"
#include "common/replication/wire.h"
#include "server/limits.h"

namespace fts::server {
namespace {

using replication::BallState;
using replication::ControlEvent;
using replication::Snapshot;
using replication::Tick;

constexpr Tick kTicksASnapshot = 2;
constexpr std::uint16_t kMe = 9;
constexpr double kPlatformM = 80.0;

replication::Course course() {
    return replication::course_of(physics::Disc{kPlatformM},
                                  {.kind = physics::SolverKind::kDiscrete, .substeps = 1});
}

// An arena full of balls that steer about; the first is a player's.
class Crowd {
  public:
    Crowd(std::uint64_t seed, std::uint16_t balls, double turns_per_s)
        : rng_(seed), turns_per_s_(turns_per_s), world_(course(), balls_at_rest(balls)) {
        now_.tick = 100;
        now_.level = 1;
        now_.phase = game::Phase::kPlaying;
        now_.balls = world_.balls();
        log_.begin(now_.tick);
    }

    void step_to_next_snapshot() {
        do {
            ++now_.tick;
            for (const BallState& ball : now_.balls) {
                if (unit() < turns_per_s_ / game::kTickRateHz) steer(ball.id);
            }
            world_.advance(game::kTickDurationS);
        } while (now_.tick % kTicksASnapshot != 0);
        world_.snap();
        now_.balls = world_.balls();
        log_.forget_before(now_.tick - std::min<Tick>(now_.tick, 255));
        feed_.publish(now_);
    }
    // As if everything began anew.
    void begin_level() {
        ++now_.level;
        log_.begin(now_.tick + kTicksASnapshot);
    }

    SnapshotFeed& feed() { return feed_; }
    const EventLog& log() const { return log_; }
    const Snapshot& now() const { return now_; }

  private:
    std::vector<BallState> balls_at_rest(std::uint16_t count) {
        std::vector<BallState> balls;
        for (std::uint16_t id = 1; id <= count; ++id) {
            const double reach_m = 0.8 * kPlatformM * std::sqrt(unit()), angle = 6.28 * unit();
            BallState ball;
            ball.id = id;
            ball.x = replication::quantise(reach_m * std::cos(angle), replication::kPositionStepM);
            ball.y = replication::quantise(reach_m * std::sin(angle), replication::kPositionStepM);
            ball.radius = 2048;
            ball.mass = 65536;
            ball.handling = replication::quantised(
                {.acceleration_mps2 = 4.0, .drag_per_s = 1.0, .braking_per_s = 4.0});
            if (id == 1) {
                ball.kind = 1;
                ball.player_id = kMe;
            }
            balls.push_back(ball);
        }
        return balls;
    }
    void steer(std::uint16_t id) {
        ControlEvent event{.tick = now_.tick, .ball = id};
        event.thrust_x = static_cast<std::int8_t>(254.0 * (unit() - 0.5));
        event.thrust_y = static_cast<std::int8_t>(254.0 * (unit() - 0.5));
        log_.add(event);
        const auto slot = world_.slot_of(id);
        if (slot) {
            world_.steer(*slot, {.thrust_x = event.thrust_x, .thrust_y = event.thrust_y});
        }
    }
    double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(rng_); }

    std::mt19937_64 rng_;
    double turns_per_s_;
    replication::LatticeWorld world_;
    Snapshot now_;
    EventLog log_;
    SnapshotFeed feed_;
};

struct LinkConditions {
    double loss = 0.05;
    Tick flight_ticks = 4;
};

// One client, its courier, and the way between them and back.
class Client final : private SnapshotCourier::Link {
  public:
    Client(int bytes_per_s, std::uint64_t seed, LinkConditions conditions = {})
        : courier_(bytes_per_s), conditions_(conditions), rng_(seed) {}

    void serve(Crowd& arena) {
        now_ = arena.now().tick;
        while (!acks_.empty() && acks_.front().first <= now_) {
            courier_.acknowledge(acks_.front().second, now_);
            acks_.pop_front();
        }
        const auto sent = courier_.deliver(arena.feed(), arena.log(), kMe, *this);
        keyframes_begun += sent.keyframe_begun ? 1 : 0;
        keyframes_given_up += sent.keyframe_given_up ? 1 : 0;
        receive();
        if (!is_away && !is_lost()) {
            acks_.emplace_back(now_ + conditions_.flight_ticks, receiver_.held_tick());
        }
        if (newest_exact.tick != 0) ++(is_exact(arena) ? exact : behind);
    }

    // What is shown is the server's own snapshot of when it was sent.
    bool is_exact(const Crowd& arena) const {
        return newest_exact.tick + conditions_.flight_ticks + 4 * kTicksASnapshot >=
               arena.now().tick;
    }

    Snapshot newest_exact, sketch;
    std::map<Tick, Snapshot> exact_ones;
    std::map<std::uint16_t, Tick> told;  // by parts that came while it held nothing of use
    std::size_t bytes = 0, sketches = 0;
    int keyframes_begun = 0, keyframes_given_up = 0, exact = 0, behind = 0;
    bool is_away = false;
    std::size_t largest_packet_bytes = 0;

  private:
    struct Arriving {
        Tick tick = 0;
        replication::SnapshotPacket packet;
        std::vector<std::uint8_t> message;
    };

    void send(replication::SnapshotPacket::Kind kind, std::span<const std::uint8_t> part) override {
        replication::SnapshotPacket packet;
        packet.kind = kind;
        packet.part.assign(part.begin(), part.end());
        const std::size_t size = replication::encode(packet).size();
        largest_packet_bytes = std::max(largest_packet_bytes, size);
        bytes += size;
        if (is_away || is_lost()) return;
        arriving_.push_back({now_ + conditions_.flight_ticks, packet, {}});
    }
    bool send_reliable(std::span<const std::uint8_t> message) override {
        if (is_away) return false;
        bytes += message.size();
        arriving_.push_back(
            {now_ + conditions_.flight_ticks, {}, {message.begin(), message.end()}});
        return true;
    }
    void receive() {
        const auto known = [](int) { return std::optional(course()); };
        for (; !arriving_.empty() && arriving_.front().tick <= now_; arriving_.pop_front()) {
            const Arriving& one = arriving_.front();
            if (one.message.empty()) {
                if (one.packet.kind == replication::SnapshotPacket::Kind::kSomeStates) {
                    note(one.packet.part);
                }
                take(receiver_.receive(one.packet, kTicksASnapshot, known));
            } else {
                const auto message = replication::decode_server_message(one.message);
                ASSERT_TRUE(message);
                take(receiver_.receive(std::get<replication::KeyframePart>(*message),
                                       kTicksASnapshot, known));
            }
        }
        EXPECT_EQ(receiver_.counts().unlike, 0U);
        EXPECT_EQ(receiver_.counts().malformed, 0U);
    }
    void note(const std::vector<std::uint8_t>& part) {
        const auto some = replication::decode_part({}, part);
        ASSERT_TRUE(some);
        for (const BallState& ball : some->balls) told[ball.id] = some->tick;
    }
    void take(const replication::SnapshotReceiver::Received& received) {
        if (!received.snapshot) return;
        if (!received.exact) {
            sketch = *received.snapshot;
            ++sketches;
            return;
        }
        newest_exact = *received.snapshot;
        exact_ones[newest_exact.tick] = newest_exact;
    }
    bool is_lost() {
        return std::uniform_real_distribution<double>(0.0, 1.0)(rng_) < conditions_.loss;
    }

    SnapshotCourier courier_;
    replication::SnapshotReceiver receiver_;
    LinkConditions conditions_;
    std::mt19937_64 rng_;
    std::deque<Arriving> arriving_;
    std::deque<std::pair<Tick, Tick>> acks_;
    Tick now_ = 0;
};

constexpr int kSnapshotsASecond = game::kTickRateHz / static_cast<int>(kTicksASnapshot);

// Serves until the client shows the present; how many snapshots that took.
int snapshots_until_exact(Crowd& arena, Client& client, int at_most) {
    for (int i = 0; i < at_most; ++i) {
        arena.step_to_next_snapshot();
        client.serve(arena);
        if (client.is_exact(arena)) return i;
    }
    return at_most;
}

TEST(SnapshotCourier, lets_a_late_joiner_see_the_arena_at_once_and_exactly_soon_after) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        SCOPED_TRACE(seed);
        Crowd arena(seed, 700, 0.2);
        Client client(64000, seed);
        for (int i = 0; i < 8; ++i) {
            arena.step_to_next_snapshot();
            client.serve(arena);
        }
        EXPECT_GT(client.sketches, 0U);
        EXPECT_GT(client.sketch.balls.size(), 20U);
        EXPECT_TRUE(client.told.contains(1)) << "its own ball";
        EXPECT_EQ(client.newest_exact.tick, 0U) << "a keyframe is not sent in one burst";
        EXPECT_LT(snapshots_until_exact(arena, client, 200), 3 * kSnapshotsASecond);
        EXPECT_EQ(client.keyframes_begun, 1);
        client.exact = client.behind = 0;
        std::map<Tick, Snapshot> truth;
        client.exact_ones.clear();
        for (int i = 0; i < 200; ++i) {
            arena.step_to_next_snapshot();
            client.serve(arena);
            truth[arena.now().tick] = arena.now();
        }
        EXPECT_GT(client.exact, 195);
        for (const auto& [tick, shown] : client.exact_ones) {
            if (truth.contains(tick)) {
                ASSERT_EQ(shown.balls, truth[tick].balls) << tick;
            }
        }
    }
}

TEST(SnapshotCourier, sends_a_small_arena_whole_in_its_first_packet) {
    Crowd arena(4, 20, 0.5);
    Client client(kMinClientBytesPerS, 4, {.loss = 0.0, .flight_ticks = 1});
    EXPECT_EQ(snapshots_until_exact(arena, client, 10), 1);
    EXPECT_EQ(client.keyframes_begun, 0);
    EXPECT_EQ(client.sketches, 0U);
}

TEST(SnapshotCourier, keeps_to_its_budget_whatever_happens) {
    for (const int bytes_per_s : {16000, 40000, 128000}) {
        SCOPED_TRACE(bytes_per_s);
        Crowd arena(11, 600, 4.0);
        Client client(bytes_per_s, 11);
        std::deque<std::size_t> sent_by;
        for (int i = 0; i < 8 * kSnapshotsASecond; ++i) {
            if (i % 90 == 60) client.is_away = true;
            if (i % 90 == 80) client.is_away = false;
            arena.step_to_next_snapshot();
            client.serve(arena);
            sent_by.push_back(client.bytes);
        }
        const std::size_t second = kSnapshotsASecond;
        for (std::size_t i = second; i < sent_by.size(); ++i) {
            const auto in_a_second = static_cast<double>(sent_by[i] - sent_by[i - second]);
            const double saved = std::max(2400.0, SnapshotCourier::kSavedS * bytes_per_s);
            ASSERT_LE(in_a_second, bytes_per_s + saved) << i;
        }
        EXPECT_LE(client.largest_packet_bytes, net::kMaxPayloadBytes);
    }
}

TEST(SnapshotCourier, leads_through_more_events_than_fit_a_datagram) {
    Crowd arena(21, 900, 8.0);
    Client client(400000, 21, {.loss = 0.02, .flight_ticks = 4});
    ASSERT_LT(snapshots_until_exact(arena, client, 300), 90);
    client.exact = client.behind = 0;
    for (int i = 0; i < 300; ++i) {
        arena.step_to_next_snapshot();
        client.serve(arena);
    }
    EXPECT_GT(arena.log().between(arena.now().tick - 8, arena.now().tick).controls.size(), 800U);
    EXPECT_GT(client.exact, 270);
    EXPECT_EQ(client.keyframes_begun, 1);
}

TEST(SnapshotCourier, leads_on_from_what_was_held_before_a_short_absence) {
    Crowd arena(31, 600, 0.3);
    Client client(128000, 31);
    ASSERT_LT(snapshots_until_exact(arena, client, 300), 60);
    client.is_away = true;
    for (int i = 0; i < 2 * kSnapshotsASecond; ++i) {
        arena.step_to_next_snapshot();
        client.serve(arena);
    }
    client.is_away = false;
    EXPECT_LT(snapshots_until_exact(arena, client, 300), 20);
    EXPECT_EQ(client.keyframes_begun, 1) << "the first one";
}

TEST(SnapshotCourier, begins_anew_after_a_long_absence_and_after_a_new_level) {
    Crowd arena(41, 600, 0.3);
    Client client(128000, 41);
    ASSERT_LT(snapshots_until_exact(arena, client, 300), 60);
    client.is_away = true;
    for (int i = 0; i < 6 * kSnapshotsASecond; ++i) {
        arena.step_to_next_snapshot();
        client.serve(arena);
    }
    client.is_away = false;
    EXPECT_LT(snapshots_until_exact(arena, client, 300), 60);
    EXPECT_GE(client.keyframes_begun, 2);
    const int before = client.keyframes_begun;
    arena.begin_level();
    for (int i = 0; i < 60; ++i) {
        arena.step_to_next_snapshot();
        client.serve(arena);
    }
    EXPECT_TRUE(client.is_exact(arena));
    EXPECT_EQ(client.newest_exact.level, 2);
    EXPECT_GT(client.keyframes_begun, before);
}

TEST(SnapshotCourier, with_too_small_a_budget_still_tells_of_everyone_and_most_of_what_matters) {
    Crowd arena(51, 900, 12.0);
    Client client(kMinClientBytesPerS, 51);
    for (int i = 0; i < 12 * kSnapshotsASecond; ++i) {
        arena.step_to_next_snapshot();
        client.serve(arena);
    }
    ASSERT_FALSE(client.is_exact(arena));
    const Tick now = arena.now().tick;
    for (const BallState& ball : arena.now().balls) {
        ASSERT_TRUE(client.told.contains(ball.id)) << ball.id;
        EXPECT_LT(now - client.told[ball.id], 10U * game::kTickRateHz) << ball.id;
    }
    EXPECT_LT(now - client.told[1], game::kTickRateHz / 2U);
    EXPECT_EQ(client.sketch.balls.size(), arena.now().balls.size());
    EXPECT_LT(now - client.sketch.tick, game::kTickRateHz / 2U);
}

}  // namespace
}  // namespace fts::server
