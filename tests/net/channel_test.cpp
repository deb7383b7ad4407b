// What two ends of a channel make of packets that are lost, doubled and out of order. No keys here.

#include "common/net/channel.h"

#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace fts::net {
namespace {

constexpr double kStepS = 1.0 / 60.0;

struct InFlight {
    std::uint64_t number;
    std::vector<std::uint8_t> bytes;
};

// One direction of a rough road.
class Road {
  public:
    Road(std::uint64_t seed, double loss, double delay_s, double jitter_s)
        : random_(seed), loss_(loss), delay_s_(delay_s), jitter_s_(jitter_s) {}

    void put(double now_s, const Channel::Written& written, Channel::Plaintext plaintext) {
        ++packets;
        const auto begin = plaintext.begin();
        const auto end = begin + static_cast<std::ptrdiff_t>(written.size);
        if (chance() < loss_) return;
        const int copies = chance() < 0.1 ? 2 : 1;
        for (int i = 0; i < copies; ++i) {
            const double due_s = now_s + delay_s_ + jitter_s_ * (2.0 * chance() - 1.0);
            in_flight_.emplace(due_s, InFlight{written.number, {begin, end}});
        }
    }
    std::vector<InFlight> take(double now_s) {
        std::vector<InFlight> due;
        while (!in_flight_.empty() && in_flight_.begin()->first <= now_s) {
            due.push_back(in_flight_.extract(in_flight_.begin()).mapped());
        }
        return due;
    }
    std::uint64_t packets = 0;

  private:
    double chance() { return std::uniform_real_distribution<double>()(random_); }
    std::mt19937_64 random_;
    double loss_, delay_s_, jitter_s_;
    std::multimap<double, InFlight> in_flight_;
};

struct End {
    Channel channel;
    Channel::Received got;
    std::vector<std::vector<std::uint8_t>> messages;

    void receive(const InFlight& packet, double now_s) {
        if (!channel.is_fresh(packet.number)) return;
        got = {};
        ASSERT_TRUE(channel.read(packet.number, packet.bytes, now_s, got));
        for (auto& message : got.messages) messages.push_back(std::move(message));
    }
    void send(Road& road, double now_s) {
        std::array<std::uint8_t, kMaxPlaintextBytes> plaintext;
        channel.update(now_s);
        while (channel.has_fragments_due(now_s)) {
            road.put(now_s, channel.write(now_s, plaintext), plaintext);
        }
        if (channel.owes_answer(now_s)) {
            road.put(now_s, channel.write(now_s, plaintext), plaintext);
        }
    }
};

struct TwoEnds {
    TwoEnds(std::uint64_t seed, double loss, double delay_s, double jitter_s)
        : to_b(seed, loss, delay_s, jitter_s), to_a(seed + 1000, loss, delay_s, jitter_s) {}

    void step() {
        now_s += kStepS;
        for (const InFlight& packet : to_b.take(now_s)) b.receive(packet, now_s);
        for (const InFlight& packet : to_a.take(now_s)) a.receive(packet, now_s);
        a.send(to_b, now_s);
        b.send(to_a, now_s);
    }
    End a, b;
    Road to_b, to_a;
    double now_s = 0.0;
};

std::vector<std::uint8_t> random_message(std::mt19937_64& random, std::size_t size) {
    std::vector<std::uint8_t> message(size);
    for (auto& byte : message) byte = static_cast<std::uint8_t>(random());
    return message;
}

TEST(Channel, reliable_messages_arrive_exactly_once_and_in_order_whatever_the_road) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        TwoEnds ends(seed, 0.05 * static_cast<double>(seed % 8), 0.03, 0.03);
        std::vector<std::vector<std::uint8_t>> from_a;
        std::vector<std::vector<std::uint8_t>> from_b;
        for (int i = 0; i < 3000 && (i < 200 || ends.b.messages.size() < from_a.size() ||
                                     ends.a.messages.size() < from_b.size());
             ++i) {
            if (i < 120 && random() % 4 == 0) {
                const std::size_t size = random() % 5 == 0 ? random() % 6000 : random() % 60;
                from_a.push_back(random_message(random, size));
                ASSERT_TRUE(ends.a.channel.queue_reliable(from_a.back()));
            }
            if (i < 120 && random() % 4 == 0) {
                from_b.push_back(random_message(random, random() % 3));
                ASSERT_TRUE(ends.b.channel.queue_reliable(from_b.back()));
            }
            ends.step();
        }
        EXPECT_EQ(ends.b.messages, from_a);
        EXPECT_EQ(ends.a.messages, from_b);
    }
}

