// The kernels of flight_filter.h for one kind of vector. For the sources that are compiled for one
// instruction set each: everything is a template of Pack, which is local to its source, and of
// others' types only the layout is used, so that nothing compiled for one of them is ever shared
// with another. The arithmetic is that of OneByOne in flight_filter.cpp.
//
// Pack has kWidth numbers in a Vector, a Mask of them, and
//
//     load, store, all, add, sub, mul, min, max
//     root_above(a), quotient_below(a, b)  bounds, for a >= 0 and b > 0; or NaN
//     least_of(a)                       of its numbers
//     below(a, b), at_most(a, b)        a mask: a < b, a <= b
//     not_above(among, a, b)            of a mask those that do not have a > b
//     root(a), quotient(a, b)           exact ones; a >= 0, or a mask leaves it out
//     either(one, other), both(one, other)  a mask
//     of_bits(among, bits)              of a mask those whose bit is set
//     chosen(mask, yes, no), bits_of(mask)
//     not_a_number_at(mask, a)
//     is_any(bodies, one, other)        a mask, of whole numbers in memory
//     copy(from, to)                    of whole numbers
//     side_by_side(flights, bodies)     Lines
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "common/physics/flight_filter.h"
#include "common/physics/time_of_impact.h"

namespace fts::physics {

// Flights side by side.
template <typename Pack>
struct Lines {
    typename Pack::Vector x, y, vx, vy, since, radius;
};

template <typename Pack>
const double* numbers_of(const Flight<double>& flight) {
    static_assert(sizeof(Flight<double>) == 64 && offsetof(Flight<double>, position_m) == 0);
    static_assert(offsetof(Flight<double>, velocity_mps) == 2 * sizeof(double));
    static_assert(offsetof(Flight<double>, since_s) == 4 * sizeof(double));
    static_assert(offsetof(Flight<double>, radius_m) == 5 * sizeof(double));
    return reinterpret_cast<const double*>(&flight);
}

template <typename Pack>
const double* numbers_of(const Vec2d& place) {
    static_assert(sizeof(Vec2d) == 2 * sizeof(double));
    return reinterpret_cast<const double*>(&place);
}

template <typename Pack>
typename Pack::Vector sum_of_products(typename Pack::Vector a, typename Pack::Vector b,
                                      typename Pack::Vector c, typename Pack::Vector d) {
    return Pack::add(Pack::mul(a, b), Pack::mul(c, d));
}

template <typename Pack>
typename Pack::Vector flown(typename Pack::Vector from, typename Pack::Vector speed,
                            typename Pack::Vector time) {
    return Pack::add(from, Pack::mul(speed, time));
}

// Of one flight with others.
template <typename Pack>
class Ways {
  public:
    using Vector = typename Pack::Vector;
    struct Waits {
        typename Pack::Mask may_meet;
        Vector least;
    };

    Ways(const double* self, const double* shift)
        : x_(Pack::all(self[0])),
          y_(Pack::all(self[1])),
          vx_(Pack::all(self[2])),
          vy_(Pack::all(self[3])),
          since_(Pack::all(self[4])),
          radius_(Pack::all(self[5])),
          shift_x_(Pack::all(shift[0])),
          shift_y_(Pack::all(shift[1])) {}

    Vector radius() const { return radius_; }

