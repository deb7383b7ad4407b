#include "common/physics/solver_discrete.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "common/physics/boundary.h"
#include "common/physics/centre_line.h"
#include "common/physics/diagnostics.h"
#include "common/physics/hit_order.h"
#include "common/physics/near_list.h"
#include "common/physics/periodic.h"
#include "common/physics/roomy_vector.h"
#include "common/physics/slot_scatter.h"

namespace fts::physics {
namespace {

// Lists of near pairs after which the cells are fitted anew and neighbours brought together in
// memory.
constexpr std::uint32_t kListsPerOrder = 32;
// How many hits ahead of its turn a hit's bodies are fetched.
constexpr std::size_t kHitsAhead = 12;

template <typename Scalar>
class DiscreteSolver final : public Solver<Scalar> {
  public:
    DiscreteSolver(std::uint32_t substeps, SimdLevel level)
        : substeps_(substeps), kernels_(&crowd_kernels<Scalar>(level)), near_(level) {}

    DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                              Record<Scalar>& record) override;
    void forget() override { forgotten_ = true; }
    void synchronise_positions(Bodies<Scalar>& bodies) override;
    void synchronise_velocities(Bodies<Scalar>& bodies) override;

  private:
    using Vec = Vec2<Scalar>;
    using Box = typename Model<Scalar>::Box;
    using Resolve = void (DiscreteSolver::*)(Scalar);
    using Line = CentreLine<Scalar>;

    // What only some scenes need is never inlined, so that a count of instructions shows it apart
    // (scripts/feature-cost).
    void gather(const Bodies<Scalar>& bodies);
    bool gather_radii(const Bodies<Scalar>& bodies);
    bool holds_just(const Bodies<Scalar>& bodies) const;
    void take_in_order_of_ids(const Bodies<Scalar>& bodies);
    Scalar advance(Scalar span_s);
    [[gnu::noinline]] Scalar advance_in_box(Scalar span_s);
    void find_pairs();
    void bring_neighbours_together();
    Resolve resolve_for_model() const;
    template <bool kEqualRadii, bool kEqualMasses, bool kPeriodic>
    void resolve(Scalar time_s);
    template <bool kEqualRadii, bool kEqualMasses, bool kPeriodic>
    void resolve_pair(const SlotPair& hit, Scalar time_s);
    [[gnu::always_inline]] inline void fetch(const SlotPair& hit) const;
    template <bool kPeriodic>
    [[gnu::always_inline]] inline Line line_of_centres(std::uint32_t a, std::uint32_t b) const;
    template <bool kEqualMasses>
    void record_collision(const SlotPair& hit, const Line& line, Scalar strength, Scalar overlap_m,
                          Scalar time_s);
    std::span<const std::uint32_t> outside(const Box& box);
    void wrap(std::uint32_t i);
    template <bool kEqualRadii>
    [[gnu::noinline]] void reflect_from_walls(Scalar time_s);
    void reflect(std::uint32_t i, const Box& room, Scalar time_s);
    template <typename Shape>
    [[gnu::noinline]] void drop_who_is_off(const Shape& shape, Scalar time_s);
    void drop(std::uint32_t slot, Scalar time_s);

    std::uint32_t count() const { return static_cast<std::uint32_t>(slot_.size()); }
    Scalar radius_of(std::uint32_t i) const {
        return model_->equal_radii ? largest_radius_m_ : radius_m_[i];
    }
    Discs<Scalar> discs() const { return {x_m_, y_m_, radius_m_, largest_radius_m_}; }

    std::uint32_t substeps_;
    const CrowdKernels<Scalar>* kernels_;
    bool forgotten_ = true;
    bool positions_ahead_ = false, velocities_ahead_ = false;  // of the bodies
    std::uint32_t lists_until_order_ = 0;

    Bodies<Scalar>* bodies_ = nullptr;
    const Model<Scalar>* model_ = nullptr;
    Record<Scalar>* record_ = nullptr;
    std::uint32_t events_ = 0;

    // By place in the working copy, in which neighbours are near each other.
    RoomyVector<Scalar> x_m_, y_m_, vx_mps_, vy_mps_;
    RoomyVector<Scalar> radius_m_;             // empty when all are the largest
    RoomyVector<Scalar> inverse_mass_per_kg_;  // empty when all are alike
    RoomyVector<std::uint32_t> slot_;
    Scalar largest_radius_m_ = Scalar(0);
    RoomyVector<std::uint32_t> place_;  // by slot
    SlotScatter<Scalar> to_slots_;

