// Which bodies may meet, however large, fast or far off they are: a uniform grid over the boxes
// that bodies sweep until the end of a span. A superset of all pairs whose boxes overlap, each once
// per query, in an order that depends on the calls only.
//
// The grid covers where most bodies are; coordinates beyond it count to its border cells, so that
// it is right for any extent, and its size is bound by the number of bodies however far they
// spread. A body that sweeps very many cells is kept on a list of wide ones instead, and is near to
// all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fts::physics {

template <typename Scalar>
struct Box {
    Scalar min_x_m = Scalar(0), min_y_m = Scalar(0);
    Scalar max_x_m = Scalar(0), max_y_m = Scalar(0);

    bool overlaps(const Box& other) const {
        return min_x_m <= other.max_x_m && other.min_x_m <= max_x_m && min_y_m <= other.max_y_m &&
               other.min_y_m <= max_y_m;
    }
};

template <typename Scalar>
class Broadphase {
  public:
    // So many slots need no memory beyond this, unless bodies sweep many cells.
    void reserve(std::uint32_t slots);

    // Forgets everything and fits the cells to what will be placed. `slots` is above every body's
    // index.
    void begin(std::span<const Box<Scalar>> boxes, std::uint32_t slots);

    // From now on `body` stays within `box` until the span ends. May be called again as it turns.
    void place(std::uint32_t body, const Box<Scalar>& box);

    // Calls visit(other) once for every placed body whose box overlaps `box`, except `body` itself.
    template <typename Visit>
    void for_each_near(std::uint32_t body, const Box<Scalar>& box, Visit&& visit);

  private:
    struct Axis {
        Scalar origin_m = Scalar(0);
        Scalar cells_per_m = Scalar(0);
        std::uint32_t last_cell = 0;

        std::uint32_t cell_of(Scalar x_m) const;  // never decreases with x_m
    };
    struct Cells {  // inclusive
        std::uint32_t x0, y0, x1, y1;
        std::uint64_t count() const {
            return (std::uint64_t{x1} - x0 + 1) * (std::uint64_t{y1} - y0 + 1);
        }
        bool holds(std::uint32_t x, std::uint32_t y) const {
            return x0 <= x && x <= x1 && y0 <= y && y <= y1;
        }
    };
    struct Node {
        std::uint32_t body;
        std::uint32_t next;
    };
    enum class Place : std::uint8_t { kNowhere, kInCells, kWide };

    static constexpr std::uint32_t kNoNode = 0xffffffff;
    static constexpr std::uint64_t kMaxCellsPerBody = 64;
    static constexpr std::size_t kUsualCellsPerBody = 4;

    void fit_axis(Axis& axis, Scalar low_m, Scalar high_m, Scalar cell_m, std::size_t bodies);
    Cells cells_of(const Box<Scalar>& box) const;
    template <typename Visit>
    void visit_once(std::uint32_t other, const Box<Scalar>& box, Visit& visit);

    Axis axis_[2];
    std::vector<std::uint32_t> first_node_;  // by cell
    std::vector<Node> nodes_;
    std::vector<Box<Scalar>> box_;  // by body, as are the next three
    std::vector<Cells> cells_;
    std::vector<Place> place_;
    std::vector<std::uint64_t> seen_in_query_;
    std::vector<std::uint32_t> placed_;
    std::vector<std::uint32_t> wide_;
    std::vector<Scalar> scratch_;
    std::uint64_t query_ = 0;
};

template <typename Scalar>
template <typename Visit>
void Broadphase<Scalar>::visit_once(std::uint32_t other, const Box<Scalar>& box, Visit& visit) {
    if (seen_in_query_[other] == query_) return;
    seen_in_query_[other] = query_;
    if (box.overlaps(box_[other])) visit(other);
}

template <typename Scalar>
template <typename Visit>
void Broadphase<Scalar>::for_each_near(std::uint32_t body, const Box<Scalar>& box, Visit&& visit) {
    ++query_;
    seen_in_query_[body] = query_;
    const Cells cells = cells_of(box);
    if (cells.count() > kMaxCellsPerBody) {
        for (const std::uint32_t other : placed_) visit_once(other, box, visit);
        return;
    }
    for (const std::uint32_t other : wide_) visit_once(other, box, visit);
    for (std::uint32_t y = cells.y0; y <= cells.y1; ++y) {
        for (std::uint32_t x = cells.x0; x <= cells.x1; ++x) {
            std::uint32_t node = first_node_[y * (axis_[0].last_cell + 1) + x];
            for (; node != kNoNode; node = nodes_[node].next) {
                visit_once(nodes_[node].body, box, visit);
            }
        }
    }
}

extern template class Broadphase<double>;
extern template class Broadphase<float>;

}  // namespace fts::physics
