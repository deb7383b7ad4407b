#include "common/physics/event_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "common/physics/crowd_range.h"

namespace fts::physics {
namespace {

// Another grid is worth its making when the crowd's extent has changed by this factor, or it has
// moved by this part of its extent.
constexpr double kSpread = 1.5;
constexpr double kMoved = 0.25;

// All places are copied, and the vacant ones written over next. Bodies are below 2^31.
template <typename Cell>
std::uint32_t* copy_places(const Cell& cell, std::uint32_t* to) {
#if defined(__SSE2__)
    const __m128i all = _mm_loadu_si128(reinterpret_cast<const __m128i*>(cell.place));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), all);
    const auto vacant = static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(all)));
    return to + std::countr_zero(vacant | 0x10U);
#else
    for (const std::uint32_t body : cell.place) {
        *to = body;
        to += body >> 31 == 0 ? 1 : 0;
    }
    return to;
#endif
}

#if defined(__x86_64__)
// The same of rows of cells that two look at, with a bit for each that it sees.
template <typename Cell, typename Views, typename AboutTwo>
__attribute__((target("avx512f,avx512vl,avx512dq,bmi2,popcnt"))) AboutTwo copy_rows(
    const Cell* cells, std::size_t stride, const Views& views, std::uint32_t* to, AboutTwo none) {
    const auto wanted = static_cast<__mmask16>(views.columns == 3 ? 0x0fff : 0xffff);
    const __m512i nobody = _mm512_set1_epi32(-1);
    unsigned lists = 0, count = 0;
    std::uint64_t seen[2] = {0, 0};
    for (std::uint32_t row = 0; row < views.rows; ++row, cells += stride) {
        const __m512i all = _mm512_maskz_loadu_epi32(wanted, cells);
        const __mmask16 not_bodies = _mm512_movepi32_mask(all);
        lists |= _mm512_mask_cmpneq_epi32_mask(not_bodies, all, nobody);
        const auto bodies = static_cast<__mmask16>(~not_bodies & wanted);
        _mm512_storeu_si512(to + count, _mm512_maskz_compress_epi32(bodies, all));
        for (std::uint32_t i = 0; i < 2; ++i) {
            const std::uint32_t view = row - views.first_row[i] < 3 ? 0x0fffU : 0;
            const std::uint32_t places = view << 4 * views.first_column[i];
            seen[i] |= std::uint64_t{_pext_u32(places, bodies)} << count;
        }
        count += static_cast<unsigned>(std::popcount(static_cast<unsigned>(bodies)));
    }
    if (lists != 0 || count > 32) return none;
    return {to + count, {static_cast<std::uint32_t>(seen[0]), static_cast<std::uint32_t>(seen[1])}};
}

// The same of three cells in each of some rows; nothing, where one of them has a list.
template <typename Cell>
__attribute__((target("avx512f,avx512vl,avx512dq,popcnt"))) std::uint32_t* copy_threes(
    const Cell* cells, std::size_t stride, std::uint32_t rows, std::uint32_t* to) {
    constexpr __mmask16 kTwelve = 0x0fff;
    const __m512i nobody = _mm512_set1_epi32(-1);
    unsigned lists = 0;
    for (std::uint32_t row = 0; row < rows; ++row, cells += stride) {
        const __m512i all = _mm512_maskz_loadu_epi32(kTwelve, cells);
        const __mmask16 not_bodies = _mm512_movepi32_mask(all);
        lists |= _mm512_mask_cmpneq_epi32_mask(not_bodies, all, nobody);
        const auto bodies = static_cast<__mmask16>(~not_bodies & kTwelve);
        _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(bodies, all));
        to += std::popcount(static_cast<unsigned>(bodies));
    }
    return lists == 0 ? to : nullptr;
}
#endif

}  // namespace

template <typename Scalar>
auto EventCells<Scalar>::range_of(std::uint32_t axis, std::span<const Vec2<Scalar>> positions_m)
    -> Range {
    if (positions_m.empty()) return {};
    scratch_.clear();
    for (const Vec2<Scalar>& position : positions_m) scratch_.push_back(position[axis]);
    const CrowdRange<Scalar> range = crowd_range(scratch_);
    return {range.low - range.margin, range.high + range.margin};
}

