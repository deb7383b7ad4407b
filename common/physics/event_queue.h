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
        if (time_s != other.time_s) [[likely]]
            return time_s > other.time_s;
        return std::tie(time_s, kind, a, b, image) >
               std::tie(other.time_s, other.kind, other.a, other.b, other.image);
    }
};

// The span is cut into slices, as many as suit the number of events in the span before. Only those
// of the present slice are kept in order, and in a heap if they are many. What is pushed before
// anything is taken is sorted by slices at once; what comes later is in a list of its slice. Either
// costs the same however many there are. No allocation after warm-up.
template <typename Event>
class EventQueue {
  public:
    using Scalar = decltype(Event::time_s);

    // So many bodies usually need no more memory than this.
    void reserve(std::uint32_t bodies);
    // Forgets everything. Events will be from `from_s` to `until_s`, or but for round-off.
    void begin(Scalar from_s, Scalar until_s);
    void push(const Event& event);

    bool empty() {
        if (few_count_ > 0 && !is_open_) return false;
        if (many_.empty() || is_open_) go_on();
        return few_count_ == 0 && many_.empty();
    }
    // Of a queue that is not empty, as empty() has just told.
    const Event& next() const { return few_count_ > 0 ? few_[few_count_ - 1] : many_.front(); }
    Event pop() {
        if (few_count_ > 0) return few_[--few_count_];
        return pop_of_many();
    }

    // Which slice is the present one, and visit(event) for those of another one that are known yet.
    std::uint32_t slice() const { return slice_; }
    template <typename Visit>
    void for_each_in(std::uint32_t slice, Visit&& visit) const {
        if (is_open_ || slice >= first_.size()) return;
        for (std::uint32_t at = sorted_end_[slice]; at < sorted_end_[slice + 1]; ++at) {
            visit(sorted_[at]);
        }
        for (std::uint32_t node = first_[slice]; node != kNoNode; node = nodes_[node].next) {
            visit(nodes_[node].event);
        }
    }

  private:
    static constexpr std::uint32_t kNoNode = 0xffffffff;
    struct Node {
        Event event;
        std::uint32_t next = kNoNode;
    };
    static constexpr std::uint32_t kEventsPerSlice = 2;
    static constexpr std::uint32_t kMostFew = 16;
    static constexpr std::size_t kUsualEventsPerBody = 4;
    static constexpr std::uint32_t kMostSlices = 1U << 20;

    // Never decreases with the time.
    std::uint32_t slice_of(Scalar time_s) const;
    void push_now(const Event& event);
    void go_on();
    void sort_batch();
    Event pop_of_many();

    // Of the present slice, and earlier: the few have the earliest at the end, and are none while
    // there are many, which are a heap.
    Event few_[kMostFew];
    std::uint32_t few_count_ = 0;
    std::vector<Event> many_;
    // Of all slices, as long as nothing is taken; then, by slice.
    std::vector<Event> batch_, sorted_;
    std::vector<std::uint32_t> sorted_end_;  // of the slice before
    bool is_open_ = false;
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
    many_.reserve(bodies);
    first_.reserve(bodies);
    sorted_end_.reserve(bodies + 2);
    for (std::vector<Event>* all : {&batch_, &sorted_}) all->reserve(kUsualEventsPerBody * bodies);
    nodes_.reserve(kUsualEventsPerBody * bodies);
}

template <typename Event>
void EventQueue<Event>::begin(Scalar from_s, Scalar until_s) {
    const std::uint32_t slices = std::clamp(pushed_ / kEventsPerSlice, 1U, kMostSlices);
    few_count_ = 0;
    many_.clear();
    nodes_.clear();
    batch_.clear();
    first_.assign(slices, kNoNode);
    is_open_ = true;
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
    if (is_open_) return batch_.push_back(event);
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
void EventQueue<Event>::push_now(const Event& event) {
    if (few_count_ < kMostFew && many_.empty()) {
        std::uint32_t at = few_count_++;
        for (; at > 0 && event > few_[at - 1]; --at) few_[at] = few_[at - 1];
        few_[at] = event;
        return;
    }
    const auto add = [&](const Event& one) {
        many_.push_back(one);
        std::push_heap(many_.begin(), many_.end(), std::greater<>());
    };
    std::for_each(few_, few_ + std::exchange(few_count_, 0), add);
    add(event);
}

template <typename Event>
void EventQueue<Event>::go_on() {
    if (is_open_) sort_batch();
    while (few_count_ == 0 && many_.empty() && waiting_ > 0) {
        ++slice_;
        for (std::uint32_t at = sorted_end_[slice_]; at < sorted_end_[slice_ + 1]; ++at) {
            push_now(sorted_[at]);
            --waiting_;
        }
        std::uint32_t node = std::exchange(first_[slice_], kNoNode);
        while (node != kNoNode) {
            push_now(nodes_[node].event);
            --waiting_;
            const std::uint32_t next = std::exchange(nodes_[node].next, free_);
            free_ = std::exchange(node, next);
        }
    }
}

// Counts lie two places on, so that they turn into ends while slices are filled.
template <typename Event>
void EventQueue<Event>::sort_batch() {
    is_open_ = false;
    sorted_end_.assign(first_.size() + 2, 0);
    for (const Event& event : batch_) ++sorted_end_[slice_of(event.time_s) + 2];
    for (std::size_t slice = 2; slice < sorted_end_.size(); ++slice) {
        sorted_end_[slice] += sorted_end_[slice - 1];
    }
    sorted_.resize(batch_.size());
    for (const Event& event : batch_) {
        sorted_[sorted_end_[slice_of(event.time_s) + 1]++] = event;
    }
    waiting_ = static_cast<std::uint32_t>(batch_.size()) - sorted_end_[1];
    for (std::uint32_t at = 0; at < sorted_end_[1]; ++at) push_now(sorted_[at]);
}

template <typename Event>
Event EventQueue<Event>::pop_of_many() {
    std::pop_heap(many_.begin(), many_.end(), std::greater<>());
    const Event event = many_.back();
    many_.pop_back();
    return event;
}

}  // namespace fts::physics
