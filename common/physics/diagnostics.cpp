#include "common/physics/diagnostics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <type_traits>
#include <vector>

#include "common/physics/cell_grid.h"
#include "common/physics/periodic.h"

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
[[gnu::always_inline]] inline Change energy_change(const Contact<Scalar>& c) {
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

// Where a value is less than this of the worst so far, round-off and all, it is not looked at
// closely.
constexpr double kSurelyLess = 1.0 - 1e-12;

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

// False only if momentum_error is not above `worst`, which is found without roots: the sum of two
// lengths is not less than the root of the sum of their squares.
template <typename Scalar>
[[gnu::always_inline]] inline bool may_be_worse(const Contact<Scalar>& c, double worst) {
    const double mass_a = static_cast<double>(c.mass_a_kg);
    const double mass_b = static_cast<double>(c.mass_b_kg);
    const Vec2d before_a = mass_a * c.velocity_a_before_mps.template cast<double>();
    const Vec2d before_b = mass_b * c.velocity_b_before_mps.template cast<double>();
    const Vec2d after_a = mass_a * c.velocity_a_after_mps.template cast<double>();
    const Vec2d after_b = mass_b * c.velocity_b_after_mps.template cast<double>();
    const double change = ((after_a + after_b) - (before_a + before_b)).squaredNorm();
    const double scale = before_a.squaredNorm() + before_b.squaredNorm();
    return !(change < kSurelyLess * worst * worst * scale);
}

// What contacts of one instant did to all their bodies together.
struct Together {
    Change energy;
    Vec2d momentum_change = Vec2d::Zero();
    double momentum_scale = 0.0;
};

// One of the two bodies of a contact.
struct Side {
    BodyId id;
    double mass_kg;
    Vec2d before, after;
};

template <typename Scalar>
Side side_a(const Contact<Scalar>& c) {
    return {c.a, static_cast<double>(c.mass_a_kg), c.velocity_a_before_mps.template cast<double>(),
            c.velocity_a_after_mps.template cast<double>()};
}

template <typename Scalar>
Side side_b(const Contact<Scalar>& c) {
    return {*c.b, static_cast<double>(c.mass_b_kg), c.velocity_b_before_mps.template cast<double>(),
            c.velocity_b_after_mps.template cast<double>()};
}

// visit(side) once for each body.
template <typename Scalar, typename Visit>
void for_each_body(std::span<const Contact<Scalar>> contacts, Visit&& visit) {
    const auto seen = [&](BodyId id, std::size_t end) {
        return std::any_of(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(end),
                           [&](const auto& c) { return c.a == id || c.b == id; });
    };
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        if (!seen(contacts[i].a, i)) visit(side_a(contacts[i]));
        if (contacts[i].b && !seen(*contacts[i].b, i)) visit(side_b(contacts[i]));
    }
}

// What does not move in any of the contacts; its velocity.
struct Frame {
    bool needed = false;
    bool is_one = true;
    Vec2d velocity_mps = Vec2d::Zero();

    void hold(const Vec2d& velocity) {
        is_one = is_one && (!needed || velocity == velocity_mps);
        needed = true;
        velocity_mps = velocity;
    }
};

template <typename Scalar>
Frame frame_of(std::span<const Contact<Scalar>> contacts) {
    Frame frame;
    for (const Contact<Scalar>& c : contacts) {
        if (!c.b) frame.hold(Vec2d::Zero());
    }
    for_each_body(contacts, [&](const Side& side) {
        if (std::isinf(side.mass_kg)) frame.hold(side.before);
    });
    return frame;
}

template <typename Scalar>
Together together_of(std::span<const Contact<Scalar>> contacts, const Vec2d& frame_mps) {
    Together sum;
    for_each_body(contacts, [&](const Side& side) {
        if (std::isinf(side.mass_kg)) return;
        sum.energy.before += energy_j(side.mass_kg, side.before - frame_mps);
        sum.energy.after += energy_j(side.mass_kg, side.after - frame_mps);
        sum.momentum_change += side.mass_kg * (side.after - side.before);
        sum.momentum_scale += (side.mass_kg * side.before).norm();
    });
    return sum;
}

std::optional<Model<double>::Box> in_double(const auto& box) {
    if (!box) return std::nullopt;
    return Model<double>::Box{box->min_m.template cast<double>(),
                              box->max_m.template cast<double>()};
}

// How far a disc reaches out of a box; negative inside.
double beyond_m(const Model<double>::Box& box, const Vec2d& position_m, double radius_m) {
    const Vec2d below = box.min_m - position_m, above = position_m - box.max_m;
    return std::max(below.maxCoeff(), above.maxCoeff()) + radius_m;
}

