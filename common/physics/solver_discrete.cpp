#include "common/physics/solver_discrete.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "common/physics/boundary.h"
#include "common/physics/cell_grid.h"
#include "common/physics/diagnostics.h"
#include "common/physics/periodic.h"

namespace fts::physics {
namespace {

// Searches after which the cells are fitted anew and neighbours brought together in memory.
constexpr std::uint32_t kSearchesPerOrder = 32;

template <typename Scalar>
class DiscreteSolver final : public Solver<Scalar> {
  public:
    explicit DiscreteSolver(std::uint32_t substeps) : substeps_(substeps) {}

    DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                              Record<Scalar>& record) override;
    void forget() override { forgotten_ = true; }
    void synchronise(Bodies<Scalar>& bodies) override;

  private:
    using Vec = Vec2<Scalar>;
    using Box = typename Model<Scalar>::Box;
    using Resolve = void (DiscreteSolver::*)(Scalar);

    // From the second to the first; never of length 0.
    struct Line {
        Scalar x, y;
        Scalar squared;
        Scalar distance_m;  // of the centres; the line's length, unless they coincide
    };

    // What only some scenes need is never inlined, so that a count of instructions shows it apart
    // (scripts/feature-cost).
    void gather(const Bodies<Scalar>& bodies);
    bool holds_just(const Bodies<Scalar>& bodies) const;
    void take_in_order_of_ids(const Bodies<Scalar>& bodies);
    void advance(Scalar span_s);
    [[gnu::noinline]] void advance_in_box(Scalar span_s);
    void find_pairs();
    void bring_neighbours_together();
    Resolve resolve_for_model() const;
    template <bool kEqualRadii, bool kEqualMasses, bool kPeriodic>
    void resolve(Scalar time_s);
    template <bool kEqualRadii, bool kEqualMasses, bool kPeriodic>
    void resolve_pair(std::uint32_t a, std::uint32_t b, Scalar time_s);
    template <bool kPeriodic>
    Line line_of_centres(std::uint32_t a, std::uint32_t b) const;
    void record_collision(std::uint32_t a, std::uint32_t b, const Line& line, Scalar strength,
                          Scalar overlap_m, Scalar time_s);
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
    bool forgotten_ = true;
    bool ahead_ = false;  // of the bodies
    std::uint32_t searches_until_order_ = 0;

    Bodies<Scalar>* bodies_ = nullptr;
    const Model<Scalar>* model_ = nullptr;
    Record<Scalar>* record_ = nullptr;
    std::uint32_t events_ = 0;

    // By place in the working copy, in which neighbours are near each other.
    std::vector<Scalar> x_m_, y_m_, vx_mps_, vy_mps_;
    std::vector<Scalar> radius_m_;             // empty when all are the largest
    std::vector<Scalar> inverse_mass_per_kg_;  // empty when all are alike
    std::vector<std::uint32_t> slot_;
    Scalar largest_radius_m_ = Scalar(0);
    std::vector<std::uint32_t> place_;  // by slot

    CellGrid<Scalar> grid_;
    std::vector<DiscPair> pairs_;      // of places
    std::vector<std::uint64_t> keys_;  // of slots: the lower one, then the other
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> old_slot_;
    std::vector<Scalar> old_;
    std::vector<std::uint32_t> fallen_;  // slots
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
        model.periodic ? advance_in_box(step_s) : advance(step_s);
        find_pairs();
        (this->*resolve_pairs)(time_s);
        if (model.walls) {
            model.equal_radii ? reflect_from_walls<true>(time_s)
                              : reflect_from_walls<false>(time_s);
        }
        if (model.platform) {
            std::visit([&](const auto& shape) { drop_who_is_off(shape, time_s); }, *model.platform);
        }
    }
    ahead_ = true;
    return {events_, false, Scalar(0)};
}

template <typename Scalar>
void DiscreteSolver<Scalar>::gather(const Bodies<Scalar>& bodies) {
    const bool same_bodies = holds_just(bodies);
    if (!same_bodies) take_in_order_of_ids(bodies);
    const std::uint32_t bodies_count = count();
    for (std::vector<Scalar>* values : {&x_m_, &y_m_, &vx_mps_, &vy_mps_}) {
        values->resize(bodies_count);
    }
    for (std::uint32_t i = 0; i < bodies_count; ++i) {
        const Vec &position = bodies.position_m[slot_[i]],
                  &velocity = bodies.velocity_mps[slot_[i]];
        x_m_[i] = position.x();
        y_m_[i] = position.y();
        vx_mps_[i] = velocity.x();
        vy_mps_[i] = velocity.y();
    }
    radius_m_.clear();
    inverse_mass_per_kg_.clear();
    const Scalar largest_before = largest_radius_m_;
    largest_radius_m_ = slot_.empty() ? Scalar(0) : bodies.radius_m[slot_.front()];
    if (!model_->equal_radii) {
        for (const std::uint32_t slot : slot_) radius_m_.push_back(bodies.radius_m[slot]);
        for (const Scalar radius : radius_m_) {
            largest_radius_m_ = std::max(largest_radius_m_, radius);
        }
    }
    if (!model_->equal_masses) {
        for (const std::uint32_t slot : slot_) {
            inverse_mass_per_kg_.push_back(Scalar(1) / bodies.mass_kg[slot]);
        }
    }
    if (!same_bodies || largest_radius_m_ != largest_before) {
        grid_.fit(discs(), model_->periodic);
        searches_until_order_ = 1;
    }
    forgotten_ = false;
    ahead_ = false;
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
    place_.resize(bodies.slots());
    for (const BodyId id : bodies.ids) {
        place_[id.index] = count();
        slot_.push_back(id.index);
    }
}

