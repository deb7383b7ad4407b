// The kernels of swept_lanes.h for one kind of vector. For the sources that are compiled for one
// instruction set each: everything is a template of Pack, so that nothing compiled for one of them
// is ever shared with another.
//
// Pack has kWidth <= kMostLanes, Vector, load, all, add, sub, mul, and at_most(a, b): a bit for
// each lane in which a <= b.
#pragma once

#include "common/physics/swept_lanes.h"

namespace fts::physics {

template <typename Pack, bool kEqualRadii>
struct SweptKernels {
    using Vector = typename Pack::Vector;

    static Vector squared_reach(const PathLanes& lanes, std::uint32_t j, Vector radius,
                                Vector limit) {
        if constexpr (kEqualRadii) {
            return limit;
        } else {
            const Vector reach = Pack::add(Pack::load(lanes.radius + j), radius);
            return Pack::add(Pack::mul(reach, reach), limit);
        }
    }

    static std::uint32_t first_lanes(std::uint32_t count) {
        return (1U << (count < Pack::kWidth ? count : Pack::kWidth)) - 1U;
    }

    // The first lanes are looked at even when there are none: few cells hold more than one vector,
    // and whether they hold anybody is not to be foreseen. Lanes beyond the last path are of cells
    // further on, which are hardly ever near, and are taken away only when one of them is.
    static std::size_t find_pairs(const PathLanes& lanes, const PairSearch& search,
                                  PairCursor& cursor, FoundPairs* found, std::size_t room) {
        return search.rows == 1 ? find_pairs_in<true>(lanes, search, cursor, found, room)
                                : find_pairs_in<false>(lanes, search, cursor, found, room);
    }

    template <bool kOneRow>
    static std::size_t find_pairs_in(const PathLanes& lanes, const PairSearch& search,
                                     PairCursor& cursor, FoundPairs* found, std::size_t room) {
        const float *const all_x = lanes.x, *const all_y = lanes.y;
        const float *const all_ahead_x = lanes.ahead_x, *const all_ahead_y = lanes.ahead_y;
        const float reach = search.reach;
        const std::uint32_t rows = search.rows, width = lanes.width;
        const std::uint32_t* const first_path = lanes.first;
        const Vector limit = Pack::all(search.limit);
        const FoundPairs* const full = found + (room - search.most_of_one);
        FoundPairs* out = found;
        std::uint32_t i = cursor.path, row = cursor.row;
        for (; i < lanes.paths && out <= full; ++row) {
            const std::uint32_t* const cells = first_path + row * width;
            const std::uint32_t end = cells[width];
            for (; i < end && out <= full; ++i) {
                const float x = all_x[i];
                const Vector at_x = Pack::all(x), at_y = Pack::all(all_y[i]);
                const Vector to_x = Pack::all(all_ahead_x[i]), to_y = Pack::all(all_ahead_y[i]);
                const Vector radius = kEqualRadii ? Vector() : Pack::all(lanes.radius[i]);
                const auto look = [&](std::uint32_t first, std::uint32_t last) {
                    for (;; first += Pack::kWidth) {
                        const Vector dx = Pack::sub(Pack::load(all_x + first), at_x);
                        const Vector dy = Pack::sub(Pack::load(all_y + first), at_y);
                        const Vector ex = Pack::sub(Pack::load(all_ahead_x + first), to_x);
                        const Vector ey = Pack::sub(Pack::load(all_ahead_y + first), to_y);
                        const Vector sum = Pack::add(Pack::mul(dx, ex), Pack::mul(dy, ey));
                        const std::uint32_t bits =
                            Pack::at_most(sum, squared_reach(lanes, first, radius, limit));
                        if (bits != 0) [[unlikely]] {
                            *out = {i, first, bits & first_lanes(last - first)};
                            out += out->bits != 0 ? 1 : 0;
                        }
                        if (last - first <= Pack::kWidth) [[likely]]
                            return;
                    }
                };
                const auto low = static_cast<std::uint32_t>(static_cast<std::int32_t>(x - reach));
                const auto high = static_cast<std::uint32_t>(static_cast<std::int32_t>(x + reach));
                look(i + 1, cells[high + 1]);
                const std::uint32_t* next = cells + width;
                if constexpr (kOneRow) {
                    look(next[low], next[high + 1]);
                } else {
                    for (std::uint32_t k = 0; k < rows; ++k, next += width) {
                        look(next[low], next[high + 1]);
                    }
                }
            }
            if (i < end) break;
        }
        cursor = {i, row};
        return static_cast<std::size_t>(out - found);
    }