TEST(Channel, the_largest_message_arrives_whole_over_a_lossy_road) {
    std::mt19937_64 random(5);
    TwoEnds ends(5, 0.2, 0.05, 0.03);
    const auto message = random_message(random, kMaxMessageBytes);
    ASSERT_TRUE(ends.a.channel.queue_reliable(message));
    for (int i = 0; i < 60 * 30 && ends.b.messages.empty(); ++i) ends.step();
    ASSERT_EQ(ends.b.messages.size(), 1U);
    EXPECT_EQ(ends.b.messages[0], message);
}

TEST(Channel, a_message_of_every_size_around_a_fragments_edge_survives) {
    TwoEnds ends(1, 0.0, 0.0, 0.0);
    std::mt19937_64 random(1);
    std::vector<std::vector<std::uint8_t>> sent;
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, kFragmentBytes - 1, kFragmentBytes, kFragmentBytes + 1,
          2 * kFragmentBytes, kMaxMessageBytes}) {
        sent.push_back(random_message(random, size));
        ASSERT_TRUE(ends.a.channel.queue_reliable(sent.back()));
    }
    for (int i = 0; i < 300; ++i) ends.step();
    EXPECT_EQ(ends.b.messages, sent);
}

TEST(Channel, a_message_too_large_is_refused) {
    Channel channel;
    EXPECT_FALSE(channel.queue_reliable(std::vector<std::uint8_t>(kMaxMessageBytes + 1)));
}

TEST(Channel, a_queue_that_nobody_acknowledges_fills_up_and_says_so) {
    Channel large;
    std::size_t accepted = 0;
    while (large.queue_reliable(std::vector<std::uint8_t>(kMaxMessageBytes))) ++accepted;
    EXPECT_EQ(accepted, kMaxQueuedBytes / kMaxMessageBytes);
    Channel small;
    for (accepted = 0; small.queue_reliable({}); ++accepted)
        ASSERT_LE(accepted, kMaxQueuedFragments);
    EXPECT_EQ(accepted, kMaxQueuedFragments);
}

TEST(Channel, a_full_queue_has_room_again_once_messages_have_arrived) {
    TwoEnds ends(3, 0.1, 0.02, 0.01);
    while (ends.a.channel.queue_reliable(std::vector<std::uint8_t>(kMaxMessageBytes))) {
    }
    for (int i = 0; i < 60 * 20 && ends.b.messages.size() < 2; ++i) ends.step();
    EXPECT_TRUE(ends.a.channel.queue_reliable(std::vector<std::uint8_t>(1)));
}

TEST(Channel, a_dead_road_is_not_flooded_with_resends) {
    TwoEnds ends(1, 1.0, 0.0, 0.0);
    ASSERT_TRUE(ends.a.channel.queue_reliable(std::vector<std::uint8_t>(kMaxMessageBytes)));
    for (int i = 0; i < 60 * 5; ++i) ends.step();
    const double bytes = static_cast<double>(ends.to_b.packets * kMaxDatagramBytes);
    EXPECT_LT(bytes / 5.0, kReliableBytesPerS);
    EXPECT_GE(ends.to_b.packets, 32U * 2U) << "it should still be trying";
}

TEST(Channel, a_large_message_is_sent_at_a_steady_rate_and_not_all_at_once) {
    ReliableSender sender;
    while (sender.queue(std::vector<std::uint8_t>(kMaxMessageBytes))) {
    }
    double now_s = 0.0;
    double bytes = 0.0;
    while (sender.queued_bytes() > 0) {
        sender.update(now_s, 0.1);
        while (const Fragment* fragment = sender.due(now_s, kFragmentBytes)) {
            bytes += static_cast<double>(fragment->bytes.size());
            ASSERT_LE(bytes, kReliableBurstBytes + now_s * kReliableBytesPerS + kFragmentBytes);
            const std::uint64_t number = fragment->number;
            sender.mark_sent(number, now_s);
            sender.acknowledge(number);
        }
        now_s += kStepS;
    }
    EXPECT_EQ(bytes, static_cast<double>(kMaxQueuedBytes));
}