template <typename Scalar>
void DiscreteSolver<Scalar>::synchronise(Bodies<Scalar>& bodies) {
    if (!ahead_) return;
    for (std::uint32_t i = 0; i < count(); ++i) {
        bodies.position_m[slot_[i]] = {x_m_[i], y_m_[i]};
        bodies.velocity_mps[slot_[i]] = {vx_mps_[i], vy_mps_[i]};
    }
    ahead_ = false;
}

template <typename Scalar>
void DiscreteSolver<Scalar>::advance(Scalar span_s) {
    for (std::uint32_t i = 0; i < count(); ++i) {
        x_m_[i] += vx_mps_[i] * span_s;
        y_m_[i] += vy_mps_[i] * span_s;
    }
}

template <typename Scalar>
void DiscreteSolver<Scalar>::advance_in_box(Scalar span_s) {
    const Box box = *model_->periodic;
    for (std::uint32_t i = 0; i < count(); ++i) {
        x_m_[i] += vx_mps_[i] * span_s;
        y_m_[i] += vy_mps_[i] * span_s;
        const bool inside = x_m_[i] >= box.min_m.x() && x_m_[i] < box.max_m.x() &&
                            y_m_[i] >= box.min_m.y() && y_m_[i] < box.max_m.y();
        if (!inside) wrap(i);
    }
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
    grid_.find_overlaps(discs(), pairs_);
    keys_.clear();
    for (const DiscPair& pair : pairs_) {
        const auto [low, high] = std::minmax(slot_[pair.a], slot_[pair.b]);
        keys_.push_back(std::uint64_t{low} << 32 | high);
    }
    std::sort(keys_.begin(), keys_.end());
    if (--searches_until_order_ == 0) {
        bring_neighbours_together();
        grid_.fit(discs(), model_->periodic);
        searches_until_order_ = kSearchesPerOrder;
    }
}

template <typename Scalar>
void DiscreteSolver<Scalar>::bring_neighbours_together() {
    grid_.read_order(order_);
    for (std::vector<Scalar>* values :
         {&x_m_, &y_m_, &vx_mps_, &vy_mps_, &radius_m_, &inverse_mass_per_kg_}) {
        if (values->empty()) continue;
        old_.swap(*values);
        values->clear();
        for (const std::uint32_t from : order_) values->push_back(old_[from]);
    }
    old_slot_.swap(slot_);
    slot_.clear();
    for (const std::uint32_t from : order_) {
        place_[old_slot_[from]] = count();
        slot_.push_back(old_slot_[from]);
    }
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
    for (const std::uint64_t key : keys_) {
        const std::uint32_t a = place_[key >> 32], b = place_[key & 0xffffffffU];
        resolve_pair<kEqualRadii, kEqualMasses, kPeriodic>(a, b, time_s);
    }
}

template <typename Scalar>
template <bool kEqualRadii, bool kEqualMasses, bool kPeriodic>
void DiscreteSolver<Scalar>::resolve_pair(std::uint32_t a, std::uint32_t b, Scalar time_s) {
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
        record_collision(a, b, line, strength, overlap, time_s);
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
    const Scalar way = overlap / std::sqrt(line.squared);
    x_m_[a] += way * share_a * line.x;
    y_m_[a] += way * share_a * line.y;
    x_m_[b] -= way * share_b * line.x;
    y_m_[b] -= way * share_b * line.y;
    if constexpr (kPeriodic) {
        wrap(a);
        wrap(b);
    }
}

