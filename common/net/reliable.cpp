#include "common/net/reliable.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace fts::net {
namespace {

constexpr double kMinWindowFragments = 4.0;
// Each time a fragment is sent again the wait doubles, so often at most.
constexpr int kMaxDoublings = 3;

}  // namespace

bool ReliableSender::queue(Bytes message) {
    const std::size_t count =
        std::max<std::size_t>(1, (message.size() + kFragmentBytes - 1) / kFragmentBytes);
    if (message.size() > kMaxMessageBytes || queued_bytes_ + message.size() > kMaxQueuedBytes ||
        queue_.size() + count > kMaxQueuedFragments) {
        return false;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Bytes rest = message.subspan(i * kFragmentBytes);
        const Bytes piece = rest.first(std::min(rest.size(), kFragmentBytes));
        Queued queued;
        queued.fragment = {next_++, i + 1 == count, {piece.begin(), piece.end()}};
        queue_.push_back(std::move(queued));
    }
    queued_bytes_ += message.size();
    return true;
}

void ReliableSender::update(double now_s, double resend_after_s) {
    const double elapsed_s = updated_at_s_ ? std::max(0.0, now_s - *updated_at_s_) : 0.0;
    updated_at_s_ = now_s;
    resend_after_s_ = resend_after_s;
    allowance_bytes_ =
        std::min(kReliableBurstBytes, allowance_bytes_ + elapsed_s * kReliableBytesPerS);
}

const Fragment* ReliableSender::due(double now_s, std::size_t room) {
    if (allowance_bytes_ <= 0.0) return nullptr;
    const std::size_t reach = std::min(queue_.size(), kFragmentWindow);
    for (std::size_t i = 0; i < reach; ++i) {
        const Queued& queued = queue_[i];
        if (queued.acknowledged || queued.fragment.bytes.size() > room) continue;
        const bool is_new = queued.times_sent == 0;
        if (is_new && static_cast<double>(under_way_) >= window_) continue;
        if (is_new || is_overdue(queued, now_s)) return &queued.fragment;
    }
    return nullptr;
}

void ReliableSender::mark_sent(std::uint64_t number, double now_s) {
    assert(number >= first_ && number < next_);
    Queued& queued = queue_[number - first_];
    if (queued.times_sent == 0) {
        ++under_way_;
    } else {
        slow_down(now_s);
    }
    ++queued.times_sent;
    queued.sent_at_s = now_s;
    allowance_bytes_ -= static_cast<double>(queued.fragment.bytes.size() + 1);
}

void ReliableSender::acknowledge(std::uint64_t number) {
    if (number < first_ || number >= next_) return;
    Queued& acknowledged = queue_[number - first_];
    if (acknowledged.acknowledged) return;
    acknowledged.acknowledged = true;
    queued_bytes_ -= acknowledged.fragment.bytes.size();
    acknowledged.fragment.bytes = {};
    --under_way_;
    window_ = std::min(static_cast<double>(kFragmentWindow), window_ + 1.0 / window_);
    while (!queue_.empty() && queue_.front().acknowledged) {
        queue_.pop_front();
        ++first_;
    }
}

bool ReliableSender::is_overdue(const Queued& queued, double now_s) const {
    const int doublings = std::min(queued.times_sent - 1, kMaxDoublings);
    return now_s - queued.sent_at_s >= std::ldexp(resend_after_s_, doublings);
}

void ReliableSender::slow_down(double now_s) {
    if (slowed_at_s_ >= 0.0 && now_s - slowed_at_s_ < resend_after_s_) return;
    slowed_at_s_ = now_s;
    window_ = std::max(kMinWindowFragments, window_ / 2.0);
}

bool ReliableReceiver::accept(std::uint64_t number, bool ends_message, Bytes bytes,
                              std::vector<std::vector<std::uint8_t>>& messages) {
    if (bytes.size() > kFragmentBytes || (!ends_message && bytes.size() < kFragmentBytes)) {
        return false;
    }
    if (number < next_) return true;
    if (number - next_ >= kFragmentWindow) return false;
    auto& slot = waiting_[number % kFragmentWindow];
    if (!slot) slot = Fragment{number, ends_message, {bytes.begin(), bytes.end()}};

    for (auto* ready = &waiting_[next_ % kFragmentWindow]; *ready;
         ready = &waiting_[next_ % kFragmentWindow]) {
        const Fragment& fragment = **ready;
        if (message_.size() + fragment.bytes.size() > kMaxMessageBytes) return false;
        message_.insert(message_.end(), fragment.bytes.begin(), fragment.bytes.end());
        if (fragment.ends_message) {
            messages.push_back(std::move(message_));
            message_.clear();
        }
        ready->reset();
        ++next_;
    }
    return true;
}

}  // namespace fts::net