struct Crowd {
    std::vector<double> x_m, y_m, radius_m;
    std::vector<std::uint8_t> is_immovable;
    double largest_radius_m = 0.0;

    Vec2d position_m(std::uint32_t i) const { return {x_m[i], y_m[i]}; }
};

template <typename Scalar>
Crowd crowd_of(const Bodies<Scalar>& bodies) {
    Crowd crowd;
    for (const BodyId id : bodies.ids) {
        crowd.x_m.push_back(static_cast<double>(bodies.position_m[id.index].x()));
        crowd.y_m.push_back(static_cast<double>(bodies.position_m[id.index].y()));
        crowd.radius_m.push_back(static_cast<double>(bodies.radius_m[id.index]));
        crowd.is_immovable.push_back(std::isinf(bodies.mass_kg[id.index]));
        crowd.largest_radius_m = std::max(crowd.largest_radius_m, crowd.radius_m.back());
    }
    return crowd;
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
    const double change = std::abs(energy.after - energy.before);
    if (energy.before > 0.0 && change > kSurelyLess * audit.worst_energy_error * energy.before) {
        audit.worst_energy_error = std::max(audit.worst_energy_error, change / energy.before);
    }
    if (may_be_worse(contact, audit.worst_momentum_error)) {
        audit.worst_momentum_error = std::max(audit.worst_momentum_error, momentum_error(contact));
    }
}

template <typename Scalar>
void account_together(std::span<const Contact<Scalar>> contacts, CollisionAudit& audit) {
    if (contacts.size() == 1) return account(contacts.front(), audit);
    for (const Contact<Scalar>& contact : contacts) {
        ++(contact.b ? audit.ball_collisions : audit.wall_collisions);
        audit.worst_penetration =
            std::max(audit.worst_penetration, static_cast<double>(contact.penetration));
    }
    const Frame frame = frame_of(contacts);
    if (!frame.is_one) return;
    const Together sum = together_of(contacts, frame.velocity_mps);
    const double change = sum.energy.after - sum.energy.before;
    audit.energy_change_j += change;
    audit.energy_seen_j += sum.energy.before;
    if (sum.energy.before > 0.0) {
        audit.worst_energy_error =
            std::max(audit.worst_energy_error, std::abs(change) / sum.energy.before);
    }
    if (frame.needed || !(sum.momentum_scale > 0.0)) return;
    audit.worst_momentum_error =
        std::max(audit.worst_momentum_error, sum.momentum_change.norm() / sum.momentum_scale);
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
double deepest_overlap(const Bodies<Scalar>& bodies, const Model<Scalar>& model) {
    const Crowd crowd = crowd_of(bodies);
    const auto periodic = in_double(model.periodic), walls = in_double(model.walls);
    const Discs<double> discs{crowd.x_m, crowd.y_m, crowd.radius_m, crowd.largest_radius_m};
    CellGrid<double> grid;
    NearPairs near;
    grid.fit(discs, periodic);
    grid.find_near(discs, 0.0, near);
    double deepest = 0.0;
    for (std::size_t k = 0; k < near.count; ++k) {
        const std::uint32_t a = near.a[k], b = near.b[k];
        if (crowd.is_immovable[a] && crowd.is_immovable[b]) continue;
        const double radius_a = crowd.radius_m[a], radius_b = crowd.radius_m[b];
        const Vec2d line =
            nearest_image<double>(crowd.position_m(a) - crowd.position_m(b), periodic);
        const double overlap_m = radius_a + radius_b - line.norm();
        deepest = std::max(deepest, overlap_m / std::min(radius_a, radius_b));
    }
    for (std::uint32_t i = 0; walls && i < discs.count(); ++i) {
        if (crowd.is_immovable[i]) continue;
        const double radius = crowd.radius_m[i];
        deepest = std::max(deepest, beyond_m(*walls, crowd.position_m(i), radius) / radius);
    }
    return deepest;
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
template void account_together(std::span<const Contact<double>>, CollisionAudit&);
template void account_together(std::span<const Contact<float>>, CollisionAudit&);
template double kinetic_energy_j(const Bodies<double>&);
template double kinetic_energy_j(const Bodies<float>&);
template Vec2d momentum_ns(const Bodies<double>&);
template Vec2d momentum_ns(const Bodies<float>&);
template double deepest_overlap(const Bodies<double>&, const Model<double>&);
template double deepest_overlap(const Bodies<float>&, const Model<float>&);
template std::uint64_t state_hash(const Bodies<double>&);
template std::uint64_t state_hash(const Bodies<float>&);

}  // namespace fts::physics
