// What is predicted to happen, earliest first. Events at the same time come in a fixed order: ball
// against ball, walls, falls; then lower indices first. An event is stale once anything has
// happened to a body of its since.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

namespace fts::physics {

enum class EventKind : std::uint8_t { kBall, kWall, kFall };

// Which image of one body meets another one, where there is but one.
struct OnlyImage {
    OnlyImage operator-() const { return {}; }
    friend auto operator<=>(const OnlyImage&, const OnlyImage&) = default;
};

template <typename Scalar, typename Image = OnlyImage>
struct Event {
    Scalar time_s = Scalar(0);
    EventKind kind = EventKind::kBall;
    std::uint32_t a = 0;
    std::uint32_t b = 0;        // the other ball, or the side of the box: -x, +x, -y, +y
    std::uint32_t count_a = 0;  // what had happened to `a` when this was predicted
    std::uint32_t count_b = 0;
    [[no_unique_address]] Image image = {};

    bool operator>(const Event& other) const {
        return std::tie(time_s, kind, a, b, image) >
               std::tie(other.time_s, other.kind, other.a, other.b, other.image);
    }
};

// The span is cut into slices, as many as there were events in the span before. Only those of the
// present slice are kept in order, as a heap; a later one is in a list of its slice, which costs
// the same however many there are. No allocation after warm-up.
template <typename Event>
class EventQueue {
  public:
    using Scalar = decltype(Event::time_s);

    // So many bodies usually need no more memory than this.
    void reserve(std::uint32_t bodies);
    // Forgets everything. Events will be from `from_s` to `until_s`, or but for round-off.
    void begin(Scalar from_s, Scalar until_s);
    void push(const Event& event);

    bool empty();
    // Of a queue that is not empty, as empty() has just told.
    const Event& next() const { return heap_.front(); }
    Event pop();

  private:
    static constexpr std::uint32_t kNoNode = 0xffffffff;
    struct Node {
        Event event;
        std::uint32_t next = kNoNode;
    };
    static constexpr std::uint32_t kEventsPerSlice = 4;
    static constexpr std::size_t kUsualEventsPerBody = 4;
    static constexpr std::uint32_t kMostSlices = 1U << 20;

    // Never decreases with the time.
    std::uint32_t slice_of(Scalar time_s) const;
    void push_now(const Event& event) {
        heap_.push_back(event);
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }

    std::vector<Event> heap_;
    std::vector<std::uint32_t> first_;  // node by slice
    std::vector<Node> nodes_;
    std::uint32_t free_ = kNoNode;
    std::uint32_t slice_ = 0;    // the present one
    std::uint32_t waiting_ = 0;  // in later ones
    std::uint32_t pushed_ = 0;
    Scalar from_s_ = Scalar(0);
    Scalar slices_per_s_ = Scalar(0);
};

template <typename Event>
void EventQueue<Event>::reserve(std::uint32_t bodies) {
    heap_.reserve(bodies);
    first_.reserve(bodies);
    nodes_.reserve(kUsualEventsPerBody * bodies);
}

template <typename Event>
void EventQueue<Event>::begin(Scalar from_s, Scalar until_s) {
    const std::uint32_t slices = std::clamp(pushed_ / kEventsPerSlice, 1U, kMostSlices);
    heap_.clear();
    nodes_.clear();
    first_.assign(slices, kNoNode);
    free_ = kNoNode;
    slice_ = waiting_ = pushed_ = 0;
    from_s_ = from_s;
    const Scalar span_s = until_s - from_s;
    slices_per_s_ = span_s > Scalar(0) ? static_cast<Scalar>(slices) / span_s : Scalar(0);
}

template <typename Event>
std::uint32_t EventQueue<Event>::slice_of(Scalar time_s) const {
    const Scalar slice = (time_s - from_s_) * slices_per_s_;
    const auto last = static_cast<std::uint32_t>(first_.size() - 1);
    if (!(slice > Scalar(0))) return 0;
    return slice < static_cast<Scalar>(last) ? static_cast<std::uint32_t>(slice) : last;
}

template <typename Event>
void EventQueue<Event>::push(const Event& event) {
    ++pushed_;
    const std::uint32_t slice = slice_of(event.time_s);
    if (slice <= slice_) return push_now(event);
    std::uint32_t node = free_;
    if (node == kNoNode) {
        node = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
    } else {
        free_ = nodes_[node].next;
    }
    nodes_[node] = {event, first_[slice]};
    first_[slice] = node;
    ++waiting_;
}

template <typename Event>
bool EventQueue<Event>::empty() {
    while (heap_.empty() && waiting_ > 0) {
        std::uint32_t node = std::exchange(first_[++slice_], kNoNode);
        while (node != kNoNode) {
            push_now(nodes_[node].event);
            --waiting_;
            const std::uint32_t next = std::exchange(nodes_[node].next, free_);
            free_ = std::exchange(node, next);
        }
    }
    return heap_.empty();
}

template <typename Event>
Event EventQueue<Event>::pop() {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const Event event = heap_.back();
    heap_.pop_back();
    return event;
}

}  // namespace fts::physics
