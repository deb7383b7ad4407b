#include "common/physics/solver_discrete.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/physics/boundary.h"
#include "common/physics/centre_line.h"
#include "common/physics/crowd_copy.h"
#include "common/physics/diagnostics.h"
#include "common/physics/hit_order.h"
#include "common/physics/near_list.h"
#include "common/physics/periodic.h"
#include "common/physics/roomy_vector.h"

namespace fts::physics {
namespace {

// Lists of near pairs after which the cells are fitted anew and neighbours brought together in
// memory.
constexpr std::uint32_t kListsPerOrder = 32;
// How many hits ahead of its turn a hit's bodies are fetched.
constexpr std::size_t kHitsAhead = 12;

// Both ends belong to it, as the upper ones of the box do not.
template <typename Box>
Box inside_of(const Box& box) {
    using Scalar = std::decay_t<decltype(box.max_m.x())>;
    constexpr Scalar kDown = -std::numeric_limits<Scalar>::infinity();
    return {box.min_m,
            {std::nextafter(box.max_m.x(), kDown), std::nextafter(box.max_m.y(), kDown)}};
}

template <typename Scalar>
class DiscreteSolver final : public Solver<Scalar> {
  public:
    DiscreteSolver(std::uint32_t substeps, SimdLevel level)
        : substeps_(substeps), kernels_(&crowd_kernels<Scalar>(level)), near_(level) {}

    DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                              Record<Scalar>& record) override;
    void forget() override { forgotten_ = true; }
    void synchronise_positions(Bodies<Scalar>& bodies) override { crowd_.write_positions(bodies); }
    void synchronise_velocities(Bodies<Scalar>& bodies) override {
        crowd_.write_velocities(bodies);
    }

  private:
    using Vec = Vec2<Scalar>;
    using Box = typename Model<Scalar>::Box;
    using Resolve = void (DiscreteSolver::*)(Scalar);
    using Line = CentreLine<Scalar>;

    // What only some scenes need is never inlined, so that a count of instructions shows it apart
    // (scripts/feature-cost).
    void gather(const Bodies<Scalar>& bodies);
    struct Places {
        std::uint32_t from, to;
    };
    Places all() const { return {0, crowd_.count()}; }
    template <typename Tell>
    Scalar advance(Places some, Scalar span_s, Scalar usual_m, Tell went_farther);
    [[gnu::noinline]] void wrap_all(Places some);
    void move_and_find_pairs(Scalar span_s);
    void put_hits_in_order();
    void bring_neighbours_together();
    Resolve resolve_for_model() const;
    template <bool kEqualRadii, bool kEqualMasses, bool kPeriodic>
    void resolve(Scalar time_s);
    template <bool kEqualRadii, bool kEqualMasses, bool kPeriodic>
    void resolve_pair(const BodyPair& hit, Scalar time_s);
    [[gnu::always_inline]] inline void fetch(const BodyPair& hit) const;
    template <bool kPeriodic>
    [[gnu::always_inline]] inline Line line_of_centres(std::uint32_t a, std::uint32_t b) const;
    template <bool kEqualMasses>
    void record_collision(const BodyPair& hit, const Line& line, Scalar strength, Scalar overlap_m,
                          Scalar time_s);
    std::span<const std::uint32_t> outside(const Box& box, Places among);
    void wrap(std::uint32_t i);
    template <bool kEqualRadii>
    [[gnu::noinline]] void reflect_from_walls(Scalar time_s);
    void reflect(std::uint32_t i, const Box& room, Scalar time_s);
    template <typename Shape>
    [[gnu::noinline]] void drop_who_is_off(const Shape& shape, Scalar time_s);
    void drop(std::uint32_t slot, Scalar time_s);

    std::uint32_t substeps_;
    const CrowdKernels<Scalar>* kernels_;
    bool forgotten_ = true;
    std::uint32_t lists_until_order_ = 0;

    Bodies<Scalar>* bodies_ = nullptr;
    const Model<Scalar>* model_ = nullptr;
    Record<Scalar>* record_ = nullptr;
    std::uint32_t events_ = 0;