template <typename Scalar>
void EventCells<Scalar>::divide(Axis& axis, const Range& range, Scalar width_m,
                                std::size_t bodies) {
    const Scalar extent = range.high_m - range.low_m;
    const Scalar most = static_cast<Scalar>(std::max<std::size_t>(bodies, 1));
    const Scalar wanted = width_m > Scalar(0) ? extent / width_m : Scalar(1);
    const Scalar cells = std::max(Scalar(1), std::floor(std::min(wanted, most)));
    axis.origin_m = range.low_m;
    axis.width_m = extent / cells;
    axis.last = static_cast<std::uint32_t>(cells) - 1;
    axis.cells_per_m = axis.last == 0 ? Scalar(0) : cells / extent;
}

template <typename Scalar>
void EventCells<Scalar>::fit(std::span<const Vec2<Scalar>> positions_m, Scalar least_width_m,
                             const std::optional<typename Model<Scalar>::Box>& bounds,
                             bool periodic, std::uint32_t slots) {
    Range range[2];
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        axis_[axis].fitted = range[axis] = range_of(axis, positions_m);
        if (!bounds) continue;
        const Range bound{bounds->min_m[axis], bounds->max_m[axis]};
        if (periodic) range[axis] = bound;
        range[axis].low_m = std::clamp(range[axis].low_m, bound.low_m, bound.high_m);
        range[axis].high_m = std::clamp(range[axis].high_m, bound.low_m, bound.high_m);
    }
    // A cell for each body, where bodies are small.
    const Scalar area = (range[0].high_m - range[0].low_m) * (range[1].high_m - range[1].low_m);
    const Scalar room = area / static_cast<Scalar>(positions_m.size() + 1);
    const Scalar width = std::max(least_width_m, std::sqrt(room));
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        divide(axis_[axis], range[axis], width, positions_m.size());
    }
    stride_ = axis_[0].last + 3;
    const std::size_t cells = std::size_t{stride_} * (axis_[1].last + 3);
    cells_.resize(cells);
    next_.resize(slots);
    clear();
}

template <typename Scalar>
void EventCells<Scalar>::clear() {
    std::fill(cells_.begin(), cells_.end(), Cell{{kNobody, kNobody, kNobody, kNobody}});
}

template <typename Scalar>
void EventCells<Scalar>::put_in(std::uint32_t body, std::uint32_t x, std::uint32_t y) {
    Cell& cell = cells_[index_of(x + 1, y + 1)];
    for (std::uint32_t& place : cell.place) {
        if (place != kNobody) continue;
        place = body;
        return;
    }
    std::uint32_t& last = cell.place[kPlaces - 1];
    if (!has_list(cell)) next_[last] = kNobody;
    next_[body] = last & ~kListed;
    last = kListed | body;
}

template <typename Scalar>
void EventCells<Scalar>::take_out(std::uint32_t body, std::uint32_t x, std::uint32_t y) {
    Cell& cell = cells_[index_of(x + 1, y + 1)];
    std::uint32_t at = 0;
    while (at < kPlaces && cell.place[at] != body) ++at;
    if (!has_list(cell)) {
        for (; at + 1 < kPlaces; ++at) cell.place[at] = cell.place[at + 1];
        cell.place[kPlaces - 1] = kNobody;
        return;
    }
    std::uint32_t first = cell.place[kPlaces - 1] & ~kListed;
    if (at < kPlaces) {
        cell.place[at] = first;
        first = next_[first];
    } else {
        std::uint32_t* link = &first;
        while (*link != body) link = &next_[*link];
        *link = next_[body];
    }
    cell.place[kPlaces - 1] = next_[first] == kNobody ? first : kListed | first;
}

template <typename Scalar>
std::uint32_t* EventCells<Scalar>::find(std::uint32_t x, std::uint32_t y, std::uint32_t columns,
                                        std::uint32_t rows, std::uint32_t* found) const {
    const Cell* const row = cells_.data() + index_of(x, y);
    return columns == 3   ? find_in<3>(row, rows, found)
           : columns == 2 ? find_in<2>(row, rows, found)
                          : find_in<1>(row, rows, found);
}

template <typename Scalar>
template <std::uint32_t kColumns>
std::uint32_t* EventCells<Scalar>::find_in(const Cell* row, std::uint32_t rows,
                                           std::uint32_t* found) const {
#if defined(__x86_64__)
    if (kColumns == 3 && has_avx512_) {
        std::uint32_t* const copied = copy_threes(row, stride_, rows, found);
        if (copied != nullptr) return copied;
    }
#endif
    for (const Cell* const end = row + std::size_t{rows} * stride_; row != end; row += stride_) {
        bool any_list = false;
        for (std::uint32_t column = 0; column < kColumns; ++column) {
            found = copy_places(row[column], found);
            any_list |= has_list(row[column]);
        }
        if (!any_list) continue;
        for (std::uint32_t column = 0; column < kColumns; ++column) {
            found = copy_list(row[column], found);
        }
    }
    return found;
}

