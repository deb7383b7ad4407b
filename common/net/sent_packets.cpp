#include "common/net/sent_packets.h"

#include <algorithm>
#include <cmath>

#include "common/net/sequence.h"

namespace fts::net {
namespace {

constexpr double kFirstResendAfterS = 0.25;
constexpr double kMinResendAfterS = 0.03;
constexpr double kMaxResendAfterS = 1.0;
// Acknowledgements wait for a packet to travel in, a tick or so.
constexpr double kMinResendMarginS = 0.03;

// A packet that is missing while later ones were acknowledged may only have been overtaken.
constexpr double kOvertakenS = 0.25;
// Without any later acknowledgement it is the link that is silent.
constexpr double kSilenceS = 3.0;

// The loss is a mean over about this many packets.
constexpr std::uint64_t kLossMemoryPackets = 128;

}  // namespace

void SentPackets::record(double now_s, std::vector<std::uint64_t> fragments) {
    sent_.push_back({now_s, false, std::move(fragments)});
}

bool SentPackets::acknowledge(const Acknowledgement& ack, double now_s,
                              std::vector<std::uint64_t>& fragments) {
    if (ack.newest >= next_number()) return false;
    for (std::uint64_t i = 0; i <= kAckBits && i < ack.newest; ++i) {
        const bool arrived = i == 0 || ((ack.before_newest >> (i - 1)) & 1) != 0;
        const std::uint64_t number = ack.newest - i;
        if (!arrived || number < first_) continue;
        Sent& sent = sent_[number - first_];
        if (sent.acknowledged) continue;
        sent.acknowledged = true;
        resolve(false);
        fragments.insert(fragments.end(), sent.fragments.begin(), sent.fragments.end());
        if (number > newest_acknowledged_) {
            newest_acknowledged_ = number;
            measure(std::max(0.0, now_s - sent.at_s - ack.delay_s));
        }
    }
    return true;
}

void SentPackets::update(double now_s) {
    const auto is_settled = [&](const Sent& sent) {
        const double age_s = now_s - sent.at_s;
        return sent.acknowledged || sent_.size() > kMaxUnresolvedPackets || age_s > kSilenceS ||
               (first_ < newest_acknowledged_ && age_s > kOvertakenS + 2.0 * rtt_s_);
    };
    while (!sent_.empty() && is_settled(sent_.front())) {
        if (!sent_.front().acknowledged) resolve(true);
        sent_.pop_front();
        ++first_;
    }
}

double SentPackets::resend_after_s() const {
    if (rtt_s_ == 0.0) return kFirstResendAfterS;
    return std::clamp(rtt_s_ + std::max(4.0 * rtt_jitter_s_, kMinResendMarginS), kMinResendAfterS,
                      kMaxResendAfterS);
}

void SentPackets::measure(double sample_s) {
    if (rtt_s_ == 0.0) {
        rtt_s_ = sample_s;
        rtt_jitter_s_ = sample_s / 2.0;
        return;
    }
    rtt_jitter_s_ += (std::abs(sample_s - rtt_s_) - rtt_jitter_s_) / 4.0;
    rtt_s_ += (sample_s - rtt_s_) / 8.0;
}

void SentPackets::resolve(bool lost) {
    resolved_ = std::min(resolved_ + 1, kLossMemoryPackets);
    loss_ += ((lost ? 1.0 : 0.0) - loss_) / static_cast<double>(resolved_);
}

}  // namespace fts::net
