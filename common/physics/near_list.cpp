#include "common/physics/near_list.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/physics/periodic.h"

namespace fts::physics {
namespace {

// For so many looks a list is meant to hold.
constexpr double kLooks = 8.0;
// Who is shifted by more than the usual way of so many is astray.
constexpr double kLooksAside = 1.0;
// A wider margin, in units of the largest disc's reach, has more pairs than it saves lists.
constexpr double kWidestMargin = 0.95;
// One of so many may go astray, and not more than these, since they are compared with each other.
constexpr std::uint32_t kDiscsToOneAstray = 1024;
constexpr std::size_t kMostAstray = 512;
// What is usual is found list by list, a little at a time but where it is far off.
constexpr double kMuchTighter = 0.8, kTighter = 0.96, kSlightlyTighter = 0.99, kWider = 1.06;
constexpr std::size_t kFarTooMany = 4;
// So few are all still there after they were moved.
constexpr std::uint32_t kDiscsInCache = 16'384;
// In units of the last place of the largest coordinate.
constexpr double kSlopUlps = 16.0;

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
void NearList<Scalar>::all_moved(Scalar farthest_m) {
    last_move_m_ = farthest_m;
    farthest_m_ += farthest_m + worst_shift_m_;
    slop_m_ = slop_for(farthest_m_);
    travelled_m_ += way_of_nearly_all_m() + slop_m_;
}

template <typename Scalar>
Scalar NearList<Scalar>::slop_for(Scalar farthest_m) const {
    return farthest_m * (static_cast<Scalar>(kSlopUlps) * std::numeric_limits<Scalar>::epsilon());
}

// If discs move as in the look before.
template <typename Scalar>
bool NearList<Scalar>::is_expected_to_hold() const {
    return holds() && still_holds_after(way_of_nearly_all_m() + slop_m_);
}

template <typename Scalar>
void NearList<Scalar>::goes_astray(std::uint32_t disc) {
    ++went_astray_;
    if (astray_.size() < most_astray_) astray_.push_back(disc);
}

// By how many went astray from the last list.
template <typename Scalar>
Scalar NearList<Scalar>::usual_way_now() const {
    if (went_astray_ > kFarTooMany * most_astray_) return last_move_m_;
    double factor = kSlightlyTighter;
    if (went_astray_ > most_astray_) factor = kWider;
    if (went_astray_ <= most_astray_ / 2) factor = kTighter;
    if (went_astray_ == 0) factor = kMuchTighter;
    return std::min(last_move_m_, usual_way_m_ * static_cast<Scalar>(factor));
}

template <typename Scalar>
Scalar NearList<Scalar>::margin_for(Scalar reach_m) const {
    const Scalar a_look = Scalar(2) * (way_of_nearly_all_m() + slop_m_);
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
    most_astray_ = box_ ? 0 : std::min<std::size_t>(discs.count() / kDiscsToOneAstray, kMostAstray);
    constexpr Scalar kAnyWay = std::numeric_limits<Scalar>::infinity();
    usual_way_m_ = most_astray_ > 0 ? usual_way_now() : kAnyWay;
    allowance_m_ = static_cast<Scalar>(kLooksAside) * usual_way_m_;
    margin_m_ = margin_for(Scalar(2) * discs.largest_radius_m);
    travelled_m_ = slop_m_;
    worst_shift_m_ = Scalar(0);
    shift_m_.assign(discs.count(), Scalar(0));
    astray_.clear();
    went_astray_ = 0;
    // A list for this look alone is made with the arithmetic that decides: places far away, which
    // are coarse, must not widen the search for all. In a box no place is far.
    const bool is_kept = margin_m_ > Scalar(0);
    grid_.find_near(discs, is_kept || box_ ? margin_m_ + slop_m_ : Scalar(0), near_);
    note_ends(discs.count());
    picked_.resize(kPairsAtOnce);
    holds_ = true;
}

template <typename Scalar>
void NearList<Scalar>::note_ends(std::uint32_t discs) {
    ends_.clear();
    if (discs <= kDiscsInCache) {
        ends_.assign((near_.count + kPairsAtOnce - 1) / kPairsAtOnce, discs);
        return;
    }
    for (std::size_t from = 0; from < near_.count; from += kPairsAtOnce) {
        const std::size_t to = std::min(from + kPairsAtOnce, near_.count);
        std::uint32_t last_a = 0, last_b = 0;
        for (std::size_t k = from; k < to; ++k) {
            last_a = std::max(last_a, near_.a[k]);
            last_b = std::max(last_b, near_.b[k]);
        }
        ends_.push_back(std::max(last_a, last_b) + 1);
    }
}

template <typename Scalar>
void NearList<Scalar>::pick(const Discs<Scalar>& discs, std::size_t part,
                            std::vector<DiscPair>& pairs) {
    const bool equal = discs.radius_m.empty();
    const Scalar sum_of_equal = discs.largest_radius_m + discs.largest_radius_m;
    const Vec2<Scalar> extent_m = box_ ? box_->extent_m() : Vec2<Scalar>(Vec2<Scalar>::Zero());
    const std::size_t from = part * kPairsAtOnce;
    const PairTest<Scalar> test = {discs.x_m.data(),
                                   discs.y_m.data(),
                                   equal ? nullptr : discs.radius_m.data(),
                                   near_.a.data() + from,
                                   near_.b.data() + from,
                                   std::min(kPairsAtOnce, near_.count - from),
                                   (equal ? sum_of_equal : Scalar(0)) + slop_m_,
                                   extent_m.x(),
                                   extent_m.y()};
    const std::size_t count = kernels_->pick(test, picked_.data());
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t a = test.a[picked_[k]], b = test.b[picked_[k]];
        if (overlap(discs, a, b)) pairs.push_back({a, b});
    }
}

template <typename Scalar>
bool NearList<Scalar>::overlap(const Discs<Scalar>& discs, std::uint32_t a, std::uint32_t b) const {
    const Scalar reach = discs.radius_of(a) + discs.radius_of(b);
    const Vec2<Scalar> line =
        nearest_image<Scalar>({discs.x_m[a] - discs.x_m[b], discs.y_m[a] - discs.y_m[b]}, box_);
    return line.squaredNorm() < reach * reach;
}

template <typename Scalar>
void NearList<Scalar>::find_those_astray(const Discs<Scalar>& discs,
                                         std::vector<DiscPair>& pairs) const {
    if (!all_astray_are_known()) return;  // then the list holds for them too
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
        if (overlap(discs, a, b)) pairs.push_back({a, b});
    };
    for (std::size_t k = 0; k < astray_.size(); ++k) {
        const std::uint32_t i = astray_[k];
        const Vec2<Scalar> place_m(discs.x_m[i], discs.y_m[i]);
        const Vec2<Scalar> around_m = Vec2<Scalar>::Constant(
            discs.radius_of(i) + discs.largest_radius_m + longest_way_m() + slop_m_);
        grid_.visit({place_m - around_m, place_m + around_m}, [&](std::uint32_t other) {
            if (!is_astray(other)) compare(i, other);
        });
        for (std::size_t j = 0; j < k; ++j) compare(i, astray_[j]);
    }
}

template class NearList<double>;
template class NearList<float>;

}  // namespace fts::physics