    CrowdCopy<Scalar> crowd_;
    NearList<Scalar> near_;
    std::vector<DiscPair> pairs_;  // of places
    std::vector<BodyPair> hits_;
    HitOrder hit_order_;
    RoomyVector<std::uint32_t> order_;
    std::vector<std::uint32_t> outside_, fast_;
    std::span<const std::uint32_t> near_walls_;  // who may reach one while near_ holds; in outside_
    Box inside_;                                 // of the periodic box, both ends inclusive
    std::vector<std::uint32_t> slots_;           // of those at the boundary
};

template <typename Scalar>
DriftReport<Scalar> DiscreteSolver<Scalar>::drift(Bodies<Scalar>& bodies,
                                                  const Model<Scalar>& model, Scalar span_s,
                                                  Record<Scalar>& record) {
    bodies_ = &bodies;
    model_ = &model;
    record_ = &record;
    events_ = 0;
    if (forgotten_) gather(bodies);
    if (model.periodic) inside_ = inside_of(*model.periodic);
    const Scalar step_s = span_s / static_cast<Scalar>(substeps_);
    const Resolve resolve_pairs = resolve_for_model();
    for (std::uint32_t k = 1; k <= substeps_; ++k) {
        const Scalar time_s = k == substeps_ ? span_s : step_s * static_cast<Scalar>(k);
        move_and_find_pairs(step_s);
        put_hits_in_order();
        (this->*resolve_pairs)(time_s);
        if (lists_until_order_ == 0) bring_neighbours_together();
        if (model.walls) {
            model.equal_radii ? reflect_from_walls<true>(time_s)
                              : reflect_from_walls<false>(time_s);
        }
        if (model.platform) {
            std::visit([&](const auto& shape) { drop_who_is_off(shape, time_s); }, *model.platform);
        }
    }
    crowd_.is_ahead();
    return {events_, false, Scalar(0)};
}

template <typename Scalar>
void DiscreteSolver<Scalar>::gather(const Bodies<Scalar>& bodies) {
    const auto same = crowd_.gather(bodies, *model_);
    fast_.resize(crowd_.count());
    if (!same.positions || !same.radii) near_.fit(crowd_.discs(), model_->periodic);
    if (!same.bodies || !same.radii) lists_until_order_ = 1;
    forgotten_ = false;
}

// As NearList wants it.
template <typename Scalar>
template <typename Tell>
Scalar DiscreteSolver<Scalar>::advance(Places some, Scalar span_s, Scalar usual_m,
                                       Tell went_farther) {
    const auto [from, to] = some;
    const Scalar usual_mps = usual_m / span_s;
    const Speeds<Scalar> speeds = kernels_->advance(
        {crowd_.x_m.data() + from, crowd_.y_m.data() + from, crowd_.vx_mps.data() + from,
         crowd_.vy_mps.data() + from, to - from, span_s, usual_mps * usual_mps, fast_.data()});
    for (std::size_t k = 0; k < speeds.faster; ++k) {
        const std::uint32_t i = from + fast_[k];
        const Scalar squared =
            crowd_.vx_mps[i] * crowd_.vx_mps[i] + crowd_.vy_mps[i] * crowd_.vy_mps[i];
        went_farther(i, span_s * std::sqrt(squared));
    }
    if (model_->periodic) wrap_all(some);
    return span_s * std::sqrt(speeds.greatest_squared);
}

template <typename Scalar>
void DiscreteSolver<Scalar>::wrap_all(Places some) {
    for (const std::uint32_t i : outside(inside_, some)) wrap(some.from + i);
}

template <typename Scalar>
std::span<const std::uint32_t> DiscreteSolver<Scalar>::outside(const Box& box, Places among) {
    const auto [from, to] = among;
    const Range2<Scalar> inside = {box.min_m.x(), box.max_m.x(), box.min_m.y(), box.max_m.y()};
    if (outside_.size() < crowd_.count()) outside_.resize(crowd_.count());
    return {outside_.data(), kernels_->outside(crowd_.x_m.data() + from, crowd_.y_m.data() + from,
                                               to - from, inside, outside_.data())};
}

template <typename Scalar>
void DiscreteSolver<Scalar>::wrap(std::uint32_t i) {
    const Vec inside_m = wrapped<Scalar>({crowd_.x_m[i], crowd_.y_m[i]}, *model_->periodic);
    crowd_.x_m[i] = inside_m.x();
    crowd_.y_m[i] = inside_m.y();
}

template <typename Scalar>
void DiscreteSolver<Scalar>::move_and_find_pairs(Scalar span_s) {
    const auto move = [&](std::uint32_t from, std::uint32_t to, Scalar usual_m, auto went_farther) {
        return advance({from, to}, span_s, usual_m, went_farther);
    };
    if (!near_.move_and_find_overlaps(crowd_.discs(), move, pairs_)) return;
    --lists_until_order_;
    if (!model_->walls) return;
    const Box room = room_for(*model_->walls, crowd_.largest_radius_m);
    const Vec way_m = Vec::Constant(near_.longest_way_m());
    near_walls_ = outside({room.min_m + way_m, room.max_m - way_m}, all());
}

// In the order of slots, so that neither the grid nor the order in memory shows in the outcome.
template <typename Scalar>
void DiscreteSolver<Scalar>::put_hits_in_order() {
    hits_.clear();
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
        const DiscPair& ahead = pairs_[std::min(k + kHitsAhead, pairs_.size() - 1)];
        for (const std::uint32_t i : {ahead.a, ahead.b}) __builtin_prefetch(crowd_.id.data() + i);
        const auto [place_a, place_b] = pairs_[k];
        const BodyId a = crowd_.id[place_a], b = crowd_.id[place_b];
        hits_.push_back(a.index < b.index ? BodyPair{a, b, place_a, place_b}
                                          : BodyPair{b, a, place_b, place_a});
    }
    hit_order_.sort(hits_, crowd_.slots());
}

