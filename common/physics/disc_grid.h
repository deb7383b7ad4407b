// Which discs are near a place: square cells over a region, each at least as wide as the widest
// disc that is asked for, so that the nine about a place hold all it may touch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/physics/region.h"

namespace fts::physics {

class DiscGrid {
  public:
    // `discs` is about how many there will be; it bounds the number of cells.
    DiscGrid(const Region& region, double widest_radius_m, std::size_t discs);

    void clear();
    // A disc by its centre.
    void insert(std::uint32_t disc, const Vec2d& centre_m);
    // A disc of any size, in every cell that it may reach into.
    void insert_wide(std::uint32_t disc, const Vec2d& centre_m, double radius_m);

    // visit(disc) for all that a disc at `centre_m` of at most the widest radius may touch, some
    // of them more than once.
    template <typename Visit>
    void for_each_near(const Vec2d& centre_m, Visit&& visit) const;

  private:
    struct Node {
        std::uint32_t disc;
        std::uint32_t next;
    };
    static constexpr std::uint32_t kNoNode = 0xffffffff;

    std::int64_t cell_of(double x_m, int axis) const;
    std::size_t wrapped(std::int64_t cell, int axis) const;
    bool has(std::int64_t cell, int axis) const {
        return is_periodic_ || (cell >= 0 && cell < cells_[axis]);
    }
    void put(std::uint32_t disc, std::int64_t x, std::int64_t y);

    bool is_periodic_;
    Vec2d min_m_;
    Vec2d cells_per_m_;
    std::int64_t cells_[2] = {1, 1};
    std::vector<std::uint32_t> first_node_;
    std::vector<Node> nodes_;
};

template <typename Visit>
void DiscGrid::for_each_near(const Vec2d& centre_m, Visit&& visit) const {
    const std::int64_t middle_x = cell_of(centre_m.x(), 0);
    const std::int64_t middle_y = cell_of(centre_m.y(), 1);
    for (std::int64_t y = middle_y - 1; y <= middle_y + 1; ++y) {
        if (!has(y, 1)) continue;
        for (std::int64_t x = middle_x - 1; x <= middle_x + 1; ++x) {
            if (!has(x, 0)) continue;
            const std::size_t cell =
                wrapped(y, 1) * static_cast<std::size_t>(cells_[0]) + wrapped(x, 0);
            for (std::uint32_t node = first_node_[cell]; node != kNoNode;
                 node = nodes_[node].next) {
                visit(nodes_[node].disc);
            }
        }
    }
}

}  // namespace fts::physics
