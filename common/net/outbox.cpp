#include "common/net/outbox.h"

#include <algorithm>
#include <cassert>
#include <cerrno>

#include "common/net/drops.h"

namespace fts::net {
namespace {

bool asks_for_a_pause(int error) {
    return error == EAGAIN || error == EWOULDBLOCK || error == ENOBUFS || error == ENOMEM;
}

}  // namespace

// Memory that is not written to is not taken from the system: a quiet socket costs little.
Outbox::Outbox(DropCounters& drops)
    : drops_(drops), slots_(std::make_unique_for_overwrite<Slot[]>(kMaxWaitingDatagrams)) {}

void Outbox::add(const Address& to, std::span<const std::uint8_t> bytes) {
    assert(!full() && bytes.size() <= kMaxDatagramBytes);
    Slot& slot = slots_[count_];
    std::ranges::copy(bytes, slot.begin());
    waiting_[count_++] = {to, std::span(slot).first(bytes.size())};
}

void Outbox::send(const SendSome& send_some) {
    std::size_t first = 0;
    bool was_refused = false;
    while (first < count_) {
        const Progress progress = send_some(std::span(waiting_).subspan(first, count_ - first));
        assert(progress.sent <= count_ - first);
        for (std::size_t i = 0; i < progress.sent; ++i) {
            sent_bytes_ += waiting_[first + i].bytes.size();
        }
        first += progress.sent;
        sent_count_ += progress.sent;
        if (progress.sent > 0) was_refused = false;
        if (first == count_ || progress.error == 0 || progress.error == EINTR) continue;
        if (asks_for_a_pause(progress.error)) break;
        if (progress.error == ECONNREFUSED && !was_refused) {
            ++drops_[drop::kPeerUnreachable];
            was_refused = true;
            continue;
        }
        ++drops_[drop::kSendFailed];
        ++first;
        was_refused = false;
    }
    keep_from(first);
}

void Outbox::keep_from(std::size_t first) {
    const std::size_t kept = count_ - first;
    for (std::size_t i = 0; first > 0 && i < kept; ++i) {
        const Datagram& datagram = waiting_[first + i];
        std::ranges::copy(datagram.bytes, slots_[i].begin());
        waiting_[i] = {datagram.to, std::span(slots_[i]).first(datagram.bytes.size())};
    }
    count_ = kept;
}

}  // namespace fts::net