template <typename Scalar>
void DiscreteSolver<Scalar>::bring_neighbours_together() {
    near_.read_order(order_);
    crowd_.reorder(order_);
    near_.fit(crowd_.discs(), model_->periodic);
    lists_until_order_ = kListsPerOrder;
}

template <typename Scalar>
auto DiscreteSolver<Scalar>::resolve_for_model() const -> Resolve {
    constexpr std::array<Resolve, 8> kByFeatures = {
        &DiscreteSolver::resolve<false, false, false>, &DiscreteSolver::resolve<false, false, true>,
        &DiscreteSolver::resolve<false, true, false>,  &DiscreteSolver::resolve<false, true, true>,
        &DiscreteSolver::resolve<true, false, false>,  &DiscreteSolver::resolve<true, false, true>,
        &DiscreteSolver::resolve<true, true, false>,   &DiscreteSolver::resolve<true, true, true>};
    return kByFeatures[(model_->equal_radii ? 4U : 0U) + (model_->equal_masses ? 2U : 0U) +
                       (model_->periodic ? 1U : 0U)];
}

template <typename Scalar>
template <bool kEqualRadii, bool kEqualMasses, bool kPeriodic>
void DiscreteSolver<Scalar>::resolve(Scalar time_s) {
    const std::size_t hits = hits_.size();
    for (std::size_t k = 0; k < hits; ++k) {
        if (k + kHitsAhead < hits) fetch(hits_[k + kHitsAhead]);
        resolve_pair<kEqualRadii, kEqualMasses, kPeriodic>(hits_[k], time_s);
    }
}

// Who hits whom is scattered over the memory of a large crowd. Inlined, or gcc leaves calls away
// that only fetch.
template <typename Scalar>
inline void DiscreteSolver<Scalar>::fetch(const BodyPair& hit) const {
    for (const std::uint32_t i : {hit.place_a, hit.place_b}) {
        for (const RoomyVector<Scalar>* values :
             {&crowd_.x_m, &crowd_.y_m, &crowd_.vx_mps, &crowd_.vy_mps}) {
            __builtin_prefetch(values->data() + i);
        }
        near_.fetch(i);
    }
}

