// What the server tells of an arena leads whoever holds an older snapshot of it to the same state,
// to the last bit; and what was altered on the way leads nowhere.
#include "common/replication/control_events.h"

#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>

#include "common/game/movement.h"
#include "common/game/rules.h"
#include "common/game/upgrades.h"
#include "common/replication/arena_replay.h"
#include "common/replication/delta.h"
#include "common/replication/snapshot_receiver.h"
#include "tests/replication/random_snapshots.h"

namespace fts::replication {
namespace {

using testing::chance;
using testing::pick;
using testing::Rng;

constexpr Tick kTicksASnapshot = 2;

const Course& disc_course() {
    static const Course kCourse = course_of(physics::Disc{9.0}, {});
    return kCourse;
}

BallState ball_at(Rng& rng, std::uint16_t id) {
    const game::BallStats stats = game::stats_for({});
    BallState ball;
    ball.id = id;
    ball.x = static_cast<std::int32_t>(pick(rng, -6, 6) * 65536);
    ball.y = static_cast<std::int32_t>(pick(rng, -6, 6) * 65536);
    ball.radius = static_cast<std::uint16_t>(quantise(stats.radius_m, kRadiusStepM));
    ball.mass = static_cast<std::uint32_t>(quantise(stats.mass_kg, kMassStepKg));
    ball.kind = static_cast<std::uint8_t>(chance(rng, 50) ? BallKind::kPlayer : BallKind::kAi);
    ball.handling = quantised(game::handling_of(stats));
    return ball;
}

// A server's side of it: does things at random to its arena, and writes down what it did.
class BusyArena {
  public:
    explicit BusyArena(std::uint64_t seed) : rng_(seed), world_(disc_course(), {}) {
        state_.tick = 600;
        state_.arena = 3;
        state_.level = 2;
        state_.phase = game::Phase::kPlaying;
        state_.phase_end_tick = 9000;
        for (int i = 0; i < 12; ++i) put_ball();
        events_ = {};
        world_.snap();
    }

    void tick() {
        ++state_.tick;
        if (chance(rng_, 10)) put_ball();
        if (chance(rng_, 5)) remove_ball();
        if (chance(rng_, 5)) upgrade_ball();
        for (const BallState& ball : world_.balls()) {
            if (chance(rng_, 20)) steer(ball);
        }
        if (state_.phase == game::Phase::kPlaying) world_.advance(game::kTickDurationS);
        if (chance(rng_, 10)) put_coin();
        if (chance(rng_, 5)) take_coin();
        if (chance(rng_, 2)) begin_phase();
        if (state_.tick % kTicksASnapshot == 0) world_.snap();
    }
    Snapshot snapshot() const {
        Snapshot snapshot = state_;
        snapshot.balls = world_.balls();
        return snapshot;
    }
    ArenaEvents since(Tick tick) const {
        ArenaEvents events = events_;
        std::erase_if(events.controls, [&](const auto& event) { return event.tick <= tick; });
        std::erase_if(events.changes, [&](const auto& change) { return change.tick <= tick; });
        std::ranges::sort(events.controls, {}, [](const ControlEvent& event) {
            return std::tuple(event.ball, event.tick);
        });
        return events;
    }

  private:
    void put_ball() {
        const BallState ball = ball_at(rng_, next_id_);
        if (!world_.put(ball)) return;
        ++next_id_;
        events_.changes.push_back(ArenaChange::ball_put(state_.tick, ball));
    }
    void remove_ball() {
        const std::vector<BallState> balls = world_.balls();
        if (balls.empty()) return;
        const std::uint16_t id = balls[static_cast<std::size_t>(rng_()) % balls.size()].id;
        world_.remove(id);
        events_.changes.push_back(ArenaChange::ball_gone(state_.tick, id));
    }
    void upgrade_ball() {
        std::vector<BallState> balls = world_.balls();
        if (balls.empty()) return;
        BallState& ball = balls[static_cast<std::size_t>(rng_()) % balls.size()];
        ball.mass += 4096;
        ball.handling.acceleration += 1000;
        world_.put(ball);
        events_.changes.push_back(ArenaChange::ball_put(state_.tick, ball));
    }
    void steer(BallState ball) {
        ball.thrust_x = static_cast<std::int8_t>(pick(rng_, -127, 127));
        ball.thrust_y = static_cast<std::int8_t>(pick(rng_, -127, 127));
        ball.brake = chance(rng_, 20);
        const bool dashes = chance(rng_, 10);
        const std::size_t slot = world_.slot_of(ball.id).value();
        world_.steer(slot, ball);
        if (dashes) world_.dash(slot);
        events_.controls.push_back(
            {state_.tick, ball.id, ball.thrust_x, ball.thrust_y, ball.brake, dashes});
    }
    void put_coin() {
        const CoinState coin{next_id_++, static_cast<std::int32_t>(pick(rng_, -99999, 99999)),
                             static_cast<std::int32_t>(pick(rng_, -99999, 99999)), 2};
        state_.coins.push_back(coin);
        events_.changes.push_back(ArenaChange::coin_put(state_.tick, coin));
    }
    void take_coin() {
        if (state_.coins.empty()) return;
        const auto coin =
            state_.coins.begin() +
            static_cast<std::ptrdiff_t>(static_cast<std::size_t>(rng_()) % state_.coins.size());
        events_.changes.push_back(ArenaChange::coin_gone(state_.tick, coin->id));
        state_.coins.erase(coin);
    }
    void begin_phase() {
        const bool stop = state_.phase == game::Phase::kPlaying;
        state_.phase = stop ? game::Phase::kCountdown : game::Phase::kPlaying;
        state_.phase_end_tick += 60;
        if (stop) world_.halt();
        events_.changes.push_back(
            ArenaChange::phase_begun(state_.tick, state_.phase, state_.phase_end_tick));
    }