    NearList<Scalar> near_;
    std::vector<DiscPair> pairs_;  // of places
    std::vector<SlotPair> hits_;
    HitOrder hit_order_;
    RoomyVector<std::uint32_t> order_;
    RoomyVector<std::uint32_t> old_slot_;
    RoomyVector<Scalar> old_;
    std::vector<std::uint32_t> outside_;
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
    const Scalar step_s = span_s / static_cast<Scalar>(substeps_);
    const Resolve resolve_pairs = resolve_for_model();
    for (std::uint32_t k = 1; k <= substeps_; ++k) {
        const Scalar time_s = k == substeps_ ? span_s : step_s * static_cast<Scalar>(k);
        near_.all_moved(model.periodic ? advance_in_box(step_s) : advance(step_s));
        find_pairs();
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
    positions_ahead_ = velocities_ahead_ = true;
    return {events_, false, Scalar(0)};
}

template <typename Scalar>
void DiscreteSolver<Scalar>::gather(const Bodies<Scalar>& bodies) {
    const bool same_bodies = holds_just(bodies);
    if (!same_bodies) take_in_order_of_ids(bodies);
    const std::uint32_t bodies_count = count();
    for (auto* values : {&x_m_, &y_m_, &vx_mps_, &vy_mps_}) values->resize(bodies_count);
    bool same_places = same_bodies;
    for (std::uint32_t i = 0; i < bodies_count; ++i) {
        const Vec &position = bodies.position_m[slot_[i]],
                  &velocity = bodies.velocity_mps[slot_[i]];
        same_places &= x_m_[i] == position.x() && y_m_[i] == position.y();
        x_m_[i] = position.x();
        y_m_[i] = position.y();
        vx_mps_[i] = velocity.x();
        vy_mps_[i] = velocity.y();
    }
    inverse_mass_per_kg_.clear();
    const bool same_radii = gather_radii(bodies);
    if (!model_->equal_masses) {
        for (const std::uint32_t slot : slot_) {
            inverse_mass_per_kg_.push_back(Scalar(1) / bodies.mass_kg[slot]);
        }
    }
    if (!same_places || !same_radii) near_.fit(discs(), model_->periodic);
    if (!same_bodies || !same_radii) lists_until_order_ = 1;
    forgotten_ = false;
    positions_ahead_ = velocities_ahead_ = false;
}

// Gives whether they are what they were.
template <typename Scalar>
bool DiscreteSolver<Scalar>::gather_radii(const Bodies<Scalar>& bodies) {
    const bool were_equal = radius_m_.empty();
    const Scalar largest_before = largest_radius_m_;
    largest_radius_m_ = slot_.empty() ? Scalar(0) : bodies.radius_m[slot_.front()];
    if (model_->equal_radii) {
        radius_m_.clear();
        return were_equal && largest_radius_m_ == largest_before;
    }
    bool same = radius_m_.size() == slot_.size();
    radius_m_.resize(slot_.size());
    for (std::uint32_t i = 0; i < count(); ++i) {
        const Scalar radius = bodies.radius_m[slot_[i]];
        same &= radius_m_[i] == radius;
        radius_m_[i] = radius;
        largest_radius_m_ = std::max(largest_radius_m_, radius);
    }
    return same;
}

// What was changed is most often velocities alone; then the order in memory is still good.
template <typename Scalar>
bool DiscreteSolver<Scalar>::holds_just(const Bodies<Scalar>& bodies) const {
    if (slot_.empty() || bodies.ids.size() != slot_.size() || bodies.slots() != place_.size()) {
        return false;
    }
    return std::all_of(slot_.begin(), slot_.end(),
                       [&](std::uint32_t slot) { return bodies.alive[slot] != 0; });
}

template <typename Scalar>
void DiscreteSolver<Scalar>::take_in_order_of_ids(const Bodies<Scalar>& bodies) {
    slot_.clear();
    to_slots_.forget();
    place_.resize(bodies.slots());
    for (const BodyId id : bodies.ids) {
        place_[id.index] = count();
        slot_.push_back(id.index);
    }
}

template <typename Scalar>
void DiscreteSolver<Scalar>::synchronise_positions(Bodies<Scalar>& bodies) {
    if (!std::exchange(positions_ahead_, false)) return;
    to_slots_.write(slot_, x_m_, y_m_, bodies.position_m);
}

template <typename Scalar>
void DiscreteSolver<Scalar>::synchronise_velocities(Bodies<Scalar>& bodies) {
    if (!std::exchange(velocities_ahead_, false)) return;
    to_slots_.write(slot_, vx_mps_, vy_mps_, bodies.velocity_mps);
}

// Gives how far the fastest has gone.
template <typename Scalar>
Scalar DiscreteSolver<Scalar>::advance(Scalar span_s) {
    return span_s * std::sqrt(kernels_->advance(x_m_.data(), y_m_.data(), vx_mps_.data(),
                                                vy_mps_.data(), span_s, count()));
}

template <typename Scalar>
Scalar DiscreteSolver<Scalar>::advance_in_box(Scalar span_s) {
    const Scalar farthest_m = advance(span_s);
    const Box box = *model_->periodic;
    constexpr Scalar kDown = -std::numeric_limits<Scalar>::infinity();
    inside_ = {box.min_m,
               {std::nextafter(box.max_m.x(), kDown), std::nextafter(box.max_m.y(), kDown)}};
    for (const std::uint32_t i : outside(inside_)) wrap(i);
    return farthest_m;
}

template <typename Scalar>
std::span<const std::uint32_t> DiscreteSolver<Scalar>::outside(const Box& box) {
    const Range2<Scalar> inside = {box.min_m.x(), box.max_m.x(), box.min_m.y(), box.max_m.y()};
    if (outside_.size() < count()) outside_.resize(count());
    return {outside_.data(),
            kernels_->outside(x_m_.data(), y_m_.data(), count(), inside, outside_.data())};
}

template <typename Scalar>
void DiscreteSolver<Scalar>::wrap(std::uint32_t i) {
    const Vec inside_m = wrapped<Scalar>({x_m_[i], y_m_[i]}, *model_->periodic);
    x_m_[i] = inside_m.x();
    y_m_[i] = inside_m.y();
}

// In the order of slots, so that neither the grid nor the order in memory shows in the outcome.
template <typename Scalar>
void DiscreteSolver<Scalar>::find_pairs() {
    pairs_.clear();
    const bool listed = near_.find_overlaps(discs(), pairs_);
    hits_.clear();
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
        const auto [a, b] = pairs_[k];
        const DiscPair& ahead = pairs_[std::min(k + kHitsAhead, pairs_.size() - 1)];
        for (const std::uint32_t i : {ahead.a, ahead.b}) __builtin_prefetch(slot_.data() + i);
        hits_.push_back(slot_[a] < slot_[b] ? SlotPair{slot_[a], slot_[b], a, b}
                                            : SlotPair{slot_[b], slot_[a], b, a});
    }
    hit_order_.sort(hits_, static_cast<std::uint32_t>(place_.size()));
    if (!listed) return;
    --lists_until_order_;
    if (!model_->walls) return;
    const Box room = room_for(*model_->walls, largest_radius_m_);
    const Vec way_m = Vec::Constant(near_.longest_way_m());
    near_walls_ = outside({room.min_m + way_m, room.max_m - way_m});
}

template <typename Scalar>
void DiscreteSolver<Scalar>::bring_neighbours_together() {
    near_.read_order(order_);
    for (auto* values : {&x_m_, &y_m_, &vx_mps_, &vy_mps_, &radius_m_, &inverse_mass_per_kg_}) {
        if (values->empty()) continue;
        old_.swap(*values);
        values->clear();
        for (const std::uint32_t from : order_) values->push_back(old_[from]);
    }
    old_slot_.swap(slot_);
    slot_.clear();
    to_slots_.forget();
    for (const std::uint32_t from : order_) {
        place_[old_slot_[from]] = count();
        slot_.push_back(old_slot_[from]);
    }
    near_.fit(discs(), model_->periodic);
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
inline void DiscreteSolver<Scalar>::fetch(const SlotPair& hit) const {
    for (const std::uint32_t i : {hit.place_a, hit.place_b}) {
        for (const RoomyVector<Scalar>* values : {&x_m_, &y_m_, &vx_mps_, &vy_mps_}) {
            __builtin_prefetch(values->data() + i);
        }
        near_.fetch(i);
    }
    __builtin_prefetch(bodies_->generation.data() + hit.slot_a);
    __builtin_prefetch(bodies_->generation.data() + hit.slot_b);
}

template <typename Scalar>
template <bool kEqualRadii, bool kEqualMasses, bool kPeriodic>
void DiscreteSolver<Scalar>::resolve_pair(const SlotPair& hit, Scalar time_s) {
    const std::uint32_t a = hit.place_a, b = hit.place_b;
    Scalar share_a = Scalar(0.5), share_b = Scalar(0.5);
    if constexpr (!kEqualMasses) {
        const Scalar both = inverse_mass_per_kg_[a] + inverse_mass_per_kg_[b];
        if (!(both > Scalar(0))) return;
        share_a = inverse_mass_per_kg_[a] / both;
        share_b = inverse_mass_per_kg_[b] / both;
    }
    const Line line = line_of_centres<kPeriodic>(a, b);
    const Scalar reach =
        kEqualRadii ? largest_radius_m_ + largest_radius_m_ : radius_m_[a] + radius_m_[b];
    const Scalar overlap = std::max(Scalar(0), reach - line.distance_m);
    const Scalar rate = line.x * (vx_mps_[a] - vx_mps_[b]) + line.y * (vy_mps_[a] - vy_mps_[b]);
    if (rate < Scalar(0)) {
        const Scalar strength = -(Scalar(1) + model_->restitution) * (rate / line.squared);
        record_collision<kEqualMasses>(hit, line, strength, overlap, time_s);
        Contact<Scalar>& contact = record_->contacts.back();
        vx_mps_[a] += strength * share_a * line.x;
        vy_mps_[a] += strength * share_a * line.y;
        vx_mps_[b] -= strength * share_b * line.x;
        vy_mps_[b] -= strength * share_b * line.y;
        contact.velocity_a_after_mps = {vx_mps_[a], vy_mps_[a]};
        contact.velocity_b_after_mps = {vx_mps_[b], vy_mps_[b]};
        account(contact, record_->audit);
        ++events_;
    }
    if (!(overlap > Scalar(0))) return;
    const Scalar way = overlap / line.length;
    x_m_[a] += way * share_a * line.x;
    y_m_[a] += way * share_a * line.y;
    x_m_[b] -= way * share_b * line.x;
    y_m_[b] -= way * share_b * line.y;
    near_.moved(a, overlap * share_a);
    near_.moved(b, overlap * share_b);
    if constexpr (kPeriodic) {
        for (const std::uint32_t i : {a, b}) {
            if (!is_within<Scalar>(inside_, x_m_[i], y_m_[i])) wrap(i);
        }
    }
}

template <typename Scalar>
template <bool kPeriodic>
inline auto DiscreteSolver<Scalar>::line_of_centres(std::uint32_t a, std::uint32_t b) const
    -> Line {
    Vec separation_m(x_m_[a] - x_m_[b], y_m_[a] - y_m_[b]);
    if constexpr (kPeriodic) {
        separation_m = nearest_image<Scalar>(separation_m, model_->periodic);
    }
    return centre_line<Scalar>(separation_m, {vx_mps_[a], vy_mps_[a]}, {vx_mps_[b], vy_mps_[b]});
}

// With the velocities before; `strength` times the line is what the velocities come apart by.
template <typename Scalar>
template <bool kEqualMasses>
void DiscreteSolver<Scalar>::record_collision(const SlotPair& hit, const Line& line,
                                              Scalar strength, Scalar overlap_m, Scalar time_s) {
    const Bodies<Scalar>& all = *bodies_;
    const std::uint32_t a = hit.place_a, b = hit.place_b;
    const Scalar mass_a = kEqualMasses ? all.mass_kg[slot_.front()] : all.mass_kg[hit.slot_a];
    const Scalar mass_b = kEqualMasses ? mass_a : all.mass_kg[hit.slot_b];
    const Scalar reduced_kg = Scalar(1) / (Scalar(1) / mass_a + Scalar(1) / mass_b);
    const Vec normal(line.x / line.length, line.y / line.length);
    const Vec position_a(x_m_[a], y_m_[a]);
    const Scalar radius_a = radius_of(a);
    const Vec still = Vec::Zero();  // the velocities after are known later
    record_->contacts.push_back({.a = all.id_of(hit.slot_a),
                                 .b = all.id_of(hit.slot_b),
                                 .time_s = time_s,
                                 .point_m = position_a - radius_a * normal,
                                 .normal = normal,
                                 .impulse_ns = strength * line.length * reduced_kg,
                                 .position_a_m = position_a,
                                 .position_b_m = position_a - line.distance_m * normal,
                                 .velocity_a_before_mps = {vx_mps_[a], vy_mps_[a]},
                                 .velocity_a_after_mps = still,
                                 .velocity_b_before_mps = {vx_mps_[b], vy_mps_[b]},
                                 .velocity_b_after_mps = still,
                                 .mass_a_kg = mass_a,
                                 .mass_b_kg = mass_b,
                                 .penetration = overlap_m / std::min(radius_a, radius_of(b)),
                                 .contacts_at_once = 1});
}

template <typename Scalar>
template <bool kEqualRadii>
void DiscreteSolver<Scalar>::reflect_from_walls(Scalar time_s) {
    const Box room = room_for(*model_->walls, largest_radius_m_);
    slots_.clear();
    for (const std::uint32_t i : near_.holds() ? near_walls_ : outside(room)) {
        const Scalar radius = kEqualRadii ? largest_radius_m_ : radius_m_[i];
        const Box own = room_for(*model_->walls, radius);
        if (!is_within<Scalar>(own, x_m_[i], y_m_[i])) slots_.push_back(slot_[i]);
    }
    std::sort(slots_.begin(), slots_.end());
    for (const std::uint32_t slot : slots_) {
        const std::uint32_t i = place_[slot];
        reflect(i, room_for(*model_->walls, radius_of(i)), time_s);
    }
}

template <typename Scalar>
void DiscreteSolver<Scalar>::reflect(std::uint32_t i, const Box& room, Scalar time_s) {
    const Scalar mass = bodies_->mass_kg[slot_[i]];
    if (std::isinf(mass)) return;
    WallHitter<Scalar> body{
        bodies_->id_of(slot_[i]), {x_m_[i], y_m_[i]}, {vx_mps_[i], vy_mps_[i]}, radius_of(i), mass};
    events_ += bounce(body, room, model_->restitution, time_s, *record_);
    near_.moved(i,
                std::abs(body.position_m.x() - x_m_[i]) + std::abs(body.position_m.y() - y_m_[i]));
    x_m_[i] = body.position_m.x();
    y_m_[i] = body.position_m.y();
    vx_mps_[i] = body.velocity_mps.x();
    vy_mps_[i] = body.velocity_mps.y();
}

template <typename Scalar>
template <typename Shape>
void DiscreteSolver<Scalar>::drop_who_is_off(const Shape& shape, Scalar time_s) {
    slots_.clear();
    for (std::uint32_t i = 0; i < count(); ++i) {
        if (is_off(shape, x_m_[i], y_m_[i])) slots_.push_back(slot_[i]);
    }
    std::sort(slots_.begin(), slots_.end());
    for (const std::uint32_t slot : slots_) drop(slot, time_s);
}

template <typename Scalar>
void DiscreteSolver<Scalar>::drop(std::uint32_t slot, Scalar time_s) {
    const std::uint32_t i = place_[slot];
    record_->falls.push_back(
        {bodies_->id_of(slot), time_s, {x_m_[i], y_m_[i]}, {vx_mps_[i], vy_mps_[i]}});
    bodies_->remove(slot);
    near_.forget();
    to_slots_.forget();
    ++events_;
    place_[slot_.back()] = i;
    const auto take_from_end = [i](auto& values) {
        if (values.empty()) return;
        values[i] = values.back();
        values.pop_back();
    };
    take_from_end(slot_);
    for (auto* values : {&x_m_, &y_m_, &vx_mps_, &vy_mps_, &radius_m_, &inverse_mass_per_kg_}) {
        take_from_end(*values);
    }
}

}  // namespace

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_discrete_solver(std::uint32_t substeps, SimdLevel level) {
    return std::make_unique<DiscreteSolver<Scalar>>(substeps, level);
}

template std::unique_ptr<Solver<double>> make_discrete_solver(std::uint32_t, SimdLevel);
template std::unique_ptr<Solver<float>> make_discrete_solver(std::uint32_t, SimdLevel);

}  // namespace fts::physics
