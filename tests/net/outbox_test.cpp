// What an outbox does when the system takes only some datagrams, or none.
#include "common/net/outbox.h"

#include <cerrno>
#include <random>

#include <gtest/gtest.h>

#include "common/net/drops.h"
#include "tests/net/memory_network.h"

namespace fts::net {
namespace {

class OutboxTest : public testing::Test {
  protected:
    // Adds `count` datagrams of one byte, their numbers.
    void add(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            outbox.add(address_of(2), Datagram{next_++});
        }
    }
    // The system does as it is told, call by call, and when it has been told no more takes all.
    void send(std::vector<Outbox::Progress> told) {
        std::size_t call = 0;
        outbox.send([&](std::span<const Outbox::Datagram> datagrams) {
            const Outbox::Progress progress =
                call < told.size() ? told[call] : Outbox::Progress{datagrams.size(), 0};
            ++call;
            for (const auto& datagram : datagrams.first(progress.sent)) {
                left.push_back(datagram.bytes.front());
            }
            return progress;
        });
    }
    static std::vector<std::uint8_t> numbers(std::uint8_t first, std::uint8_t end) {
        std::vector<std::uint8_t> all;
        for (std::uint8_t i = first; i < end; ++i) all.push_back(i);
        return all;
    }

    DropCounters drops = drop::make_transport_counters();
    Outbox outbox{drops};
    std::vector<std::uint8_t> left;

  private:
    std::uint8_t next_ = 0;
};

TEST_F(OutboxTest, everything_leaves_in_one_call_and_in_order) {
    add(10);
    send({});
    EXPECT_EQ(left, numbers(0, 10));
    EXPECT_TRUE(outbox.empty());
    EXPECT_EQ(outbox.sent_count(), 10U);
}

TEST_F(OutboxTest, a_call_that_takes_only_some_is_followed_by_another) {
    add(10);
    send({{3, 0}, {1, 0}});
    EXPECT_EQ(left, numbers(0, 10));
}

TEST_F(OutboxTest, what_a_full_send_buffer_leaves_behind_goes_first_the_next_time) {
    for (const int error : {EAGAIN, ENOBUFS}) {
        left.clear();
        add(6);
        const std::uint8_t first = static_cast<std::uint8_t>(outbox.sent_count());
        send({{2, 0}, {0, error}});
        EXPECT_EQ(left.size(), 2U);
        EXPECT_FALSE(outbox.empty());
        add(2);
        send({});
        EXPECT_EQ(left, numbers(first, first + 8));
    }
    for (const auto& [reason, count] : drops) EXPECT_EQ(count, 0U) << reason;
}

TEST_F(OutboxTest,
       a_refusal_speaks_of_an_earlier_datagram_and_the_one_in_hand_is_sent_all_the_same) {
    add(5);
    send({{2, 0}, {0, ECONNREFUSED}});
    EXPECT_EQ(left, numbers(0, 5));
    EXPECT_EQ(drops[drop::kPeerUnreachable], 1U);
}

TEST_F(OutboxTest, a_datagram_that_is_refused_again_and_again_is_dropped_and_counted) {
    add(3);
    send({{0, ECONNREFUSED}, {0, ECONNREFUSED}});
    EXPECT_EQ(left, numbers(1, 3));
    EXPECT_EQ(drops[drop::kSendFailed], 1U);
}

TEST_F(OutboxTest, a_datagram_that_cannot_be_sent_is_dropped_and_counted_and_the_others_leave) {
    add(5);
    send({{2, 0}, {0, EPERM}});
    EXPECT_EQ(left, (std::vector<std::uint8_t>{0, 1, 3, 4}));
    EXPECT_EQ(drops[drop::kSendFailed], 1U);
    EXPECT_TRUE(outbox.empty());
}

TEST_F(OutboxTest, a_signal_costs_nothing) {
    add(4);
    send({{0, EINTR}, {2, 0}, {0, EINTR}});
    EXPECT_EQ(left, numbers(0, 4));
}

TEST_F(OutboxTest, each_datagram_leaves_once_in_order_or_is_counted_whatever_the_system_does) {
    constexpr std::uint64_t kSeed = 7;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937_64 random(kSeed);
    const std::array errors{EAGAIN, ENOBUFS, ECONNREFUSED, EPERM, EINTR, ENETUNREACH, 0};
    std::uint32_t added = 0;
    std::vector<std::uint32_t> taken;
    for (int round = 0; round < 2000; ++round) {
        for (auto more = random() % 20; more > 0 && !outbox.full(); --more, ++added) {
            Datagram bytes(1 + random() % kMaxDatagramBytes);
            bytes.resize(std::max<std::size_t>(bytes.size(), 4));
            for (unsigned i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(added >> 8 * i);
            outbox.add(address_of(static_cast<std::uint8_t>(added % 7)), bytes);
        }
        outbox.send([&](std::span<const Outbox::Datagram> datagrams) {
            const Outbox::Progress progress{random() % (datagrams.size() + 1),
                                            errors[random() % errors.size()]};
            for (const auto& [to, bytes] : datagrams.first(progress.sent)) {
                std::uint32_t number = 0;
                for (unsigned i = 0; i < 4; ++i) number |= std::uint32_t{bytes[i]} << 8 * i;
                EXPECT_EQ(to, address_of(static_cast<std::uint8_t>(number % 7)));
                EXPECT_TRUE(taken.empty() || number > taken.back()) << number;
                taken.push_back(number);
            }
            return progress;
        });
    }
    std::size_t waiting = 0;
    outbox.send([&](std::span<const Outbox::Datagram> datagrams) {
        waiting = datagrams.size();
        return Outbox::Progress{0, EAGAIN};
    });
    EXPECT_EQ(taken.size() + waiting + drops[drop::kSendFailed], added);
    EXPECT_EQ(taken.size(), outbox.sent_count());
}

}  // namespace
}  // namespace fts::net