template <typename Scalar>
template <bool kEqualRadii, bool kEqualMasses, bool kPeriodic>
void DiscreteSolver<Scalar>::resolve_pair(const BodyPair& hit, Scalar time_s) {
    const std::uint32_t a = hit.place_a, b = hit.place_b;
    Scalar share_a = Scalar(0.5), share_b = Scalar(0.5);
    if constexpr (!kEqualMasses) {
        const Scalar both = crowd_.inverse_mass_per_kg[a] + crowd_.inverse_mass_per_kg[b];
        if (!(both > Scalar(0))) return;
        share_a = crowd_.inverse_mass_per_kg[a] / both;
        share_b = crowd_.inverse_mass_per_kg[b] / both;
    }
    const Line line = line_of_centres<kPeriodic>(a, b);
    const Scalar reach = kEqualRadii ? crowd_.largest_radius_m + crowd_.largest_radius_m
                                     : crowd_.radius_m[a] + crowd_.radius_m[b];
    const Scalar overlap = std::max(Scalar(0), reach - line.distance_m);
    const Scalar rate = line.x * (crowd_.vx_mps[a] - crowd_.vx_mps[b]) +
                        line.y * (crowd_.vy_mps[a] - crowd_.vy_mps[b]);
    if (rate < Scalar(0)) {
        const Scalar strength = -(Scalar(1) + model_->restitution) * (rate / line.squared);
        record_collision<kEqualMasses>(hit, line, strength, overlap, time_s);
        Contact<Scalar>& contact = record_->contacts.back();
        crowd_.vx_mps[a] += strength * share_a * line.x;
        crowd_.vy_mps[a] += strength * share_a * line.y;
        crowd_.vx_mps[b] -= strength * share_b * line.x;
        crowd_.vy_mps[b] -= strength * share_b * line.y;
        contact.velocity_a_after_mps = {crowd_.vx_mps[a], crowd_.vy_mps[a]};
        contact.velocity_b_after_mps = {crowd_.vx_mps[b], crowd_.vy_mps[b]};
        account(contact, record_->audit);
        ++events_;
    }
    if (!(overlap > Scalar(0))) return;
    const Scalar way = overlap / line.length;
    crowd_.x_m[a] += way * share_a * line.x;
    crowd_.y_m[a] += way * share_a * line.y;
    crowd_.x_m[b] -= way * share_b * line.x;
    crowd_.y_m[b] -= way * share_b * line.y;
    near_.moved(a, overlap * share_a);
    near_.moved(b, overlap * share_b);
    if constexpr (kPeriodic) {
        for (const std::uint32_t i : {a, b}) {
            if (!is_within<Scalar>(inside_, crowd_.x_m[i], crowd_.y_m[i])) wrap(i);
        }
    }
}

template <typename Scalar>
template <bool kPeriodic>
inline auto DiscreteSolver<Scalar>::line_of_centres(std::uint32_t a, std::uint32_t b) const
    -> Line {
    Vec separation_m(crowd_.x_m[a] - crowd_.x_m[b], crowd_.y_m[a] - crowd_.y_m[b]);
    if constexpr (kPeriodic) {
        separation_m = nearest_image<Scalar>(separation_m, model_->periodic);
    }
    return centre_line<Scalar>(separation_m, {crowd_.vx_mps[a], crowd_.vy_mps[a]},
                               {crowd_.vx_mps[b], crowd_.vy_mps[b]});
}

// With the velocities before; `strength` times the line is what the velocities come apart by.
template <typename Scalar>
template <bool kEqualMasses>
void DiscreteSolver<Scalar>::record_collision(const BodyPair& hit, const Line& line,
                                              Scalar strength, Scalar overlap_m, Scalar time_s) {
    const Bodies<Scalar>& all = *bodies_;
    const std::uint32_t a = hit.place_a, b = hit.place_b;
    const Scalar mass_a = all.mass_kg[kEqualMasses ? crowd_.id.front().index : hit.a.index];
    const Scalar mass_b = kEqualMasses ? mass_a : all.mass_kg[hit.b.index];
    const Scalar reduced_kg = Scalar(1) / (Scalar(1) / mass_a + Scalar(1) / mass_b);
    const Vec normal(line.x / line.length, line.y / line.length);
    const Vec position_a(crowd_.x_m[a], crowd_.y_m[a]);
    const Scalar radius_a = crowd_.radius_of(a);
    const Vec still = Vec::Zero();  // the velocities after are known later
    record_->contacts.push_back({.a = hit.a,
                                 .b = hit.b,
                                 .time_s = time_s,
                                 .point_m = position_a - radius_a * normal,
                                 .normal = normal,
                                 .impulse_ns = strength * line.length * reduced_kg,
                                 .position_a_m = position_a,
                                 .position_b_m = position_a - line.distance_m * normal,
                                 .velocity_a_before_mps = {crowd_.vx_mps[a], crowd_.vy_mps[a]},
                                 .velocity_a_after_mps = still,
                                 .velocity_b_before_mps = {crowd_.vx_mps[b], crowd_.vy_mps[b]},
                                 .velocity_b_after_mps = still,
                                 .mass_a_kg = mass_a,
                                 .mass_b_kg = mass_b,
                                 .penetration = overlap_m / std::min(radius_a, crowd_.radius_of(b)),
                                 .contacts_at_once = 1});
}