    static std::uint32_t count(std::uint32_t bits) {
#if defined(__POPCNT__)
        return static_cast<std::uint32_t>(__builtin_popcount(bits));
#else
        static_assert(kMostLanes <= 8);
        bits -= bits >> 1 & 0x55U;
        bits = (bits & 0x33U) + (bits >> 2 & 0x33U);
        return (bits + (bits >> 4)) & 0xfU;
#endif
    }

    // visit(j, lanes) for each vector of a window: those from path j on of which these lanes count.
    template <typename Visit>
    [[gnu::always_inline]] static void for_each_vector(const PathLanes& lanes,
                                                       const CellWindow& window, Visit visit) {
        const std::uint32_t* cells = lanes.first + window.first_y * lanes.width;
        for (std::uint32_t row = window.first_y; row <= window.last_y; ++row) {
            const std::uint32_t last = cells[window.last_x + 1];
            for (std::uint32_t j = cells[window.first_x];; j += Pack::kWidth) {
                visit(j, first_lanes(last - j));
                if (last - j <= Pack::kWidth) [[likely]]
                    break;
            }
            cells += lanes.width;
        }
    }

    // What several vectors find is written down together, since how much each of them finds is not
    // to be foreseen.
    struct Noted {
        static constexpr std::uint32_t kVectors = 64 / kMostLanes;
        std::uint32_t starts[kVectors] = {};
        std::uint32_t vectors = 0;

        bool is_full() const { return vectors == kVectors; }
        std::uint64_t place(std::uint32_t bits) const {
            return std::uint64_t{bits} << (kMostLanes * vectors);
        }
        // visit(path, bit)
        template <typename Visit>
        [[gnu::always_inline]] void take(std::uint64_t all, Visit visit) {
            for (; all != 0; all &= all - 1) {
                const auto bit = static_cast<std::uint32_t>(__builtin_ctzll(all));
                visit(starts[bit / kMostLanes] + bit % kMostLanes, bit);
            }
            vectors = 0;
        }
    };

    // test(j, lanes) gives which of these lanes are found.
    template <typename Test>
    static std::size_t search_window(const PathLanes& lanes, const CellWindow& window,
                                     std::uint32_t* found, Test test) {
        std::uint32_t* out = found;
        std::uint64_t all = 0;
        Noted noted;
        const auto write_down = [&] {
            noted.take(all, [&](std::uint32_t path, std::uint32_t) { *out++ = lanes.body[path]; });
            all = 0;
        };
        for_each_vector(lanes, window, [&](std::uint32_t j, std::uint32_t among) {
            all |= noted.place(test(j, among));
            noted.starts[noted.vectors++] = j;
            if (noted.is_full()) [[unlikely]]
                write_down();
        });
        write_down();
        return static_cast<std::size_t>(out - found);
    }

    // Those from j on: where they are at that time, and where twice their motion from then on
    // leads.
    struct Some {
        Vector x, y, ahead_x, ahead_y;

        Some(const PathLanes& lanes, std::uint32_t j, Vector half_time) {
            const Vector from_x = Pack::load(lanes.x + j), from_y = Pack::load(lanes.y + j);
            const Vector to_x = Pack::load(lanes.ahead_x + j);
            const Vector to_y = Pack::load(lanes.ahead_y + j);
            const Vector way_x = Pack::mul(Pack::sub(to_x, from_x), half_time);
            const Vector way_y = Pack::mul(Pack::sub(to_y, from_y), half_time);
            x = Pack::add(from_x, way_x);
            y = Pack::add(from_y, way_y);
            ahead_x = Pack::sub(to_x, way_x);
            ahead_y = Pack::sub(to_y, way_y);
        }
    };

    // One in each lane.
    struct One {
        Vector x, y, ahead_x, ahead_y;

        explicit One(const PathSearch& search)
            : x(Pack::all(search.x)),
              y(Pack::all(search.y)),
              ahead_x(Pack::all(search.ahead_x)),
              ahead_y(Pack::all(search.ahead_y)) {}
    };

    struct Products {
        Vector now, until_ahead;  // of the distance at that time, with itself and with that ahead

        Products(const Some& some, const One& one) {
            const Vector x = Pack::sub(some.x, one.x), y = Pack::sub(some.y, one.y);
            const Vector ahead_x = Pack::sub(some.ahead_x, one.ahead_x);
            const Vector ahead_y = Pack::sub(some.ahead_y, one.ahead_y);
            now = Pack::add(Pack::mul(x, x), Pack::mul(y, y));
            until_ahead = Pack::add(Pack::mul(x, ahead_x), Pack::mul(y, ahead_y));
        }
    };

