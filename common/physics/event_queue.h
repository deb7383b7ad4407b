// What is predicted to happen, earliest first. Events at the same time come in a fixed order: ball
// against ball, walls, falls; then lower indices first. An event is stale once anything has
// happened to a body of its since.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <tuple>
#include <vector>

namespace fts::physics {

enum class EventKind : std::uint8_t { kBall, kWall, kFall };

template <typename Scalar>
struct Event {
    Scalar time_s;
    EventKind kind;
    std::uint32_t a;
    std::uint32_t b;        // the other ball, or the side of the box: -x, +x, -y, +y
    std::uint32_t count_a;  // what had happened to `a` when this was predicted
    std::uint32_t count_b;

    bool operator>(const Event& other) const {
        return std::tie(time_s, kind, a, b) > std::tie(other.time_s, other.kind, other.a, other.b);
    }
};

template <typename Scalar>
class EventQueue {
  public:
    bool empty() const { return heap_.empty(); }
    void clear() { heap_.clear(); }

    void push(const Event<Scalar>& event) {
        heap_.push_back(event);
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }

    Event<Scalar> pop() {
        std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
        const Event<Scalar> event = heap_.back();
        heap_.pop_back();
        return event;
    }

  private:
    std::vector<Event<Scalar>> heap_;
};

}  // namespace fts::physics