template <typename Scalar>
template <bool kEqualRadii>
void DiscreteSolver<Scalar>::reflect_from_walls(Scalar time_s) {
    const Box room = room_for(*model_->walls, crowd_.largest_radius_m);
    slots_.clear();
    const auto take_those_outside = [&](std::span<const std::uint32_t> places) {
        for (const std::uint32_t i : places) {
            const Scalar radius = kEqualRadii ? crowd_.largest_radius_m : crowd_.radius_m[i];
            const Box own = room_for(*model_->walls, radius);
            if (!is_within<Scalar>(own, crowd_.x_m[i], crowd_.y_m[i]))
                slots_.push_back(crowd_.id[i].index);
        }
    };
    if (near_.holds()) {
        take_those_outside(near_walls_);
        take_those_outside(near_.astray());
    } else {
        take_those_outside(outside(room, all()));
    }
    std::sort(slots_.begin(), slots_.end());
    slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
    for (const std::uint32_t slot : slots_) {
        const std::uint32_t i = crowd_.place_of(slot);
        reflect(i, room_for(*model_->walls, crowd_.radius_of(i)), time_s);
    }
}

template <typename Scalar>
void DiscreteSolver<Scalar>::reflect(std::uint32_t i, const Box& room, Scalar time_s) {
    const Scalar mass = bodies_->mass_kg[crowd_.id[i].index];
    if (std::isinf(mass)) return;
    WallHitter<Scalar> body{crowd_.id[i],
                            {crowd_.x_m[i], crowd_.y_m[i]},
                            {crowd_.vx_mps[i], crowd_.vy_mps[i]},
                            crowd_.radius_of(i),
                            mass};
    events_ += bounce(body, room, model_->restitution, time_s, *record_);
    near_.moved(i, std::abs(body.position_m.x() - crowd_.x_m[i]) +
                       std::abs(body.position_m.y() - crowd_.y_m[i]));
    crowd_.x_m[i] = body.position_m.x();
    crowd_.y_m[i] = body.position_m.y();
    crowd_.vx_mps[i] = body.velocity_mps.x();
    crowd_.vy_mps[i] = body.velocity_mps.y();
}

template <typename Scalar>
template <typename Shape>
void DiscreteSolver<Scalar>::drop_who_is_off(const Shape& shape, Scalar time_s) {
    slots_.clear();
    for (std::uint32_t i = 0; i < crowd_.count(); ++i) {
        if (is_off(shape, crowd_.x_m[i], crowd_.y_m[i])) slots_.push_back(crowd_.id[i].index);
    }
    std::sort(slots_.begin(), slots_.end());
    for (const std::uint32_t slot : slots_) drop(slot, time_s);
}

template <typename Scalar>
void DiscreteSolver<Scalar>::drop(std::uint32_t slot, Scalar time_s) {
    const std::uint32_t i = crowd_.place_of(slot);
    record_->falls.push_back({crowd_.id[i],
                              time_s,
                              {crowd_.x_m[i], crowd_.y_m[i]},
                              {crowd_.vx_mps[i], crowd_.vy_mps[i]}});
    bodies_->remove(slot);
    near_.forget();
    crowd_.remove(i);
    ++events_;
}

}  // namespace

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_discrete_solver(std::uint32_t substeps, SimdLevel level) {
    return std::make_unique<DiscreteSolver<Scalar>>(substeps, level);
}

template std::unique_ptr<Solver<double>> make_discrete_solver(std::uint32_t, SimdLevel);
template std::unique_ptr<Solver<float>> make_discrete_solver(std::uint32_t, SimdLevel);

}  // namespace fts::physics
