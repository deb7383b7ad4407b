// The space that swept bodies move in. Open: there is one of everybody. Torus: opposite sides of a
// box are one, and everybody has an image in each copy of the box.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/physics/broadphase.h"
#include "common/physics/event_queue.h"
#include "common/physics/periodic.h"
#include "common/physics/solver.h"

namespace fts::physics {

// For the lower of two slots, whole boxes by which it is moved to meet the higher one.
struct LatticeImage {
    std::int32_t x = 0;
    std::int32_t y = 0;
    LatticeImage operator-() const { return {-x, -y}; }
    bool is_upper() const { return y > 0 || (y == 0 && x > 0); }
    friend auto operator<=>(const LatticeImage&, const LatticeImage&) = default;
};

template <typename Scalar>
class OpenSpace {
  public:
    using Vec = Vec2<Scalar>;
    using Image = OnlyImage;
    static constexpr bool kHasImages = false;

    static Vec moved(const Vec& position_m, Image) { return position_m; }
    // Where two bodies that meet are, as the record shows it.
    static std::pair<Vec, Vec> shown(const Vec& a_m, const Vec& b_m, Image) { return {a_m, b_m}; }
    void cover(const Box<Scalar>&) {}
    template <typename Visit>
    void for_each_image(const Box<Scalar>& box, Visit&& visit) const {
        visit(box, Image{});
    }
};

template <typename Scalar>
class TorusSpace {
  public:
    using Vec = Vec2<Scalar>;
    using Image = LatticeImage;
    static constexpr bool kHasImages = true;
    // Nobody moves further at once, so that few images come into question.
    static constexpr double kLongestWayInBoxes = 0.25;

    void begin(const typename Model<Scalar>::Box& box) {
        box_ = box;
        extent_m_ = box.extent_m();
    }
    // Where everybody is when a stretch begins.
    Box<Scalar> box() const {
        return {box_.min_m.x(), box_.min_m.y(), box_.max_m.x(), box_.max_m.y()};
    }
    // From now on this is covered, and nothing else.
    void cover_only(const Box<Scalar>& box) { covered_ = box; }
    // No image of a box overlaps what is covered when it keeps within this one by `margin_m`.
    Box<Scalar> without_images(Scalar margin_m) const {
        return {covered_.max_x_m - extent_m_.x() + margin_m,
                covered_.max_y_m - extent_m_.y() + margin_m,
                covered_.min_x_m + extent_m_.x() - margin_m,
                covered_.min_y_m + extent_m_.y() - margin_m};
    }
    // And this.
    void cover(const Box<Scalar>& box) {
        covered_ = {
            std::min(covered_.min_x_m, box.min_x_m), std::min(covered_.min_y_m, box.min_y_m),
            std::max(covered_.max_x_m, box.max_x_m), std::max(covered_.max_y_m, box.max_y_m)};
    }

    Vec home(const Vec& position_m) const { return wrapped<Scalar>(position_m, box_); }
    Vec moved(const Vec& position_m, Image image) const {
        return {position_m.x() + static_cast<Scalar>(image.x) * extent_m_.x(),
                position_m.y() + static_cast<Scalar>(image.y) * extent_m_.y()};
    }
    std::pair<Vec, Vec> shown(const Vec& a_m, const Vec& b_m, Image image) const {
        const Vec a = home(a_m);
        return {a, a - (moved(a_m, image) - b_m)};
    }

    // How many boxes long a way at this velocity is in one second.
    Scalar boxes_per_s(const Vec& velocity_mps) const {
        return std::max(std::abs(velocity_mps.x()) / extent_m_.x(),
                        std::abs(velocity_mps.y()) / extent_m_.y());
    }

    // visit(moved box, image) for each image of the box that may overlap what is covered.
    template <typename Visit>
    void for_each_image(const Box<Scalar>& box, Visit&& visit) const {
        const auto [first_x, last_x] =
            range(box.min_x_m, box.max_x_m, covered_.min_x_m, covered_.max_x_m, extent_m_.x());
        const auto [first_y, last_y] =
            range(box.min_y_m, box.max_y_m, covered_.min_y_m, covered_.max_y_m, extent_m_.y());
        for (std::int32_t y = first_y; y <= last_y; ++y) {
            for (std::int32_t x = first_x; x <= last_x; ++x) {
                const Vec low = moved({box.min_x_m, box.min_y_m}, {x, y});
                const Vec high = moved({box.max_x_m, box.max_y_m}, {x, y});
                visit(Box<Scalar>{low.x(), low.y(), high.x(), high.y()}, Image{x, y});
            }
        }
    }

  private:
    static std::pair<std::int32_t, std::int32_t> range(Scalar low, Scalar high, Scalar covered_low,
                                                       Scalar covered_high, Scalar extent) {
        return {static_cast<std::int32_t>(std::ceil((covered_low - high) / extent)),
                static_cast<std::int32_t>(std::floor((covered_high - low) / extent))};
    }

    typename Model<Scalar>::Box box_;
    Vec extent_m_ = Vec::Zero();
    Box<Scalar> covered_;
};

}  // namespace fts::physics
