// Which discs overlap, look after look, while they move little in between: a list of the pairs that
// are nearer than their radii and a margin (L. Verlet 1967), made by CellGrid. It holds until some
// disc may have moved by half the margin, so that most looks test the list's few pairs only. Where
// discs move so far between looks that a list would be good for one, the margin is nothing.
//
// What is found does not depend on the margin, nor on when the list is made.
#pragma once

#include <cstdint>
#include <optional>
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

    // Since the last look every disc has moved, by `at_most_m`; to be told once a look.
    void all_moved(Scalar at_most_m);
    // And this one further.
    void moved(std::uint32_t disc, Scalar by_m) {
        shift_m_[disc] += by_m + slop_m_;
        worst_shift_m_ = shift_m_[disc] > worst_shift_m_ ? shift_m_[disc] : worst_shift_m_;
    }
    // While the list holds no disc is further than this from where it was when it was made.
    Scalar longest_way_m() const { return Scalar(0.5) * margin_m_ + slop_m_; }
    bool holds() const {
        return holds_ && Scalar(2) * (travelled_m_ + worst_shift_m_) <= margin_m_;
    }
    // It will soon be told to have moved. Inlined, or gcc leaves calls away that only fetch.
    [[gnu::always_inline]] void fetch(std::uint32_t disc) const {
        __builtin_prefetch(shift_m_.data() + disc, 1);
    }

    // Every pair whose distance is below the sum of its radii, in any order: with a box (then all
    // places must be inside) the distance to the nearest image. Each once, but in a box so tight
    // that a pair may be near through two images. True when it has made
    // the list anew.
    bool find_overlaps(const Discs<Scalar>& discs, std::vector<DiscPair>& pairs);

    // Of the discs when the list was made, neighbours near each other.
    void read_order(RoomyVector<std::uint32_t>& order) const { grid_.read_order(order); }

  private:
    void make(const Discs<Scalar>& discs);
    Scalar margin_for(Scalar reach_m) const;
    void pick(const Discs<Scalar>& discs, std::vector<DiscPair>& pairs);

    const CrowdKernels<Scalar>* kernels_;
    CellGrid<Scalar> grid_;
    std::optional<Box> box_;
    NearPairs near_;
    std::vector<std::uint32_t> picked_;

    bool holds_ = false;
    Scalar margin_m_ = Scalar(0);
    Scalar last_move_m_ = Scalar(0);
    Scalar travelled_m_ = Scalar(0);  // by any disc since the list was made, but for its shift
    RoomyVector<Scalar> shift_m_;     // by disc
    Scalar worst_shift_m_ = Scalar(0);
    Scalar farthest_m_ = Scalar(0);  // no coordinate is larger
    Scalar slop_m_ = Scalar(0);      // above the round-off of a place, or of a distance
};

extern template class NearList<double>;
extern template class NearList<float>;

}  // namespace fts::physics