    Waits waits(const Neighbours<double>& about, std::uint32_t k, Vector from, Vector reach) const {
        constexpr double kLeastNormal = std::numeric_limits<double>::min();
        const Vector zero = Pack::all(0.0);
        const Vector time = Pack::sub(from, since_);
        const Vector dx =
            Pack::sub(Pack::sub(flown<Pack>(x_, vx_, time), Pack::load(about.x_m + k)), shift_x_);
        const Vector dy =
            Pack::sub(Pack::sub(flown<Pack>(y_, vy_, time), Pack::load(about.y_m + k)), shift_y_);
        const Vector wx = Pack::sub(vx_, Pack::load(about.x_mps + k));
        const Vector wy = Pack::sub(vy_, Pack::load(about.y_mps + k));
        const Vector aside = Pack::sub(Pack::mul(dx, wy), Pack::mul(dy, wx));
        const Vector aside_squared = Pack::mul(aside, aside);
        const Vector rate = sum_of_products<Pack>(dx, wx, dy, wy);
        const Vector reach_squared = Pack::mul(reach, reach);
        const Vector speed_squared = sum_of_products<Pack>(wx, wx, wy, wy);
        const Vector limit = Pack::add(
            Pack::mul(Pack::mul(Pack::all(kFilterSlack<double>), reach_squared), speed_squared),
            Pack::all(kLeastNormal));
        const auto may_meet = Pack::not_above(Pack::below(rate, zero), aside_squared, limit);
        const Vector widest = Pack::mul(reach_squared, speed_squared);
        const Vector chord = Pack::sub(widest, aside_squared);
        const Vector chord_slack = Pack::mul(Pack::all(kChordSlack), widest);
        const Vector root = Pack::root_above(Pack::add(Pack::max(chord, zero), chord_slack));
        const Vector divisor = Pack::sub(root, rate);
        const Vector distance_squared = sum_of_products<Pack>(dx, dx, dy, dy);
        const Vector gap = Pack::sub(distance_squared, reach_squared);
        const Vector gap_slack =
            Pack::mul(Pack::all(kGapSlack), Pack::add(distance_squared, reach_squared));
        const Vector way = Pack::max(Pack::sub(gap, gap_slack), zero);
        return {may_meet, Pack::quotient_below(way, divisor)};
    }

  private:
    Vector x_, y_, vx_, vy_, since_, radius_, shift_x_, shift_y_;
};

template <typename Pack, bool kEqualRadii>
struct WideFlights {
    using Vector = typename Pack::Vector;

    static void gather(const Flight<double>* flights, const std::uint32_t* bodies,
                       std::uint32_t count, std::uint32_t self, std::uint32_t partner,
                       double since_s, Neighbours<double>& found) {
        found.count = count;
        const Vector since = Pack::all(since_s);
        for (std::uint32_t k = 0; k < count; k += Pack::kWidth) {
            const Lines<Pack> lines = Pack::side_by_side(flights, bodies + k);
            const Vector from = Pack::max(since, lines.since);
            const Vector time = Pack::sub(from, lines.since);
            const auto left_out = Pack::is_any(bodies + k, self, partner);
            const Vector x = flown<Pack>(lines.x, lines.vx, time);
            Pack::store(found.x_m + k, Pack::not_a_number_at(left_out, x));
            Pack::store(found.y_m + k, flown<Pack>(lines.y, lines.vy, time));
            Pack::store(found.x_mps + k, lines.vx);
            Pack::store(found.y_mps + k, lines.vy);
            Pack::store(found.from_s + k, from);
            if constexpr (!kEqualRadii) Pack::store(found.radius_m + k, lines.radius);
            Pack::copy(bodies + k, found.body + k);
        }
    }

    static Vector reach(const Neighbours<double>& about, std::uint32_t k, Vector radius) {
        if constexpr (kEqualRadii) return Pack::add(radius, radius);
        return Pack::add(radius, Pack::load(about.radius_m + k));
    }

    static std::uint32_t close(const Neighbours<double>& about, const Vec2d& position_m,
                               double radius_m, double factor) {
        const double* const at = numbers_of<Pack>(position_m);
        const Vector at_x = Pack::all(at[0]), at_y = Pack::all(at[1]);
        const Vector radius = Pack::all(radius_m), factor_squared = Pack::all(factor * factor);
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < about.count; k += Pack::kWidth) {
            const Vector x = Pack::sub(at_x, Pack::load(about.x_m + k));
            const Vector y = Pack::sub(at_y, Pack::load(about.y_m + k));
            const Vector within = reach(about, k, radius);
            const Vector limit = Pack::mul(factor_squared, Pack::mul(within, within));
            bits |= Pack::bits_of(Pack::at_most(sum_of_products<Pack>(x, x, y, y), limit)) << k;
        }
        return bits;
    }

    static void look_ahead(const Neighbours<double>& about, std::uint32_t which,
                           const Flight<double>& self, const Vec2d& shift_m, double now_s,
                           Ahead<double>& ahead) {
        const Vector now = Pack::all(now_s), never = Pack::all(kNever<double>);
        const Ways<Pack> ways(numbers_of<Pack>(self), numbers_of<Pack>(shift_m));
        Vector least = never;
        ahead.any = 0;
        for (std::uint32_t k = 0; k < about.count; k += Pack::kWidth) {
            const Vector from = Pack::load(about.from_s + k);
            const auto waits = ways.waits(about, k, from, reach(about, k, ways.radius()));
            const auto may_meet = Pack::of_bits(waits.may_meet, which >> k);
            ahead.any |= Pack::bits_of(may_meet) << k;
            const Vector time = Pack::max(Pack::add(from, waits.least), now);
            const Vector earliest = Pack::chosen(may_meet, time, never);
            least = Pack::min(earliest, least);
            Pack::store(ahead.earliest_s + k, earliest);
        }
        ahead.first = until(ahead, about.count, Pack::least_of(least));
    }

