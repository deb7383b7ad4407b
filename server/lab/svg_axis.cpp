#include "server/lab/svg_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/lab/digits.h"

namespace fts::lab {
namespace {

// 1, 2 or 5 times a power of ten, so that a span has about `count` of it.
double nice_step(double span, double count) {
    const double raw = span / count;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    const double lead = raw / power;
    return power * (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0);
}

int decade_below(double value) {
    return static_cast<int>(std::floor(std::log10(value) + 1e-9));
}

int decade_above(double value) {
    return static_cast<int>(std::ceil(std::log10(value) - 1e-9));
}

// As a number while that is short, and as a power of ten beyond.
void write(Tick& tick, int power, bool powers_only) {
    if (powers_only) {
        tick.power_of_10 = power;
    } else {
        tick.label = with_digits("%.6g", tick.value);
    }
}

}  // namespace

AxisScale::AxisScale(const Axis& axis, const std::vector<double>& values) : scale_(axis.scale) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : values) {
        if (!can_show(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    if (axis.min && can_show(*axis.min)) low = *axis.min;
    if (axis.max && can_show(*axis.max)) high = *axis.max;
    const bool log = scale_ == Scale::kLog;
    if (!(low <= high)) {
        low = log ? 0.1 : 0.0;
        high = log ? 10.0 : 1.0;
    }
    if (low == high) {
        low = log ? low / 10.0 : low - std::max(1.0, std::abs(low));
        high = log ? high * 10.0 : high + std::max(1.0, std::abs(high));
    }
    min_ = low;
    max_ = high;
    round_outwards(axis);
}

void AxisScale::round_outwards(const Axis& axis) {
    double low = min_, high = max_;
    if (scale_ == Scale::kLog) {
        const double room = std::pow(high / low, 0.05) * 1.15;
        low /= room;
        high *= room;
    } else {
        const double step = nice_step(high - low, 5.0);
        low = std::floor(low / step + 1e-9) * step;
        high = std::ceil(high / step - 1e-9) * step;
    }
    if (!axis.min) min_ = low;
    if (!axis.max) max_ = high;
}

void AxisScale::span_pixels(double from_px, double to_px) {
    from_px_ = from_px;
    to_px_ = to_px;
}

bool AxisScale::can_show(double value) const {
    return std::isfinite(value) && (scale_ == Scale::kLinear || value > 0.0);
}

bool AxisScale::shows(double value) const {
    return can_show(value) && value >= min_ && value <= max_;
}

double AxisScale::along(double value) const {
    if (scale_ == Scale::kLinear) return (value - min_) / (max_ - min_);
    return std::log10(value / min_) / std::log10(max_ / min_);
}

double AxisScale::pixel_of(double value) const {
    return from_px_ + along(value) * (to_px_ - from_px_);
}

std::vector<Tick> AxisScale::ticks() const {
    return scale_ == Scale::kLinear ? linear_ticks() : log_ticks();
}

std::vector<Tick> AxisScale::linear_ticks() const {
    const double step = nice_step(max_ - min_, 6.0);
    const double minor = step / (nice_step(max_ - min_, 12.0) < step * 0.45 ? 5.0 : 4.0);
    std::vector<Tick> ticks;
    const auto last = static_cast<long>(std::floor(max_ / minor + 1e-9));
    for (auto i = static_cast<long>(std::ceil(min_ / minor - 1e-9)); i <= last; ++i) {
        Tick tick{static_cast<double>(i) * minor, "", std::nullopt};
        const double steps = tick.value / step;
        if (std::abs(steps - std::round(steps)) < 1e-6)
            tick.label = with_digits("%.6g", std::round(steps) * step);
        ticks.push_back(tick);
    }
    return ticks;
}

std::vector<Tick> AxisScale::log_ticks() const {
    const int first = decade_below(min_), last = decade_above(max_);
    const int decades = last - first;
    const int every = decades <= 8 ? 1 : decades <= 16 ? 2 : 3;
    const bool powers_only = min_ < 1e-4 || max_ > 1e5;
    const bool label_within = max_ / min_ < 40.0;
    std::vector<Tick> ticks;
    for (int power = first; power <= last; ++power) {
        for (int lead = 1; lead <= 9; ++lead) {
            // Divided where that is exact, so that 0.001 is the number that is written so.
            const double size = std::pow(10.0, std::abs(power));
            Tick tick{power < 0 ? lead / size : lead * size, "", std::nullopt};
            if (tick.value < min_ * (1 - 1e-9) || tick.value > max_ * (1 + 1e-9)) continue;
            if (lead == 1 && power % every == 0) {
                write(tick, power, powers_only);
            } else if (label_within && (lead == 2 || lead == 5)) {
                tick.label = with_digits("%.6g", tick.value);
            } else if (lead != 1 && decades > 5) {
                continue;
            }
            ticks.push_back(tick);
        }
    }
    return ticks;
}

}  // namespace fts::lab