    Rng rng_;
    LatticeWorld world_;
    Snapshot state_;  // but for balls
    ArenaEvents events_;
    std::uint16_t next_id_ = 1;
};

bool alike(Snapshot a, Snapshot b) {
    a.hits.clear();
    b.hits.clear();
    return a == b;
}

TEST(ControlEvents, LeadFromAnySnapshotToAnyLaterOne) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE(seed);
        BusyArena server(seed);
        std::vector<Snapshot> held = {server.snapshot()};
        for (int i = 0; i < 120; ++i) {
            server.tick();
            if (server.snapshot().tick % kTicksASnapshot != 0) continue;
            const Snapshot truth = server.snapshot();
            const Snapshot& baseline = held[held.size() - std::min<std::size_t>(held.size(), 5)];
            const auto bytes = encode_events(baseline, server.since(baseline.tick), truth);
            const auto part = decode_events(baseline, bytes);
            ASSERT_TRUE(part);
            ASSERT_EQ(part->events, server.since(baseline.tick));
            const Snapshot outcome =
                replay(disc_course(), baseline, truth.tick, kTicksASnapshot, part->events);
            ASSERT_TRUE(alike(outcome, truth)) << truth.tick;
            ASSERT_EQ(outcome_digest_of(outcome), part->outcome_digest);
            held.push_back(truth);
        }
    }
}

TEST(ControlEvents, AreTakenUpFromANewerSnapshotThanTheirBaseline) {
    BusyArena server(77);
    const Snapshot baseline = server.snapshot();
    ArenaReplay client(disc_course(), baseline, kTicksASnapshot);
    for (int i = 0; i < 60; ++i) {
        server.tick();
        if (server.snapshot().tick % 6 != 0) continue;
        const Snapshot truth = server.snapshot();
        client.run_to(truth.tick, server.since(baseline.tick));
        ASSERT_TRUE(alike(client.snapshot(), truth)) << truth.tick;
    }
}

TEST(ControlEvents, ThatWereAlteredAreNothingOrLeadElsewhere) {
    BusyArena server(5);
    const Snapshot baseline = server.snapshot();
    for (int i = 0; i < 6; ++i) server.tick();
    const auto bytes = encode_events(baseline, server.since(baseline.tick), server.snapshot());
    const auto is_shown = [&](const std::vector<std::uint8_t>& arrived) {
        const auto part = decode_events(baseline, arrived);
        return part &&
               part->outcome_digest == outcome_digest_of(replay(disc_course(), baseline, part->tick,
                                                                kTicksASnapshot, part->events));
    };
    ASSERT_TRUE(is_shown(bytes));
    Snapshot older = baseline;
    older.tick -= kTicksASnapshot;
    EXPECT_FALSE(decode_events(older, bytes));
    auto longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(is_shown(longer));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_FALSE(is_shown({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}));
        auto altered = bytes;
        altered[size] = static_cast<std::uint8_t>(altered[size] ^ (1U << size % 8));
        EXPECT_FALSE(is_shown(altered)) << size;
    }
}

// Where nothing moves, any tick looks like the one that was sent.
TEST(ControlEvents, OfAWorldAtRestAreNotTakenForAnotherTicks) {
    Rng rng(3);
    Snapshot baseline;
    baseline.tick = 60;
    baseline.phase = game::Phase::kPlaying;
    baseline.balls = {ball_at(rng, 1)};
    const Snapshot outcome = replay(disc_course(), baseline, 66, kTicksASnapshot, {});
    ASSERT_EQ(outcome.balls, baseline.balls);
    auto bytes = encode_events(baseline, {}, outcome);
    EXPECT_EQ(decode_events(baseline, bytes)->outcome_digest, outcome_digest_of(outcome));
    ++bytes[0];  // tick
    ++bytes[1];  // age
    const auto part = decode_events(baseline, bytes);
    ASSERT_TRUE(part);
    EXPECT_EQ(part->tick, 67U);
    EXPECT_NE(part->outcome_digest, outcome_digest_of(outcome));
}

