#include "common/physics/solver_seed.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/physics/boundary.h"
#include "common/physics/diagnostics.h"
#include "common/physics/periodic.h"
#include "common/physics/seed_equations.h"

namespace fts::physics {
namespace {

template <typename Scalar>
class SeedSolver final : public Solver<Scalar> {
  public:
    explicit SeedSolver(std::uint32_t substeps) : substeps_(substeps) {}

    DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                              Record<Scalar>& record) override;

  private:
    using Vec = Vec2<Scalar>;
    using Ball = seed::Ball<Scalar>;

    void move(Scalar span_s);
    void test_every_pair();
    void meet(std::uint32_t a, std::uint32_t b);
    void give_masses(std::uint32_t a, std::uint32_t b, Ball& first, Ball& second) const;
    void respond(std::uint32_t a, std::uint32_t b, const Ball& first, const Ball& second,
                 Scalar penetration);
    void reflect_from_walls();
    void drop_who_is_off();
    Vec inside(const Vec& position_m) const;

    std::uint32_t substeps_;
    Bodies<Scalar>* bodies_ = nullptr;
    const Model<Scalar>* model_ = nullptr;
    Record<Scalar>* record_ = nullptr;
    Scalar now_s_ = Scalar(0);
    std::uint32_t events_ = 0;
    std::vector<std::uint32_t> fallen_;
};

template <typename Scalar>
DriftReport<Scalar> SeedSolver<Scalar>::drift(Bodies<Scalar>& bodies, const Model<Scalar>& model,
                                              Scalar span_s, Record<Scalar>& record) {
    bodies_ = &bodies;
    model_ = &model;
    record_ = &record;
    events_ = 0;
    const Scalar step_s = span_s / static_cast<Scalar>(substeps_);
    for (std::uint32_t k = 1; k <= substeps_; ++k) {
        now_s_ = k == substeps_ ? span_s : step_s * static_cast<Scalar>(k);
        move(step_s);
        test_every_pair();
        if (model.walls) reflect_from_walls();
        if (model.platform) drop_who_is_off();
    }
    return {events_, false, Scalar(0)};
}

template <typename Scalar>
Vec2<Scalar> SeedSolver<Scalar>::inside(const Vec& position_m) const {
    return model_->periodic ? wrapped<Scalar>(position_m, *model_->periodic) : position_m;
}

template <typename Scalar>
void SeedSolver<Scalar>::move(Scalar span_s) {
    Bodies<Scalar>& all = *bodies_;
    for (const BodyId id : all.ids) {
        all.position_m[id.index] =
            inside(all.position_m[id.index] + all.velocity_mps[id.index] * span_s);
    }
}

template <typename Scalar>
void SeedSolver<Scalar>::test_every_pair() {
    const std::vector<BodyId>& ids = bodies_->ids;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        for (std::size_t j = i + 1; j < ids.size(); ++j) meet(ids[i].index, ids[j].index);
    }
}

template <typename Scalar>
void SeedSolver<Scalar>::meet(std::uint32_t a, std::uint32_t b) {
    Bodies<Scalar>& all = *bodies_;
    Ball first{all.position_m[a], all.velocity_mps[a], all.radius_m[a], all.mass_kg[a]};
    Ball second{all.position_m[b], all.velocity_mps[b], all.radius_m[b], all.mass_kg[b]};
    second.centre_m =
        first.centre_m - nearest_image<Scalar>(first.centre_m - second.centre_m, model_->periodic);
    if (!in_contact(first, second)) return;
    if (std::isinf(first.mass_kg) && std::isinf(second.mass_kg)) return;
    give_masses(a, b, first, second);

    const Scalar distance = (first.centre_m - second.centre_m).norm();
    const Scalar overlap = std::max(Scalar(0), first.radius_m + second.radius_m - distance);
    const Scalar penetration = overlap / std::min(first.radius_m, second.radius_m);
    const auto [centre_a, centre_b] = pushed_apart(first, second);
    first.centre_m = centre_a;
    second.centre_m = centre_b;
    all.position_m[a] = inside(centre_a);
    all.position_m[b] = inside(centre_b);
    if (approach(first, second)) respond(a, b, first, second, penetration);
}