    static std::size_t find_meeting(const PathLanes& lanes, const CellWindow& window,
                                    const PathSearch& search, std::uint32_t* found) {
        const One one(search);
        const Vector half_time = Pack::all(search.half_time), limit = Pack::all(search.limit);
        const Vector radius = kEqualRadii ? Vector() : Pack::all(search.radius);
        return search_window(lanes, window, found, [&](std::uint32_t j, std::uint32_t among) {
            const Products products(Some(lanes, j, half_time), one);
            const Vector limits = squared_reach(lanes, j, radius, limit);
            return Pack::at_most(products.until_ahead, limits) & among;
        });
    }

    static std::size_t find_touching(const PathLanes& lanes, const CellWindow& window,
                                     const TouchSearch& search, std::uint32_t* found) {
        const Vector half_time = Pack::all(search.half_time);
        return search_window(lanes, window, found, [&](std::uint32_t j, std::uint32_t among) {
            const Vector start_x = Pack::load(lanes.x + j), start_y = Pack::load(lanes.y + j);
            const Vector way_x = Pack::sub(Pack::load(lanes.ahead_x + j), start_x);
            const Vector way_y = Pack::sub(Pack::load(lanes.ahead_y + j), start_y);
            const Vector x = Pack::add(start_x, Pack::mul(way_x, half_time));
            const Vector y = Pack::add(start_y, Pack::mul(way_y, half_time));
            const auto near = [&](int k) {
                const Vector dx = Pack::sub(x, Pack::all(search.x[k]));
                const Vector dy = Pack::sub(y, Pack::all(search.y[k]));
                const Vector radius = kEqualRadii ? Vector() : Pack::all(search.radius[k]);
                return Pack::at_most(Pack::add(Pack::mul(dx, dx), Pack::mul(dy, dy)),
                                     squared_reach(lanes, j, radius, Pack::all(search.limit[k])));
            };
            return (near(0) | near(1)) & among;
        });
    }

    static Seen see(const PathLanes& lanes, const CellWindow& window, const SightSearch& search,
                    Meeting* found) {
        const std::uint32_t body_a = search.bodies[0], body_b = search.bodies[1];
        const PathSearch &path_a = search.paths[0], &path_b = search.paths[1];
        const One a(path_a), b(path_b);
        const Vector half_time = Pack::all(path_a.half_time);
        const Vector limit = Pack::all(path_a.limit), close_limit = Pack::all(search.close_limit);
        const Vector radius_a = kEqualRadii ? Vector() : Pack::all(path_a.radius);
        const Vector radius_b = kEqualRadii ? Vector() : Pack::all(path_b.radius);
        Seen seen = {};
        Meeting* out = found;
        std::uint64_t of_a = 0, of_b = 0;
        Noted noted;
        const auto write_down = [&] {
            noted.take(of_a | of_b, [&](std::uint32_t path, std::uint32_t bit) {
                const std::uint32_t other = lanes.body[path];
                seen.paths[0] = other == body_a ? path : seen.paths[0];
                seen.paths[1] = other == body_b ? path : seen.paths[1];
                const std::uint64_t is_else = (other != body_a) & (other != body_b);
                *out = {body_a, other};
                out += is_else & of_a >> bit;
                *out = {body_b, other};
                out += is_else & of_b >> bit;
            });
            of_a = of_b = 0;
        };
        for_each_vector(lanes, window, [&](std::uint32_t j, std::uint32_t among) {
            const Some some(lanes, j, half_time);
            const auto look = [&](const One& one, Vector radius, std::uint64_t& of_one,
                                  std::uint32_t& close) {
                const Products products(some, one);
                const Vector close_limits = squared_reach(lanes, j, radius, close_limit);
                close += count(Pack::at_most(products.now, close_limits) & among);
                const Vector limits = squared_reach(lanes, j, radius, limit);
                of_one |= noted.place(Pack::at_most(products.until_ahead, limits) & among);
            };
            look(a, radius_a, of_a, seen.close[0]);
            look(b, radius_b, of_b, seen.close[1]);
            noted.starts[noted.vectors++] = j;
            if (noted.is_full()) [[unlikely]]
                write_down();
        });
        write_down();
        seen.count = static_cast<std::size_t>(out - found);
        return seen;
    }

    static constexpr LaneKernels kTable = {find_pairs, find_meeting, find_touching, see};
};

}  // namespace fts::physics
