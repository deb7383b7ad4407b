// What is predicted to happen, earliest first. Events at the same time come in a fixed order: ball
// against ball, walls, falls; then lower indices first. An event is stale once anything has
// happened to a body of its since.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <functional>
#include <tuple>
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

template <typename Event>
class EventQueue {
  public:
    bool empty() const { return heap_.empty(); }
    void clear() { heap_.clear(); }

    void push(const Event& event) {
        heap_.push_back(event);
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }

    const Event& next() const { return heap_.front(); }

    Event pop() {
        std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
        const Event event = heap_.back();
        heap_.pop_back();
        return event;
    }

  private:
    std::vector<Event> heap_;
};

}  // namespace fts::physics
