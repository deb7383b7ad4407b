#include "common/net/simulated_link.h"

#include <algorithm>
#include <map>
#include <random>

namespace fts::net {
namespace {

// What a link may hold back; more is lost, as in any full buffer.
constexpr std::size_t kMaxHeldDatagrams = 65536;

}  // namespace

struct SimulatedLink::Impl {
    struct Held {
        Address address;
        std::vector<std::uint8_t> bytes;
    };
    // By the time they are due; those due at once stay in order.
    using Queue = std::multimap<double, Held>;

    // The same number from a seed on every platform, unlike the standard distributions.
    double uniform() { return static_cast<double>(random() >> 11) * 0x1p-53; }

    bool hold_back(Queue& queue, const Address& address, std::span<const std::uint8_t> datagram) {
        if (uniform() < conditions.loss || queue.size() >= kMaxHeldDatagrams) return false;
        const int copies = uniform() < conditions.duplicate ? 2 : 1;
        for (int i = 0; i < copies; ++i) {
            const double jitter_s = conditions.jitter_s * (2.0 * uniform() - 1.0);
            const double due_s = now_s + std::max(0.0, conditions.delay_s + jitter_s);
            queue.emplace(due_s, Held{address, {datagram.begin(), datagram.end()}});
        }
        return true;
    }

    // Hands over what is due. What that brings about is held back in its turn.
    template <typename Deliver>
    void release(Queue& queue, Deliver deliver) {
        while (!queue.empty() && queue.begin()->first <= now_s) {
            const auto held = queue.extract(queue.begin());
            deliver(held.mapped());
        }
    }

    std::unique_ptr<Transport> inner;
    LinkConditions conditions;
    std::mt19937_64 random;
    Queue outgoing, incoming;
    double now_s = 0.0;
};

SimulatedLink::SimulatedLink(std::unique_ptr<Transport> inner, const LinkConditions& conditions)
    : impl_(std::make_unique<Impl>()) {
    impl_->inner = std::move(inner);
    impl_->conditions = conditions;
    impl_->random.seed(conditions.seed);
}

SimulatedLink::~SimulatedLink() = default;

bool SimulatedLink::send(const Address& to, std::span<const std::uint8_t> datagram) {
    if (datagram.size() > kMaxDatagramBytes) return false;
    impl_->hold_back(impl_->outgoing, to, datagram);
    return true;
}

void SimulatedLink::flush() {
    impl_->inner->flush();
}

DropCounters SimulatedLink::drops() const {
    return impl_->inner->drops();
}

std::size_t SimulatedLink::poll(double now_s, const Receiver& receiver) {
    Impl& impl = *impl_;
    impl.now_s = std::max(impl.now_s, now_s);
    impl.release(impl.outgoing,
                 [&](const Impl::Held& held) { impl.inner->send(held.address, held.bytes); });
    impl.inner->poll(now_s, [&](const Address& from, std::span<const std::uint8_t> datagram) {
        impl.hold_back(impl.incoming, from, datagram);
    });
    std::size_t count = 0;
    impl.release(impl.incoming, [&](const Impl::Held& held) {
        ++count;
        receiver(held.address, held.bytes);
    });
    return count;
}

}  // namespace fts::net