// Below the least distance whose square keeps all its digits, centres coincide.
template <typename Scalar>
template <bool kPeriodic>
auto DiscreteSolver<Scalar>::line_of_centres(std::uint32_t a, std::uint32_t b) const -> Line {
    constexpr Scalar kCoincident =
        std::numeric_limits<Scalar>::min() / std::numeric_limits<Scalar>::epsilon();
    Scalar x = x_m_[a] - x_m_[b], y = y_m_[a] - y_m_[b];
    if constexpr (kPeriodic) {
        const Vec nearest = nearest_image<Scalar>({x, y}, model_->periodic);
        x = nearest.x();
        y = nearest.y();
    }
    const Scalar squared = x * x + y * y;
    if (squared > kCoincident) return {x, y, squared, std::sqrt(squared)};
    x = vx_mps_[b] - vx_mps_[a];
    y = vy_mps_[b] - vy_mps_[a];
    const Scalar larger = std::max(std::abs(x), std::abs(y));
    if (!(larger > Scalar(0))) return {Scalar(1), Scalar(0), Scalar(1), Scalar(0)};
    x /= larger;
    y /= larger;
    return {x, y, x * x + y * y, Scalar(0)};
}

// With the velocities before; `strength` times the line is what the velocities come apart by.
template <typename Scalar>
void DiscreteSolver<Scalar>::record_collision(std::uint32_t a, std::uint32_t b, const Line& line,
                                              Scalar strength, Scalar overlap_m, Scalar time_s) {
    const Bodies<Scalar>& all = *bodies_;
    const Scalar mass_a = all.mass_kg[slot_[a]], mass_b = all.mass_kg[slot_[b]];
    const Scalar reduced_kg = Scalar(1) / (Scalar(1) / mass_a + Scalar(1) / mass_b);
    const Scalar length = std::sqrt(line.squared);
    const Vec normal(line.x / length, line.y / length);
    const Vec position_a(x_m_[a], y_m_[a]);
    const Scalar radius_a = radius_of(a);
    Contact<Scalar>& contact = record_->contacts.emplace_back();
    contact.a = all.id_of(slot_[a]);
    contact.b = all.id_of(slot_[b]);
    contact.time_s = time_s;
    contact.point_m = position_a - radius_a * normal;
    contact.normal = normal;
    contact.impulse_ns = strength * length * reduced_kg;
    contact.position_a_m = position_a;
    contact.position_b_m = position_a - line.distance_m * normal;
    contact.velocity_a_before_mps = {vx_mps_[a], vy_mps_[a]};
    contact.velocity_b_before_mps = {vx_mps_[b], vy_mps_[b]};
    contact.mass_a_kg = mass_a;
    contact.mass_b_kg = mass_b;
    contact.penetration = overlap_m / std::min(radius_a, radius_of(b));
}

template <typename Scalar>
template <bool kEqualRadii>
void DiscreteSolver<Scalar>::reflect_from_walls(Scalar time_s) {
    Box room = room_for(*model_->walls, largest_radius_m_);
    keys_.clear();
    for (std::uint32_t i = 0; i < count(); ++i) {
        if constexpr (!kEqualRadii) room = room_for(*model_->walls, radius_m_[i]);
        if (!is_within<Scalar>(room, x_m_[i], y_m_[i])) keys_.push_back(slot_[i]);
    }
    std::sort(keys_.begin(), keys_.end());
    for (const std::uint64_t slot : keys_) {
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
    x_m_[i] = body.position_m.x();
    y_m_[i] = body.position_m.y();
    vx_mps_[i] = body.velocity_mps.x();
    vy_mps_[i] = body.velocity_mps.y();
}

template <typename Scalar>
template <typename Shape>
void DiscreteSolver<Scalar>::drop_who_is_off(const Shape& shape, Scalar time_s) {
    fallen_.clear();
    for (std::uint32_t i = 0; i < count(); ++i) {
        if (is_off(shape, x_m_[i], y_m_[i])) fallen_.push_back(slot_[i]);
    }
    std::sort(fallen_.begin(), fallen_.end());
    for (const std::uint32_t slot : fallen_) drop(slot, time_s);
}

template <typename Scalar>
void DiscreteSolver<Scalar>::drop(std::uint32_t slot, Scalar time_s) {
    const std::uint32_t i = place_[slot];
    record_->falls.push_back(
        {bodies_->id_of(slot), time_s, {x_m_[i], y_m_[i]}, {vx_mps_[i], vy_mps_[i]}});
    bodies_->remove(slot);
    ++events_;
    place_[slot_.back()] = i;
    const auto take_from_end = [i](auto& values) {
        if (values.empty()) return;
        values[i] = values.back();
        values.pop_back();
    };
    take_from_end(slot_);
    for (std::vector<Scalar>* values :
         {&x_m_, &y_m_, &vx_mps_, &vy_mps_, &radius_m_, &inverse_mass_per_kg_}) {
        take_from_end(*values);
    }
}

}  // namespace

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_discrete_solver(std::uint32_t substeps) {
    return std::make_unique<DiscreteSolver<Scalar>>(substeps);
}

template std::unique_ptr<Solver<double>> make_discrete_solver(std::uint32_t);
template std::unique_ptr<Solver<float>> make_discrete_solver(std::uint32_t);

}  // namespace fts::physics
