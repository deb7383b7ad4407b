#include "server/lab/svg_labels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fts::lab {
namespace {

constexpr double kNearGapPx = 11.0;
constexpr int kDirections = 16;
constexpr int kRefinements = 4;

// A box of the label's size whose nearest edge or corner is `gap` from the point, in a direction.
PixelBox box_towards(const LabelWish& wish, double cosine, double sine, double gap) {
    const double x = wish.x + cosine * gap + cosine * wish.width / 2;
    const double y = wish.y + sine * gap + sine * wish.height / 2;
    return {x - wish.width / 2, y - wish.height / 2, x + wish.width / 2, y + wish.height / 2};
}

double common_area(const PixelBox& a, const PixelBox& b) {
    const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
    const double height = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
    return width > 0 && height > 0 ? width * height : 0.0;
}

// How much of a segment is inside a box: Liang and Barsky.
double length_inside(const PixelSegment& line, const PixelBox& box) {
    const double dx = line.x2 - line.x1, dy = line.y2 - line.y1;
    double from = 0.0, to = 1.0;
    const auto clip = [&](double direction, double distance) {
        if (direction == 0.0) return distance >= 0.0;
        const double at = distance / direction;
        if (direction < 0) from = std::max(from, at);
        if (direction > 0) to = std::min(to, at);
        return from <= to;
    };
    const bool hit = clip(-dx, line.x1 - box.left) && clip(dx, box.right - line.x1) &&
                     clip(-dy, line.y1 - box.top) && clip(dy, box.bottom - line.y1);
    return hit ? (to - from) * std::hypot(dx, dy) : 0.0;
}

class Placing {
  public:
    Placing(const std::vector<LabelWish>& wishes, const PixelBox& room,
            const std::vector<PixelBox>& obstacles, const std::vector<PixelSegment>& lines)
        : wishes_(wishes), room_(room), obstacles_(obstacles), lines_(lines) {
        placed_.resize(wishes.size());
        is_placed_.assign(wishes.size(), false);
    }

    std::vector<PlacedLabel> run() {
        std::vector<std::size_t> order(wishes_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return wishes_[a].width > wishes_[b].width;
        });
        for (int round = 0; round < kRefinements; ++round) {
            for (const std::size_t i : order) place(i);
        }
        return placed_;
    }

  private:
    void place(std::size_t i) {
        double best = std::numeric_limits<double>::infinity();
        PlacedLabel chosen = placed_[i];
        for (double gap = kNearGapPx; gap <= 150.0; gap += gap < 30 ? 7.0 : 14.0) {
            for (int k = 0; k < kDirections; ++k) {
                const double angle = 2 * 3.14159265358979 * k / kDirections;
                const PixelBox box = box_towards(wishes_[i], std::cos(angle), std::sin(angle), gap);
                const double cost = cost_of(i, box, gap, k);
                if (cost < best - 1e-6) {
                    best = cost;
                    chosen = {box, gap > 17.0};
                }
            }
            // Farther away only gets dearer.
            if (best < 0.6 * gap) break;
        }
        placed_[i] = chosen;
        is_placed_[i] = true;
    }

    double cost_of(std::size_t i, const PixelBox& box, double gap, int direction) const {
        double cost = 0.6 * gap + (direction % 4 == 0 ? 0.0 : 0.4) + (direction == 0 ? -0.5 : 0.0);
        const double outside =
            std::max(0.0, room_.left - box.left) + std::max(0.0, box.right - room_.right) +
            std::max(0.0, room_.top - box.top) + std::max(0.0, box.bottom - room_.bottom);
        cost += 1e5 * outside;
        for (std::size_t j = 0; j < wishes_.size(); ++j) {
            if (j != i && is_placed_[j]) cost += 200.0 * common_area(box, placed_[j].box);
        }
        for (const PixelBox& obstacle : obstacles_) cost += 3.0 * common_area(box, obstacle);
        for (const PixelSegment& line : lines_) cost += 1.0 * length_inside(line, box);
        return cost;
    }

    const std::vector<LabelWish>& wishes_;
    const PixelBox room_;
    const std::vector<PixelBox>& obstacles_;
    const std::vector<PixelSegment>& lines_;
    std::vector<PlacedLabel> placed_;
    std::vector<bool> is_placed_;
};

// Neighbours that would be too near share a block, which sits where its members want it on average.
struct Block {
    double wish = 0.0;  // of its first member's place
    double members = 0.0;
};

}  // namespace

std::vector<PlacedLabel> place_labels(const std::vector<LabelWish>& wishes, const PixelBox& room,
                                      const std::vector<PixelBox>& obstacles,
                                      const std::vector<PixelSegment>& lines) {
    return Placing(wishes, room, obstacles, lines).run();
}

std::vector<double> spread_out(const std::vector<double>& wishes, double apart, double top,
                               double bottom) {
    std::vector<std::size_t> order(wishes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return wishes[a] < wishes[b]; });
    const auto height_of = [&](const Block& block) { return (block.members - 1.0) * apart; };
    const auto kept_inside = [&](Block block) {
        block.wish = std::max(top, std::min(block.wish, bottom - height_of(block)));
        return block;
    };
    std::vector<Block> blocks;
    for (const std::size_t i : order) {
        blocks.push_back(kept_inside({wishes[i], 1.0}));
        while (blocks.size() > 1) {
            const Block last = blocks.back();
            Block& before = blocks[blocks.size() - 2];
            if (before.wish + before.members * apart <= last.wish) break;
            const double members = before.members + last.members;
            before.wish = (before.wish * before.members +
                           (last.wish - before.members * apart) * last.members) /
                          members;
            before.members = members;
            before = kept_inside(before);
            blocks.pop_back();
        }
    }
    std::vector<double> places(wishes.size());
    std::size_t next = 0;
    for (const Block& block : blocks) {
        for (double k = 0; k < block.members; k += 1.0) {
            places[order[next++]] = block.wish + k * apart;
        }
    }
    return places;
}

}  // namespace fts::lab