template <typename Scalar>
void SeedSolver<Scalar>::give_masses(std::uint32_t a, std::uint32_t b, Ball& first,
                                     Ball& second) const {
    const bool a_is_infinite = std::isinf(bodies_->mass_kg[a]);
    if (!a_is_infinite && !std::isinf(bodies_->mass_kg[b])) return;
    first.mass_kg = a_is_infinite ? Scalar(1) : Scalar(0);
    second.mass_kg = Scalar(1) - first.mass_kg;
}

template <typename Scalar>
void SeedSolver<Scalar>::respond(std::uint32_t a, std::uint32_t b, const Ball& first,
                                 const Ball& second, Scalar penetration) {
    Bodies<Scalar>& all = *bodies_;
    auto [after_a, after_b] = after_collision(first, second, model_->restitution);
    // An infinite mass keeps its velocity to the last bit, not through its angle.
    if (std::isinf(all.mass_kg[a])) after_a = first.velocity_mps;
    if (std::isinf(all.mass_kg[b])) after_b = second.velocity_mps;
    const Vec normal = (first.centre_m - second.centre_m).normalized();
    const bool by_b = std::isinf(all.mass_kg[a]);
    const Scalar impulse = by_b ? all.mass_kg[b] * (second.velocity_mps - after_b).dot(normal)
                                : all.mass_kg[a] * (after_a - first.velocity_mps).dot(normal);
    if (!(impulse > Scalar(0))) return;
    all.velocity_mps[a] = after_a;
    all.velocity_mps[b] = after_b;
    Contact<Scalar> contact{all.id_of(a),
                            all.id_of(b),
                            now_s_,
                            first.centre_m - first.radius_m * normal,
                            normal,
                            impulse,
                            first.centre_m,
                            second.centre_m,
                            first.velocity_mps,
                            after_a,
                            second.velocity_mps,
                            after_b,
                            all.mass_kg[a],
                            all.mass_kg[b]};
    contact.penetration = penetration;
    record_->contacts.push_back(contact);
    account(contact, record_->audit);
    ++events_;
}

template <typename Scalar>
void SeedSolver<Scalar>::reflect_from_walls() {
    Bodies<Scalar>& all = *bodies_;
    for (const BodyId id : all.ids) {
        if (std::isinf(all.mass_kg[id.index])) continue;
        WallHitter<Scalar> body{id, all.position_m[id.index], all.velocity_mps[id.index],
                                all.radius_m[id.index], all.mass_kg[id.index]};
        const auto room = room_for(*model_->walls, body.radius_m);
        if (is_within<Scalar>(room, body.position_m.x(), body.position_m.y())) continue;
        events_ += bounce(body, room, model_->restitution, now_s_, *record_);
        all.position_m[id.index] = body.position_m;
        all.velocity_mps[id.index] = body.velocity_mps;
    }
}

template <typename Scalar>
void SeedSolver<Scalar>::drop_who_is_off() {
    Bodies<Scalar>& all = *bodies_;
    fallen_.clear();
    std::visit(
        [&](const auto& shape) {
            for (const BodyId id : all.ids) {
                const Vec& position = all.position_m[id.index];
                if (is_off(shape, position.x(), position.y())) fallen_.push_back(id.index);
            }
        },
        *model_->platform);
    for (const std::uint32_t slot : fallen_) {
        record_->falls.push_back(
            {all.id_of(slot), now_s_, all.position_m[slot], all.velocity_mps[slot]});
        all.remove(slot);
        ++events_;
    }
}

}  // namespace

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_seed_solver(std::uint32_t substeps) {
    return std::make_unique<SeedSolver<Scalar>>(substeps);
}

template std::unique_ptr<Solver<double>> make_seed_solver(std::uint32_t);
template std::unique_ptr<Solver<float>> make_seed_solver(std::uint32_t);

}  // namespace fts::physics
