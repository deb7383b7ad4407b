#include "common/physics/near_list.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/physics/periodic.h"

namespace fts::physics {
namespace {

// For so many looks a list is meant to hold.
constexpr double kLooks = 6.0;
// A wider margin, in units of the largest disc's reach, has more pairs than it saves lists.
constexpr double kWidestMargin = 0.95;
// In units of the last place of the largest coordinate.
constexpr double kSlopUlps = 16.0;

// So many pairs are tested before what was found is looked at again.
constexpr std::size_t kPairsInCache = 4096;

}  // namespace

template <typename Scalar>
NearList<Scalar>::NearList(SimdLevel level)
    : kernels_(&crowd_kernels<Scalar>(level)), grid_(level) {}

template <typename Scalar>
void NearList<Scalar>::fit(const Discs<Scalar>& discs, const std::optional<Box>& box) {
    grid_.fit(discs, box);
    box_ = box;
    farthest_m_ = Scalar(0);
    for (std::uint32_t i = 0; i < discs.count(); ++i) {
        farthest_m_ = std::max({farthest_m_, std::abs(discs.x_m[i]), std::abs(discs.y_m[i])});
    }
    farthest_m_ += Scalar(4) * discs.largest_radius_m;
    if (box) farthest_m_ += box->extent_m().sum();
    forget();
}

template <typename Scalar>
void NearList<Scalar>::all_moved(Scalar at_most_m) {
    last_move_m_ = at_most_m;
    farthest_m_ += at_most_m + worst_shift_m_;
    slop_m_ =
        farthest_m_ * (static_cast<Scalar>(kSlopUlps) * std::numeric_limits<Scalar>::epsilon());
    travelled_m_ += at_most_m + slop_m_;
}

template <typename Scalar>
bool NearList<Scalar>::find_overlaps(const Discs<Scalar>& discs, std::vector<DiscPair>& pairs) {
    const bool anew = !holds();
    if (anew) make(discs);
    pick(discs, pairs);
    return anew;
}

template <typename Scalar>
Scalar NearList<Scalar>::margin_for(Scalar reach_m) const {
    const Scalar a_look = Scalar(2) * (last_move_m_ + slop_m_);
    const Scalar widest = static_cast<Scalar>(kWidestMargin) * reach_m;
    const Scalar margin = std::min(static_cast<Scalar>(kLooks) * a_look, widest);
    if (!(margin > a_look)) return Scalar(0);
    // A pair is near through one image only.
    if (box_ && !(Scalar(2) * (reach_m + margin + slop_m_) < box_->extent_m().minCoeff())) {
        return Scalar(0);
    }
    return margin;
}

template <typename Scalar>
void NearList<Scalar>::make(const Discs<Scalar>& discs) {
    margin_m_ = margin_for(Scalar(2) * discs.largest_radius_m);
    travelled_m_ = slop_m_;
    worst_shift_m_ = Scalar(0);
    shift_m_.assign(discs.count(), Scalar(0));
    // A list for this look alone is made with the arithmetic that decides: places far away, which
    // are coarse, must not widen the search for all. In a box no place is far.
    const bool is_kept = margin_m_ > Scalar(0);
    grid_.find_near(discs, is_kept || box_ ? margin_m_ + slop_m_ : Scalar(0), near_);
    picked_.resize(kPairsInCache);
    holds_ = true;
}

template <typename Scalar>
void NearList<Scalar>::pick(const Discs<Scalar>& discs, std::vector<DiscPair>& pairs) {
    const bool equal = discs.radius_m.empty();
    const Scalar sum_of_equal = discs.largest_radius_m + discs.largest_radius_m;
    const Vec2<Scalar> extent_m = box_ ? box_->extent_m() : Vec2<Scalar>(Vec2<Scalar>::Zero());
    for (std::size_t from = 0; from < near_.count; from += kPairsInCache) {
        const PairTest<Scalar> test = {discs.x_m.data(),
                                       discs.y_m.data(),
                                       equal ? nullptr : discs.radius_m.data(),
                                       near_.a.data() + from,
                                       near_.b.data() + from,
                                       std::min(kPairsInCache, near_.count - from),
                                       (equal ? sum_of_equal : Scalar(0)) + slop_m_,
                                       extent_m.x(),
                                       extent_m.y()};
        const std::size_t count = kernels_->pick(test, picked_.data());
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t a = test.a[picked_[k]], b = test.b[picked_[k]];
            const Scalar reach = equal ? sum_of_equal : discs.radius_m[a] + discs.radius_m[b];
            const Vec2<Scalar> line = nearest_image<Scalar>(
                {discs.x_m[a] - discs.x_m[b], discs.y_m[a] - discs.y_m[b]}, box_);
            if (line.squaredNorm() < reach * reach) pairs.push_back({a, b});
        }
    }
}

template class NearList<double>;
template class NearList<float>;

}  // namespace fts::physics
