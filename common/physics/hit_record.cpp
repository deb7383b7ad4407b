#include "common/physics/hit_record.h"

#include <limits>

#include "common/physics/diagnostics.h"

namespace fts::physics {
namespace {

template <typename Scalar>
Contact<Scalar> contact_of(const Bodies<Scalar>& bodies, Scalar time_s, const Hit<Scalar>& hit,
                           std::uint32_t at_once) {
    const Vec2<Scalar>& position = bodies.position_m[hit.a];
    const Scalar radius = bodies.radius_m[hit.a];
    Contact<Scalar> contact{bodies.id_of(hit.a),
                            std::nullopt,
                            time_s,
                            position - radius * hit.normal,
                            hit.normal,
                            hit.impulse_ns,
                            position,
                            position - radius * hit.normal,
                            hit.velocity_a_before_mps,
                            hit.velocity_a_after_mps,
                            hit.velocity_b_before_mps,
                            hit.velocity_b_after_mps,
                            bodies.mass_kg[hit.a],
                            std::numeric_limits<Scalar>::infinity()};
    contact.contacts_at_once = at_once;
    if (hit.b == kNoBody) return contact;
    contact.b = bodies.id_of(hit.b);
    contact.position_b_m = position - hit.separation_m;
    contact.mass_b_kg = bodies.mass_kg[hit.b];
    contact.penetration =
        penetration<Scalar>(hit.separation_m.norm(), radius, bodies.radius_m[hit.b]);
    return contact;
}

}  // namespace

template <typename Scalar>
void record_hits(const Bodies<Scalar>& bodies, Scalar time_s, std::span<const Hit<Scalar>> together,
                 Record<Scalar>& record) {
    const std::size_t before = record.contacts.size();
    for (const Hit<Scalar>& hit : together) {
        record.contacts.push_back(
            contact_of(bodies, time_s, hit, static_cast<std::uint32_t>(together.size())));
    }
    account_together(std::span<const Contact<Scalar>>(record.contacts).subspan(before),
                     record.audit);
}

template void record_hits(const Bodies<double>&, double, std::span<const Hit<double>>,
                          Record<double>&);
template void record_hits(const Bodies<float>&, float, std::span<const Hit<float>>, Record<float>&);

}  // namespace fts::physics