    static std::uint32_t until(const Ahead<double>& ahead, std::uint32_t count, double time_s) {
        const Vector latest = Pack::all(time_s);
        std::uint32_t bits = 0;
        for (std::uint32_t k = 0; k < count; k += Pack::kWidth) {
            const Vector earliest = Pack::load(ahead.earliest_s + k);
            bits |= Pack::bits_of(Pack::at_most(earliest, latest)) << k;
        }
        return bits & ahead.any;
    }

    static std::uint32_t meet(const Flight<double>* flights, const std::uint32_t* one,
                              const std::uint32_t* other, double now_s, double* time_s) {
        const Vector now = Pack::all(now_s), never = Pack::all(kNever<double>);
        const Vector zero = Pack::all(0.0);
        std::uint32_t may_be_apart = 0;
        for (std::uint32_t k = 0; k < kMeetingsAtOnce; k += Pack::kWidth) {
            const Lines<Pack> a = Pack::side_by_side(flights, one + k);
            const Lines<Pack> b = Pack::side_by_side(flights, other + k);
            const Vector from = Pack::max(a.since, b.since);
            const Vector for_a = Pack::sub(from, a.since), for_b = Pack::sub(from, b.since);
            const Vector x =
                Pack::sub(flown<Pack>(a.x, a.vx, for_a), flown<Pack>(b.x, b.vx, for_b));
            const Vector y =
                Pack::sub(flown<Pack>(a.y, a.vy, for_a), flown<Pack>(b.y, b.vy, for_b));
            const Vector wx = Pack::sub(a.vx, b.vx), wy = Pack::sub(a.vy, b.vy);
            const Vector reach = Pack::add(a.radius, b.radius);
            const Vector rate = sum_of_products<Pack>(x, wx, y, wy);
            const Vector apart = sum_of_products<Pack>(x, x, y, y);
            const Vector distance = Pack::root(apart);
            const Vector speed = Pack::root(sum_of_products<Pack>(wx, wx, wy, wy));
            const Vector aside = Pack::sub(Pack::mul(x, wy), Pack::mul(y, wx));
            const Vector passing = Pack::quotient(Pack::max(aside, Pack::sub(zero, aside)), speed);
            const Vector half = Pack::mul(Pack::sub(reach, passing), Pack::add(reach, passing));
            const Vector chord = Pack::root(Pack::max(half, zero));
            const Vector gap = Pack::mul(Pack::sub(distance, reach), Pack::add(distance, reach));
            const Vector way = Pack::sub(chord, Pack::quotient(rate, speed));
            const Vector wait = Pack::quotient(gap, Pack::mul(way, speed));
            const auto approach = Pack::below(rate, zero);
            const auto touch = Pack::at_most(distance, reach);
            const auto meets =
                Pack::both(approach, Pack::either(touch, Pack::at_most(passing, reach)));
            const Vector time = Pack::max(Pack::add(from, Pack::chosen(touch, zero, wait)), now);
            Pack::store(time_s + k, Pack::chosen(meets, time, never));
            const Vector squares = Pack::add(sum_of_products<Pack>(a.vx, a.vx, a.vy, a.vy),
                                             sum_of_products<Pack>(b.vx, b.vx, b.vy, b.vy));
            const auto is_near = Pack::below(
                apart, Pack::mul(Pack::mul(Pack::all(1.0 + kApartSlack), reach), reach));
            const auto barely = Pack::below(
                Pack::mul(rate, rate),
                Pack::mul(Pack::mul(Pack::all(kApartSlack * kApartSlack), apart), squares));
            may_be_apart |= Pack::bits_of(Pack::either(is_near, barely)) << k;
        }
        return may_be_apart;
    }

    static constexpr FlightKernels<double> kTable{gather, close, look_ahead, until, meet};
};

}  // namespace fts::physics
