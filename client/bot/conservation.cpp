#include "client/bot/conservation.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace fts::bot {
namespace {

using physics::Vec2d;
using Side = replication::CollisionReport::Side;

bool sound(const Side& side) {
    return std::isfinite(side.mass_kg) && side.mass_kg > 0.0 &&
           side.velocity_before_mps.allFinite() && side.velocity_after_mps.allFinite();
}

double ratio(double change, double whole) {
    if (whole > 0.0) return change / whole;
    return change == 0.0 ? 0.0 : std::numeric_limits<double>::max();
}

void write_side(std::ostream& out, const Side& side) {
    out << ',' << side.ball << ',' << side.player_id << ',' << side.mass_kg << ',' << side.radius_m;
    for (const Vec2d& v : {side.position_m, side.velocity_before_mps, side.velocity_after_mps}) {
        out << ',' << v.x() << ',' << v.y();
    }
}

}  // namespace

std::optional<ConservationError> conservation_error(const replication::CollisionReport& hit) {
    const Side& a = hit.own;
    const Side& b = hit.other;
    if (!sound(a) || !sound(b) || hit.contacts_at_once > 1) return std::nullopt;
    const Vec2d pa = a.mass_kg * a.velocity_before_mps, pb = b.mass_kg * b.velocity_before_mps;
    const Vec2d momentum_change =
        (a.mass_kg * a.velocity_after_mps + b.mass_kg * b.velocity_after_mps) - (pa + pb);
    const double energy = a.mass_kg * a.velocity_before_mps.squaredNorm() +
                          b.mass_kg * b.velocity_before_mps.squaredNorm();
    const double energy_after = a.mass_kg * a.velocity_after_mps.squaredNorm() +
                                b.mass_kg * b.velocity_after_mps.squaredNorm();
    return ConservationError{ratio(momentum_change.norm(), pa.norm() + pb.norm()),
                             ratio(std::abs(energy_after - energy), energy)};
}

std::string_view hits_csv_heading() {
    return "bot,tick,time_in_tick_s,"
           "own_ball,own_player,own_mass_kg,own_radius_m,own_x_m,own_y_m,"
           "own_vx_before_mps,own_vy_before_mps,own_vx_after_mps,own_vy_after_mps,"
           "other_ball,other_player,other_mass_kg,other_radius_m,other_x_m,other_y_m,"
           "other_vx_before_mps,other_vy_before_mps,other_vx_after_mps,other_vy_after_mps,"
           "normal_x,normal_y,impulse_ns,contacts_at_once,momentum_error,energy_error";
}

std::string hits_csv_line(int bot, const replication::CollisionReport& hit) {
    std::ostringstream out;
    out.precision(std::numeric_limits<double>::max_digits10);
    out << bot << ',' << hit.tick << ',' << hit.time_in_tick_s;
    write_side(out, hit.own);
    write_side(out, hit.other);
    out << ',' << hit.normal.x() << ',' << hit.normal.y() << ',' << hit.impulse_ns << ','
        << hit.contacts_at_once;
    if (const auto error = conservation_error(hit)) {
        out << ',' << error->momentum << ',' << error->energy;
    } else {
        out << ",,";
    }
    return out.str();
}

}  // namespace fts::bot
