// Where values lie on an axis, and its ticks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/lab/svg_plot.h"

namespace fts::lab {

struct Tick {
    double value = 0.0;
    std::string label;               // empty: minor
    std::optional<int> power_of_10;  // written as 10 with an exponent instead of `label`
    bool major() const { return power_of_10 || !label.empty(); }
};

class AxisScale {
  public:
    // `values` are what the axis must hold; those that it cannot show are passed over.
    AxisScale(const Axis& axis, const std::vector<double>& values);

    void span_pixels(double from_px, double to_px);

    bool shows(double value) const;  // and is inside
    double pixel_of(double value) const;
    double min() const { return min_; }
    double max() const { return max_; }
    std::vector<Tick> ticks() const;  // ascending, inside

  private:
    bool can_show(double value) const;
    double along(double value) const;
    void round_outwards(const Axis& axis);
    std::vector<Tick> linear_ticks() const;
    std::vector<Tick> log_ticks() const;

    Scale scale_;
    double min_ = 0.0, max_ = 1.0;
    double from_px_ = 0.0, to_px_ = 1.0;
};

}  // namespace fts::lab
