// Which discs overlap, look after look, while they move little in between: a list of the pairs that
// are nearer than their radii and a margin (L. Verlet 1967), made by CellGrid. It holds until some
// disc may have moved by half the margin, so that most looks test the list's few pairs only. Where
// discs move so far between looks that a list would be good for one, the margin is nothing.
//
// The fastest of a large crowd is much faster than nearly all, and must not set how long the list
// of all holds: the few that may have gone further than the margin allows have gone astray, and are
// looked for by themselves until the next list. (Not in a periodic box.)
//
// What is found does not depend on the margin, nor on when the list is made.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "common/physics/cell_grid.h"

namespace fts::physics {

struct DiscPair {
    std::uint32_t a, b;
};

template <typename Scalar>
class NearList {
  public:
    using Box = typename Model<Scalar>::Box;

    explicit NearList(SimdLevel level);

    // As of CellGrid. Forgets.
    void fit(const Discs<Scalar>& discs, const std::optional<Box>& box);

    // Other discs, or in other places, or other radii.
    void forget() { holds_ = false; }

    // Between looks, this disc by other hands.
    void moved(std::uint32_t disc, Scalar by_m) {
        const bool was_astray = is_astray(disc);
        shift_m_[disc] += by_m + slop_m_;
        worst_shift_m_ = shift_m_[disc] > worst_shift_m_ ? shift_m_[disc] : worst_shift_m_;
        if (is_astray(disc) && !was_astray) goes_astray(disc);
    }
    // While the list holds no disc is further than this from where it was when it was made, but for
    // those astray.
    Scalar longest_way_m() const { return Scalar(0.5) * margin_m_ + slop_m_; }
    std::span<const std::uint32_t> astray() const { return astray_; }
    bool holds() const { return holds_ && still_holds_after(Scalar(0)); }
    // It will soon be told to have moved. Inlined, or gcc leaves calls away that only fetch.
    [[gnu::always_inline]] void fetch(std::uint32_t disc) const {
        __builtin_prefetch(shift_m_.data() + disc, 1);
    }

    // Moves all discs and looks: a few at a time, so that those that are compared are still in the
    // cache. `move(from, to, usual_m, went_farther)` moves the discs from `from` to before `to`,
    // calls went_farther(disc, way_m) for each whose way is longer than what is usual, and gives
    // how far any has gone at most; it is called once for each disc, in their order.
    //
    // Every pair whose distance is below the sum of its radii, in any order: with a box (then all
    // places must be inside) the distance to the nearest image. Some are given twice: where one is
    // astray, or a box so tight that a pair may be near through two images. True when it has made
    // the list anew.
    template <typename Move>
    bool move_and_find_overlaps(const Discs<Scalar>& discs, Move move,
                                std::vector<DiscPair>& pairs);

    // Of the discs when the list was made, neighbours near each other.
    void read_order(RoomyVector<std::uint32_t>& order) const { grid_.read_order(order); }

  private:
    // So many pairs are tested before what was found is looked at again, and so many discs moved:
    // those of a few rows of a crowd of a million are together in a cache of the second level.
    static constexpr std::size_t kPairsAtOnce = 4096;
    static constexpr std::uint32_t kDiscsAtOnce = 2048;

    void all_moved(Scalar farthest_m);
    bool is_expected_to_hold() const;
    bool all_astray_are_known() const { return went_astray_ == astray_.size(); }
    bool still_holds_after(Scalar way_m) const {
        const Scalar shift_m =
            all_astray_are_known() && allowance_m_ < worst_shift_m_ ? allowance_m_ : worst_shift_m_;
        return Scalar(2) * (travelled_m_ + way_m + shift_m) <= margin_m_;
    }
    bool is_astray(std::uint32_t disc) const { return shift_m_[disc] > allowance_m_; }
    void goes_astray(std::uint32_t disc);
    // In the last look.
    Scalar way_of_nearly_all_m() const {
        return last_move_m_ < usual_way_m_ ? last_move_m_ : usual_way_m_;
    }
    Scalar usual_way_now() const;
    Scalar slop_for(Scalar farthest_m) const;
    void make(const Discs<Scalar>& discs);
    void note_ends(std::uint32_t discs);
    Scalar margin_for(Scalar reach_m) const;
    void pick(const Discs<Scalar>& discs, std::size_t part, std::vector<DiscPair>& pairs);
    bool overlap(const Discs<Scalar>& discs, std::uint32_t a, std::uint32_t b) const;
    void find_those_astray(const Discs<Scalar>& discs, std::vector<DiscPair>& pairs) const;

    const CrowdKernels<Scalar>* kernels_;
    CellGrid<Scalar> grid_;
    std::optional<Box> box_;
    NearPairs near_;
    std::vector<std::uint32_t> ends_;  // of each part of near_: no disc in it has this number
    std::vector<std::uint32_t> picked_;

    bool holds_ = false;
    Scalar margin_m_ = Scalar(0);
    Scalar last_move_m_ = Scalar(0);  // of the farthest
    // Of nearly all in a look; of all where none may go astray.
    Scalar usual_way_m_ = std::numeric_limits<Scalar>::infinity();
    Scalar travelled_m_ = Scalar(0);  // by any disc since the list was made, but for its shift
    RoomyVector<Scalar> shift_m_;     // by disc
    Scalar allowance_m_ = Scalar(0);  // for a shift; with more a disc is astray
    Scalar worst_shift_m_ = Scalar(0);
    std::vector<std::uint32_t> astray_;
    std::size_t went_astray_ = 0;  // also those for whom there was no room
    std::size_t most_astray_ = 0;
    Scalar farthest_m_ = Scalar(0);  // no coordinate is larger
    Scalar slop_m_ = Scalar(0);      // above the round-off of a place, or of a distance
};

template <typename Scalar>
template <typename Move>
bool NearList<Scalar>::move_and_find_overlaps(const Discs<Scalar>& discs, Move move,
                                              std::vector<DiscPair>& pairs) {
    pairs.clear();
    std::uint32_t done = 0;
    Scalar farthest_m = Scalar(0);
    if (shift_m_.size() < discs.count()) shift_m_.resize(discs.count());
    const auto went_farther = [this](std::uint32_t disc, Scalar way_m) {
        moved(disc, way_m - usual_way_m_);
    };
    const auto move_all_before = [&](std::uint32_t end) {
        while (done < end) {
            const std::uint32_t to = std::min(done + kDiscsAtOnce, discs.count());
            farthest_m = std::max(farthest_m, move(done, to, usual_way_m_, went_farther));
            done = to;
        }
    };
    const bool expected = is_expected_to_hold();
    if (expected) {
        slop_m_ = slop_for(farthest_m_ + longest_way_m());
        for (std::size_t part = 0; part < ends_.size(); ++part) {
            move_all_before(ends_[part]);
            pick(discs, part, pairs);
        }
    }
    move_all_before(discs.count());
    all_moved(farthest_m);
    const bool held = holds();
    if (!(expected && held)) {
        pairs.clear();
        if (!held) make(discs);
        for (std::size_t part = 0; part < ends_.size(); ++part) pick(discs, part, pairs);
    }
    find_those_astray(discs, pairs);
    return !held;
}

extern template class NearList<double>;
extern template class NearList<float>;

}  // namespace fts::physics
