// Where the labels of a chart go, so that they do not cover each other, the points, or the edge.
#pragma once

#include <string>
#include <vector>

namespace fts::lab {

struct PixelBox {
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
    bool overlaps(const PixelBox& other) const {
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
};

struct PixelSegment {
    double x1 = 0.0, y1 = 0.0, x2 = 0.0, y2 = 0.0;
};

struct LabelWish {
    double x = 0.0, y = 0.0;  // of what it names
    double width = 0.0, height = 0.0;
};

struct PlacedLabel {
    PixelBox box;
    bool far = false;  // a line should lead from it to what it names
};

// One box a wish, in order, inside `room`. Boxes never overlap each other unless the room is too
// small for all; they keep clear of `obstacles`, and of `lines` where they can.
std::vector<PlacedLabel> place_labels(const std::vector<LabelWish>& wishes, const PixelBox& room,
                                      const std::vector<PixelBox>& obstacles,
                                      const std::vector<PixelSegment>& lines);

// Heights in a column: each as near to its wish as distances of `apart` between neighbours allow,
// all within [top, bottom]. In the order of the wishes.
std::vector<double> spread_out(const std::vector<double>& wishes, double apart, double top,
                               double bottom);

}  // namespace fts::lab