// How many fragments leave before any is acknowledged.
std::size_t under_way_at_once(ReliableSender& sender, double now_s) {
    sender.update(now_s, 0.1);
    std::vector<std::uint64_t> numbers;
    while (const Fragment* fragment = sender.due(now_s, kFragmentBytes)) {
        numbers.push_back(fragment->number);
        sender.mark_sent(fragment->number, now_s);
    }
    for (const std::uint64_t number : numbers) sender.acknowledge(number);
    return numbers.size();
}

TEST(Channel, losses_make_it_send_fewer_at_once_and_arrivals_more_again) {
    ReliableSender sender;
    const auto fill = [&] {
        while (sender.queue(std::vector<std::uint8_t>(10))) {
        }
    };
    fill();
    const std::size_t before = under_way_at_once(sender, 0.0);
    for (int loss = 0; loss < 3; ++loss) {
        const double now_s = 10.0 * (loss + 1);
        sender.update(now_s, 0.1);
        const std::uint64_t number = sender.due(now_s, kFragmentBytes)->number;
        sender.mark_sent(number, now_s);
        sender.mark_sent(number, now_s + 5.0);
        sender.acknowledge(number);
    }
    fill();
    const std::size_t after = under_way_at_once(sender, 50.0);
    EXPECT_LE(after, before / 4);
    EXPECT_GE(after, 1U);
    for (int i = 0; i < 100; ++i) {
        fill();
        under_way_at_once(sender, 60.0 + i);
    }
    fill();
    EXPECT_GT(under_way_at_once(sender, 200.0), before);
}

TEST(Channel, the_round_trip_is_measured_about_right_and_in_spite_of_waiting_acknowledgements) {
    TwoEnds ends(11, 0.02, 0.05, 0.03);
    std::array<std::uint8_t, kMaxPlaintextBytes> plaintext;
    for (int i = 0; i < 60 * 20; ++i) {
        ends.step();
        ends.to_b.put(ends.now_s, ends.a.channel.write_ping(ends.now_s, plaintext), plaintext);
    }
    EXPECT_NEAR(ends.a.channel.sent().rtt_s(), 0.1 + kStepS, 0.025);
    EXPECT_GT(ends.a.channel.sent().rtt_jitter_s(), 0.003);
    EXPECT_LT(ends.a.channel.sent().rtt_jitter_s(), 0.06);
}

TEST(Channel, the_loss_is_measured_about_right) {
    for (const double loss : {0.0, 0.1, 0.3}) {
        TwoEnds ends(17, loss, 0.03, 0.01);
        std::array<std::uint8_t, kMaxPlaintextBytes> plaintext;
        double sum = 0.0;
        int count = 0;
        for (int i = 0; i < 60 * 40; ++i) {
            ends.step();
            ends.to_b.put(ends.now_s, ends.a.channel.write_ping(ends.now_s, plaintext), plaintext);
            if (i > 600) {
                sum += ends.a.channel.sent().loss();
                ++count;
            }
        }
        EXPECT_NEAR(sum / count, loss, 0.05);
    }
}

TEST(Channel, every_packet_has_a_number_of_its_own) {
    TwoEnds ends(2, 0.3, 0.02, 0.02);
    std::array<std::uint8_t, kMaxPlaintextBytes> plaintext;
    std::set<std::uint64_t> numbers;
    ASSERT_TRUE(ends.a.channel.queue_reliable(std::vector<std::uint8_t>(30000)));
    for (int i = 0; i < 300; ++i) {
        ends.step();
        for (const Channel::Written& written :
             {ends.a.channel.write_ping(ends.now_s, plaintext),
              ends.a.channel.write_payload({}, ends.now_s, plaintext),
              ends.a.channel.write_goodbye({}, ends.now_s, plaintext)}) {
            EXPECT_TRUE(numbers.insert(written.number).second);
        }
    }
}