template <typename Scalar>
std::uint32_t* EventCells<Scalar>::find_three(const std::uint32_t* cell, std::uint32_t axis,
                                              std::uint32_t up, std::uint32_t* found) const {
    const std::size_t along = axis == 0 ? 1 : stride_, across = axis == 0 ? stride_ : 1;
    const Cell* const first = cells_.data() + index_of(cell[0], cell[1]) + 2 * up * along;
    bool any_list = false;
    for (std::uint32_t i = 0; i < 3; ++i) {
        found = copy_places(first[i * across], found);
        any_list |= has_list(first[i * across]);
    }
    if (!any_list) [[likely]]
        return found;
    for (std::uint32_t i = 0; i < 3; ++i) found = copy_list(first[i * across], found);
    return found;
}

template <typename Scalar>
std::uint32_t* EventCells<Scalar>::copy_list(const Cell& cell, std::uint32_t* found) const {
    if (!has_list(cell)) return found;
    std::uint32_t body = cell.place[kPlaces - 1] & ~kListed;
    for (; body != kNobody; body = next_[body]) *found++ = body;
    return found;
}

template <typename Scalar>
auto EventCells<Scalar>::find_about_two(const std::uint32_t* one, const std::uint32_t* other,
                                        std::uint32_t* found) const -> AboutTwo {
    const std::uint32_t x = std::min(one[0], other[0]), y = std::min(one[1], other[1]);
    const Views views{std::max(one[0], other[0]) - x + 3,
                      std::max(one[1], other[1]) - y + 3,
                      {one[0] - x, other[0] - x},
                      {one[1] - y, other[1] - y}};
    if (views.columns > 4 || views.rows > 4) return {};
    const Cell* cells = cells_.data() + index_of(x, y);
#if defined(__x86_64__)
    if (has_avx512_) return copy_rows(cells, stride_, views, found, AboutTwo());
#endif
    AboutTwo all{found};
    for (std::uint32_t row = 0; row < views.rows; ++row, cells += stride_) {
        std::uint64_t before[5] = {};  // of those found, by column; a bit beyond them
        bool any_list = false;
        for (std::uint32_t column = 0; column < views.columns; ++column) {
            before[column] = std::uint64_t{1} << (all.end - found);
            all.end = copy_places(cells[column], all.end);
            any_list |= has_list(cells[column]);
        }
        before[views.columns] = std::uint64_t{1} << (all.end - found);
        if (any_list || all.end - found > kMostAboutTwo) return {};
        for (std::uint32_t i = 0; i < 2; ++i) {
            const std::uint32_t column = views.first_column[i];
            const std::uint64_t bits = before[column + 3] - before[column];
            if (row - views.first_row[i] < 3) all.about[i] |= static_cast<std::uint32_t>(bits);
        }
    }
    return all;
}

template <typename Scalar>
bool EventCells<Scalar>::still_suits(std::span<const Vec2<Scalar>> sample_m) {
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        const Range now = range_of(axis, sample_m);
        const Range& then = axis_[axis].fitted;
        const Scalar extent_now = now.high_m - now.low_m;
        const Scalar extent_then = then.high_m - then.low_m;
        const Scalar longer = std::max(extent_now, extent_then);
        if (longer <= Scalar(2) * axis_[axis].width_m) continue;
        if (longer > static_cast<Scalar>(kSpread) * std::min(extent_now, extent_then)) return false;
        const Scalar moved =
            std::max(std::abs(now.low_m - then.low_m), std::abs(now.high_m - then.high_m));
        if (moved > static_cast<Scalar>(kMoved) * longer) return false;
    }
    return true;
}

template <typename Scalar>
std::uint32_t EventCells<Scalar>::cell_of(std::uint32_t axis, Scalar x_m) const {
    const Axis& along = axis_[axis];
    const Scalar cell = (x_m - along.origin_m) * along.cells_per_m;
    if (!(cell > Scalar(0))) return 0;
    if (cell >= static_cast<Scalar>(along.last)) return along.last;
    return static_cast<std::uint32_t>(cell);
}

template class EventCells<double>;
template class EventCells<float>;

}  // namespace fts::physics