TEST(ControlEvents, OfAQuietArenaAreNearlyNothing) {
    Rng rng(9);
    Snapshot baseline;
    baseline.tick = 60;
    baseline.phase = game::Phase::kPlaying;
    for (std::uint16_t id = 1; id <= 900; ++id) {
        baseline.balls.push_back(ball_at(rng, id));
        baseline.balls.back().kind = 0;
    }
    const Snapshot outcome = replay(disc_course(), baseline, 62, kTicksASnapshot, {});
    EXPECT_LE(encode_events(baseline, {}, outcome).size(), 12U);
}

TEST(ControlEvents, OfACrowdThatIsPutTakeLittleMoreThanWhereItIs) {
    Rng rng(10);
    Snapshot baseline;
    baseline.tick = 60;
    ArenaEvents events;
    for (std::uint16_t id = 100; id < 150; ++id) {
        BallState ball = ball_at(rng, 100);
        ball.id = id;
        ball.vx = ball.vy = 0;
        ball.thrust_x = ball.thrust_y = 0;
        ball.brake = false;
        if (!events.changes.empty()) {
            const BallState& first = events.changes.front().ball;
            ball = {.id = id,
                    .x = ball.x,
                    .y = ball.y,
                    .radius = first.radius,
                    .mass = first.mass,
                    .kind = first.kind,
                    .behaviour = first.behaviour,
                    .player_id = first.player_id,
                    .handling = first.handling};
        }
        events.changes.push_back(ArenaChange::ball_put(61, ball));
    }
    const Snapshot outcome = replay(disc_course(), baseline, 62, kTicksASnapshot, events);
    const auto bytes = encode_events(baseline, events, outcome);
    EXPECT_LT(bytes.size(), 50U * 11U);
    EXPECT_EQ(decode_events(baseline, bytes)->events, events);
}

// Such as rounding leaves at the edge, or somebody sends who means harm.
TEST(LatticeWorld, BringsBallsBackThatAreOffThePlatform) {
    const physics::Platform platforms[] = {physics::Disc{9.0}, physics::Rectangle{{7.0, 4.0}},
                                           physics::Ring{2.5, 8.0}};
    Rng rng(12);
    for (const physics::Platform& platform : platforms) {
        std::vector<BallState> balls;
        for (std::uint16_t id = 0; id < 400; ++id) {
            BallState ball = ball_at(rng, id);
            const int reach = 1 << pick(rng, 0, 30);
            ball.x = static_cast<std::int32_t>(pick(rng, -reach, reach));
            ball.y = static_cast<std::int32_t>(pick(rng, -reach, reach));
            balls.push_back(ball);
        }
        LatticeWorld world(course_of(platform, {}), balls);
        EXPECT_EQ(world.balls().size(), balls.size());
        for (const physics::BodyId id : world.world().ids()) {
            ASSERT_GE(physics::distance_to_edge_m(platform, world.world().body(id).position_m),
                      0.0);
        }
        for (int i = 0; i < 4; ++i) world.snap();
    }
}

TEST(LatticeWorld, LetsABallFallThatWasRoundedOverTheEdge) {
    Rng rng(1);
    BallState ball = ball_at(rng, 1);
    ball.x = quantise(9.0, kPositionStepM) + 1;
    ball.y = 0;
    ball.vx = quantise(1.0, kVelocityStepMps);
    LatticeWorld world(disc_course(), std::vector{ball});
    world.advance(game::kTickDurationS);
    ASSERT_EQ(world.falls().size(), 1U);
    EXPECT_EQ(world.id_at(world.falls().front().id.index), 1);
    EXPECT_TRUE(world.balls().empty());
}

// A part that was altered may say of anybody that it dashed.
TEST(LatticeWorld, LeavesABallAsItIsWhereNobodyCanDash) {
    Course course = disc_course();
    course.dash_of = nullptr;
    Rng rng(5);
    LatticeWorld world(course, std::vector{ball_at(rng, 1)});
    world.dash(0);
    EXPECT_EQ(world.body(1).velocity_mps, physics::Vec2d::Zero());
}