// What an end makes of a hand-made packet.
class HandMade {
  public:
    explicit HandMade(std::uint32_t newest_acknowledged = 0) {
        writer_.put(newest_acknowledged);
        writer_.put(std::uint64_t{0});
        writer_.put(std::uint16_t{0});
    }
    template <typename... Fields>
    HandMade& with(Fields... fields) {
        (writer_.put(fields), ...);
        return *this;
    }
    HandMade& filler(std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) writer_.put(std::uint8_t{1});
        return *this;
    }
    bool is_accepted() const {
        Channel channel;
        Channel::Received received;
        return channel.read(1, std::span(bytes_).first(writer_.size()), 0.0, received);
    }

  private:
    std::array<std::uint8_t, 4096> bytes_{};
    ByteWriter writer_{bytes_};
};

constexpr std::uint8_t kPayload = 1, kFragment = 2, kGoodbye = 3, kUnknownFrame = 99;
using U8 = std::uint8_t;
using U16 = std::uint16_t;
using U32 = std::uint32_t;

TEST(Channel, a_packet_that_no_honest_end_would_send_is_recognised) {
    EXPECT_TRUE(HandMade().is_accepted());
    EXPECT_FALSE(HandMade(1).is_accepted()) << "acknowledges what was never sent";
    EXPECT_FALSE(HandMade().with(kUnknownFrame).is_accepted());
    EXPECT_FALSE(HandMade().with(kPayload).is_accepted()) << "cut off";
    EXPECT_FALSE(HandMade().with(kPayload, U16{5}).filler(4).is_accepted());
    EXPECT_TRUE(HandMade().with(kPayload, U16{5}).filler(5).is_accepted());
    EXPECT_FALSE(HandMade().with(kPayload, U16{1151}).filler(1151).is_accepted()) << "too large";
    EXPECT_FALSE(HandMade().with(kPayload, U16{0}, kPayload, U16{0}).is_accepted())
        << "two of them";
    EXPECT_TRUE(HandMade().with(kFragment, U32{0}, U8{1}, U16{0}).is_accepted());
    EXPECT_FALSE(HandMade().with(kFragment, U32{0}, U8{2}, U16{0}).is_accepted());
    EXPECT_FALSE(HandMade().with(kFragment, U32{0}, U8{0}, U16{3}).filler(3).is_accepted())
        << "only the last fragment of a message is short";
    EXPECT_FALSE(HandMade().with(kFragment, U32{0}, U8{1}, U16{1025}).filler(1025).is_accepted());
    EXPECT_TRUE(HandMade().with(kFragment, U32{63}, U8{1}, U16{0}).is_accepted());
    EXPECT_FALSE(HandMade().with(kFragment, U32{64}, U8{1}, U16{0}).is_accepted())
        << "beyond the window";
    EXPECT_FALSE(HandMade().with(kGoodbye, U8{0}, U8{201}).filler(201).is_accepted());
}

TEST(Channel, a_message_that_never_ends_is_cut_off_at_the_limit) {
    ReliableReceiver receiver;
    std::vector<std::vector<std::uint8_t>> messages;
    const std::vector<std::uint8_t> full(kFragmentBytes);
    for (std::uint64_t i = 0; i < kMaxMessageBytes / kFragmentBytes; ++i) {
        ASSERT_TRUE(receiver.accept(i, false, full, messages));
    }
    EXPECT_FALSE(receiver.accept(kMaxMessageBytes / kFragmentBytes, false, full, messages));
    EXPECT_TRUE(messages.empty());
}

TEST(Goodbye, what_it_says_is_made_fit_to_be_shown) {
    EXPECT_EQ(presentable("see you\n\x1b[31m"), "see you??[31m");
    EXPECT_EQ(presentable(std::string(500, 'x')).size(), kMaxDetailBytes);
    const std::string split = std::string(kMaxDetailBytes - 1, 'x') + "\xc3\xa9";
    EXPECT_EQ(presentable(split), std::string(kMaxDetailBytes - 1, 'x')) << "no half characters";
}

}  // namespace
}  // namespace fts::net
