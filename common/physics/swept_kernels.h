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

    // test(path, lanes) gives which of these lanes are found, and write(path, out) writes one of
    // them down and returns where the next one goes. What several vectors find is written down
    // together, since how much each of them finds is not to be foreseen.
    template <typename Test, typename Write>
    static std::size_t search_window(const PathLanes& lanes, const CellWindow& window,
                                     std::uint32_t* found, Test test, Write write) {
        constexpr std::uint32_t kTogether = 64 / kMostLanes;
        std::uint32_t* out = found;
        std::uint32_t starts[kTogether];
        std::uint64_t all = 0;
        std::uint32_t vectors = 0;
        const auto write_down = [&] {
            for (; all != 0; all &= all - 1) {
                const auto bit = static_cast<std::uint32_t>(__builtin_ctzll(all));
                out = write(starts[bit / kMostLanes] + bit % kMostLanes, out);
            }
            vectors = 0;
        };
        const std::uint32_t* cells = lanes.first + window.first_y * lanes.width;
        for (std::uint32_t row = window.first_y; row <= window.last_y; ++row) {
            const std::uint32_t last = cells[window.last_x + 1];
            for (std::uint32_t j = cells[window.first_x];; j += Pack::kWidth) {
                const std::uint64_t bits = test(j, first_lanes(last - j));
                all |= bits << (kMostLanes * vectors);
                starts[vectors] = j;
                if (++vectors == kTogether) [[unlikely]]
                    write_down();
                if (last - j <= Pack::kWidth) [[likely]]
                    break;
            }
            cells += lanes.width;
        }
        write_down();
        return static_cast<std::size_t>(out - found);
    }

    // Writes down all.
    static auto write_bodies(const PathLanes& lanes) {
        return [body = lanes.body](std::uint32_t path, std::uint32_t* out) {
            *out = body[path];
            return out + 1;
        };
    }

    static std::size_t find_meeting(const PathLanes& lanes, const CellWindow& window,
                                    const PathSearch& search, std::uint32_t* found) {
        return find_meeting_in(lanes, window, search, found, write_bodies(lanes),
                               [](std::uint32_t, Vector, std::uint32_t) {});
    }

    static Seen see(const PathLanes& lanes, const CellWindow& window, const SightSearch& search,
                    std::uint32_t* found) {
        const Vector radius = kEqualRadii ? Vector() : Pack::all(search.path.radius);
        const Vector limit = Pack::all(search.close_limit);
        std::uint32_t close = 0, own_path = 0;
        const auto note = [&](std::uint32_t j, Vector squared, std::uint32_t among) {
            const Vector reach = squared_reach(lanes, j, radius, limit);
            close += count(Pack::at_most(squared, reach) & among);
        };
        const auto write = [&, body = lanes.body](std::uint32_t path, std::uint32_t* out) {
            const std::uint32_t other = body[path];
            own_path = other == search.self ? path : own_path;
            *out = other;
            return out + static_cast<int>((other != search.self) & (other != search.opposite));
        };
        const std::size_t found_count =
            find_meeting_in(lanes, window, search.path, found, write, note);
        return {static_cast<std::uint32_t>(found_count), close, own_path};
    }

    // note(path, squares of the distances at that time, lanes)
    template <typename Write, typename Note>
    static std::size_t find_meeting_in(const PathLanes& lanes, const CellWindow& window,
                                       const PathSearch& search, std::uint32_t* found, Write write,
                                       Note note) {
        const Vector at_x = Pack::all(search.x), at_y = Pack::all(search.y);
        const Vector to_x = Pack::all(search.ahead_x), to_y = Pack::all(search.ahead_y);
        const Vector half_time = Pack::all(search.half_time), limit = Pack::all(search.limit);
        const Vector radius = kEqualRadii ? Vector() : Pack::all(search.radius);
        const auto test = [&](std::uint32_t j, std::uint32_t among) {
            const Vector x = Pack::load(lanes.x + j), y = Pack::load(lanes.y + j);
            const Vector ahead_x = Pack::load(lanes.ahead_x + j);
            const Vector ahead_y = Pack::load(lanes.ahead_y + j);
            const Vector way_x = Pack::mul(Pack::sub(ahead_x, x), half_time);
            const Vector way_y = Pack::mul(Pack::sub(ahead_y, y), half_time);
            const Vector dx = Pack::sub(Pack::add(x, way_x), at_x);
            const Vector dy = Pack::sub(Pack::add(y, way_y), at_y);
            const Vector ex = Pack::sub(Pack::sub(ahead_x, way_x), to_x);
            const Vector ey = Pack::sub(Pack::sub(ahead_y, way_y), to_y);
            note(j, Pack::add(Pack::mul(dx, dx), Pack::mul(dy, dy)), among);
            const Vector sum = Pack::add(Pack::mul(dx, ex), Pack::mul(dy, ey));
            return Pack::at_most(sum, squared_reach(lanes, j, radius, limit)) & among;
        };
        return search_window(lanes, window, found, test, write);
    }

    static std::size_t find_touching(const PathLanes& lanes, const CellWindow& window,
                                     const TouchSearch& search, std::uint32_t* found) {
        const Vector half_time = Pack::all(search.half_time);
        const auto test = [&](std::uint32_t j, std::uint32_t among) {
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
        };
        return search_window(lanes, window, found, test, write_bodies(lanes));
    }

    static constexpr LaneKernels kTable = {find_pairs, find_meeting, find_touching, see};
};

}  // namespace fts::physics