TEST(ArenaReplay, ShowsEveryTickAndItsHits) {
    const game::BallStats stats = game::stats_for({});
    Rng rng(4);
    Snapshot start;
    start.tick = 100;
    start.phase = game::Phase::kPlaying;
    for (const std::uint16_t id : {std::uint16_t{1}, std::uint16_t{2}}) {
        BallState ball = ball_at(rng, id);
        ball.x = quantise(id == 1 ? -1.05 : 1.05, kPositionStepM);
        ball.y = 0;
        ball.vx = quantise(id == 1 ? 6.0 : -6.0, kVelocityStepMps);
        ball.handling = {};
        start.balls.push_back(ball);
    }
    ArenaReplay arena(disc_course(), start, kTicksASnapshot);
    std::vector<Tick> ticks, ticks_of_contacts;
    arena.run_to(112, {}, [&](const ArenaReplay& now) {
        ticks.push_back(now.tick());
        if (!now.world().contacts().empty()) ticks_of_contacts.push_back(now.tick());
    });
    ASSERT_EQ(ticks.size(), 12U);
    EXPECT_EQ(ticks.back(), 112U);
    const double gap_s = (2.1 - 2.0 * stats.radius_m) / 12.0;
    const auto tick_of_hit = 100 + static_cast<Tick>(std::ceil(gap_s * 60.0));
    EXPECT_EQ(ticks_of_contacts, std::vector<Tick>{tick_of_hit});
    const Snapshot shown = arena.snapshot();
    ASSERT_EQ(shown.hits.size(), 1U);
    EXPECT_EQ(shown.hits.front().tick, tick_of_hit);
    EXPECT_EQ(shown.balls[0].vx, -start.balls[0].vx);
}

std::vector<SnapshotPacket> packets_for(const std::vector<Snapshot>& sent, Tick held,
                                        const BusyArena& server) {
    const Snapshot truth = server.snapshot();
    const auto baseline =
        std::ranges::find_if(sent, [&](const Snapshot& snapshot) { return snapshot.tick == held; });
    std::vector<SnapshotPacket> packets;
    if (baseline == sent.end() || held == 0) {
        for (auto& part : encode_delta(Snapshot{}, truth, 600)) {
            packets.push_back({.part = std::move(part)});
        }
        return packets;
    }
    packets.push_back({.kind = SnapshotPacket::Kind::kEvents,
                       .part = encode_events(*baseline, server.since(baseline->tick), truth)});
    return packets;
}

// Some alone, some sharing what they simulate; each loses packets of its own.
TEST(SnapshotReceiver, HasTheServersSnapshotsWhateverIsLostAndWhoeverSharesTheWork) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE(seed);
        Rng loss(seed + 100);
        BusyArena server(seed);
        const auto shared = std::make_shared<SharedReplay>();
        std::vector<SnapshotReceiver> clients;
        for (int i = 0; i < 2; ++i) clients.emplace_back();
        for (int i = 0; i < 3; ++i) clients.emplace_back(shared);
        const auto course = [](int) { return std::optional(disc_course()); };
        std::vector<Snapshot> sent;
        std::vector<int> received(clients.size());
        for (int i = 0; i < 200; ++i) {
            server.tick();
            const Snapshot truth = server.snapshot();
            if (truth.tick % kTicksASnapshot != 0) continue;
            for (std::size_t k = 0; k < clients.size(); ++k) {
                for (const auto& packet : packets_for(sent, clients[k].held_tick(), server)) {
                    if (chance(loss, 20)) continue;
                    const auto got = clients[k].receive(packet, kTicksASnapshot, course);
                    if (!got.snapshot) continue;
                    ASSERT_TRUE(alike(*got.snapshot, truth)) << "client " << k << " " << truth.tick;
                    ++received[k];
                }
            }
            sent.push_back(truth);
        }
        for (std::size_t k = 0; k < clients.size(); ++k) {
            EXPECT_GT(received[k], 60);
            EXPECT_EQ(clients[k].counts().unlike, 0U);
            EXPECT_EQ(clients[k].counts().malformed, 0U);
        }
    }
}

TEST(SnapshotReceiver, ThatHasGoneAnotherWayAsksForStates) {
    BusyArena server(8);
    SnapshotReceiver client;
    const auto course = [](int) { return std::optional(course_of(physics::Disc{4.0}, {})); };
    std::vector<Snapshot> sent;
    int whole = 0;
    for (int i = 0; i < 60; ++i) {
        server.tick();
        const Snapshot truth = server.snapshot();
        if (truth.tick % kTicksASnapshot != 0) continue;
        for (const auto& packet : packets_for(sent, client.held_tick(), server)) {
            if (client.receive(packet, kTicksASnapshot, course).snapshot) ++whole;
        }
        sent.push_back(truth);
    }
    EXPECT_GT(client.counts().unlike, 0U) << "on a smaller platform balls fall earlier";
    EXPECT_GT(whole, 5) << "and yet it is shown what there is";
}

}  // namespace
}  // namespace fts::replication
