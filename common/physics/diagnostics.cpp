#include "common/physics/diagnostics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

namespace fts::physics {
namespace {

double energy_j(double mass_kg, const Vec2d& velocity_mps) {
    return 0.5 * mass_kg * velocity_mps.squaredNorm();
}

struct Change {
    double before = 0.0;
    double after = 0.0;
};

// Of a pair of finite masses, or of the finite one as seen from the infinite one.
template <typename Scalar>
Change energy_change(const Contact<Scalar>& c) {
    const Vec2d before_a = c.velocity_a_before_mps.template cast<double>();
    const Vec2d before_b = c.velocity_b_before_mps.template cast<double>();
    const Vec2d after_a = c.velocity_a_after_mps.template cast<double>();
    const Vec2d after_b = c.velocity_b_after_mps.template cast<double>();
    const double mass_a = static_cast<double>(c.mass_a_kg);
    const double mass_b = static_cast<double>(c.mass_b_kg);
    if (std::isinf(mass_a)) {
        return {energy_j(mass_b, before_b - before_a), energy_j(mass_b, after_b - after_a)};
    }
    if (std::isinf(mass_b)) {
        return {energy_j(mass_a, before_a - before_b), energy_j(mass_a, after_a - after_b)};
    }
    return {energy_j(mass_a, before_a) + energy_j(mass_b, before_b),
            energy_j(mass_a, after_a) + energy_j(mass_b, after_b)};
}

template <typename Scalar>
double momentum_error(const Contact<Scalar>& c) {
    const double mass_a = static_cast<double>(c.mass_a_kg);
    const double mass_b = static_cast<double>(c.mass_b_kg);
    if (std::isinf(mass_a) || std::isinf(mass_b)) return 0.0;
    const Vec2d before_a = mass_a * c.velocity_a_before_mps.template cast<double>();
    const Vec2d before_b = mass_b * c.velocity_b_before_mps.template cast<double>();
    const Vec2d after_a = mass_a * c.velocity_a_after_mps.template cast<double>();
    const Vec2d after_b = mass_b * c.velocity_b_after_mps.template cast<double>();
    const double scale = before_a.norm() + before_b.norm();
    return scale > 0.0 ? ((after_a + after_b) - (before_a + before_b)).norm() / scale : 0.0;
}

class Fnv1a {
  public:
    template <typename Value>
    void add(Value value) {
        using Bits = std::conditional_t<sizeof(Value) == 8, std::uint64_t, std::uint32_t>;
        Bits bits = std::bit_cast<Bits>(value);
        for (std::size_t byte = 0; byte < sizeof(Bits); ++byte, bits = bits >> 8) {
            hash_ = (hash_ ^ (bits & 0xffU)) * 0x100000001b3ULL;
        }
    }
    std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

}  // namespace

template <typename Scalar>
void account(const Contact<Scalar>& contact, CollisionAudit& audit) {
    const Change energy = energy_change(contact);
    audit.energy_change_j += energy.after - energy.before;
    audit.energy_seen_j += energy.before;
    audit.worst_penetration =
        std::max(audit.worst_penetration, static_cast<double>(contact.penetration));
    if (!contact.b) {
        ++audit.wall_collisions;
        return;
    }
    ++audit.ball_collisions;
    if (energy.before > 0.0) {
        audit.worst_energy_error = std::max(audit.worst_energy_error,
                                            std::abs(energy.after - energy.before) / energy.before);
    }
    audit.worst_momentum_error = std::max(audit.worst_momentum_error, momentum_error(contact));
}

template <typename Scalar>
double kinetic_energy_j(const Bodies<Scalar>& bodies) {
    double sum = 0.0;
    for (const BodyId id : bodies.ids) {
        const double mass = static_cast<double>(bodies.mass_kg[id.index]);
        if (std::isinf(mass)) continue;
        sum += energy_j(mass, bodies.velocity_mps[id.index].template cast<double>());
    }
    return sum;
}

template <typename Scalar>
Vec2d momentum_ns(const Bodies<Scalar>& bodies) {
    Vec2d sum = Vec2d::Zero();
    for (const BodyId id : bodies.ids) {
        const double mass = static_cast<double>(bodies.mass_kg[id.index]);
        if (std::isinf(mass)) continue;
        sum += mass * bodies.velocity_mps[id.index].template cast<double>();
    }
    return sum;
}

template <typename Scalar>
std::uint64_t state_hash(const Bodies<Scalar>& bodies) {
    Fnv1a hash;
    for (const BodyId id : bodies.ids) {
        hash.add(id.index);
        for (int axis = 0; axis < 2; ++axis) hash.add(bodies.position_m[id.index][axis]);
        for (int axis = 0; axis < 2; ++axis) hash.add(bodies.velocity_mps[id.index][axis]);
        hash.add(bodies.radius_m[id.index]);
        hash.add(bodies.mass_kg[id.index]);
    }
    return hash.value();
}

template void account(const Contact<double>&, CollisionAudit&);
template void account(const Contact<float>&, CollisionAudit&);
template double kinetic_energy_j(const Bodies<double>&);
template double kinetic_energy_j(const Bodies<float>&);
template Vec2d momentum_ns(const Bodies<double>&);
template Vec2d momentum_ns(const Bodies<float>&);
template std::uint64_t state_hash(const Bodies<double>&);
template std::uint64_t state_hash(const Bodies<float>&);

}  // namespace fts::physics
