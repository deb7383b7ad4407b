#include <algorithm>
#include <cmath>
#include <limits>

#include "server/lab/oracle_impl.h"

namespace fts::lab {
namespace {

constexpr double kRestsBelow = 1e-30;  // of the speeds of what touches
constexpr double kConverged = 1e-33;   // of the speeds in a set of contacts
constexpr int kMaxSweeps = 200'000;

}  // namespace

using oracle::kSides;

// All that touches, directly or through others, and approaches is reflected until nothing does.
// Returns who was hit.
std::vector<std::size_t> Oracle::Impl::resolve(const Touch& first, Quad now) {
    const std::vector<Constraint> all = touching_cluster(first);
    std::vector<std::size_t> hit;
    const auto note = [&hit](std::size_t ball) {
        if (std::find(hit.begin(), hit.end(), ball) == hit.end()) hit.push_back(ball);
    };
    while (events_left > 0) {
        std::vector<Constraint> due;
        for (const Constraint& contact : all) {
            if (approaches(contact.touch, contact.normal)) due.push_back(contact);
        }
        if (due.empty()) break;
        reflect(due, now);
        for (const Constraint& contact : due) {
            note(contact.touch.a);
            if (!contact.touch.is_wall) note(contact.touch.b);
        }
    }
    return hit;
}

std::vector<oracle::Constraint> Oracle::Impl::touching_cluster(const Touch& first) const {
    std::vector<Constraint> all;
    std::vector<std::size_t> members{first.a};
    if (!first.is_wall) members.push_back(first.b);
    for (std::size_t i = 0; i < members.size(); ++i) add_neighbours(members[i], all, members);
    return all;
}

void Oracle::Impl::add_neighbours(std::size_t ball, std::vector<Constraint>& all,
                                  std::vector<std::size_t>& members) const {
    const auto add = [&](const Touch& touch) {
        const bool known = std::any_of(all.begin(), all.end(),
                                       [&](const Constraint& c) { return c.touch == touch; });
        if (!known && gap(touch) <= touch_tolerance(touch)) {
            all.push_back({touch, normal_of(touch)});
            return true;
        }
        return false;
    };
    if (!balls[ball].is_movable()) return;
    for (std::size_t other = 0; other < balls.size(); ++other) {
        if (other == ball) continue;
        const double near = 1.0 + 1e-6;
        const physics::Vec2d d = rounded(separation(ball, other));
        const double reach = static_cast<double>(balls[ball].radius + balls[other].radius);
        const double coarse = 1e-6 * rounded(balls[ball].position).norm();
        if (!(d.norm() <= reach * near + coarse)) continue;
        if (!add({std::min(ball, other), std::max(ball, other), false})) continue;
        if (std::find(members.begin(), members.end(), other) == members.end()) {
            members.push_back(other);
        }
    }
    if (!rules.walls) return;
    for (std::size_t side = 0; side < kSides; ++side) add({ball, side, true});
}

// Projects velocities onto those that separate all that is due: Gauss-Seidel over impulses that
// only push.
void Oracle::Impl::solve(std::vector<Constraint>& due, std::vector<QuadVec>& velocity) const {
    Quad scale(0);
    for (const Constraint& contact : due) {
        const Quad speed = norm(velocity[contact.touch.a]);
        if (speed > scale) scale = speed;
        if (contact.touch.is_wall) continue;
        const Quad other = norm(velocity[contact.touch.b]);
        if (other > scale) scale = other;
    }
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
        Quad change(0);
        for (Constraint& contact : due) {
            const Ball& a = balls[contact.touch.a];
            const Ball* b = contact.touch.is_wall ? nullptr : &balls[contact.touch.b];
            const Quad inverse_mass = a.inverse_mass + (b ? b->inverse_mass : Quad(0));
            QuadVec relative = velocity[contact.touch.a];
            if (b) relative -= velocity[contact.touch.b];
            Quad impulse = contact.impulse - dot(relative, contact.normal) / inverse_mass;
            if (impulse < Quad(0)) impulse = Quad(0);
            const QuadVec push = contact.normal * (impulse - contact.impulse);
            velocity[contact.touch.a] += push * a.inverse_mass;
            if (b) velocity[contact.touch.b] -= push * b->inverse_mass;
            const Quad moved = magnitude(impulse - contact.impulse) * inverse_mass;
            if (moved > change) change = moved;
            contact.impulse = impulse;
        }
        if (due.size() == 1 || change <= Quad(kConverged) * scale) return;
    }
}

// v + 2 s (v' - v), with v' the projection, and s such that energy is kept whatever is left of the
// impulses' convergence.
void Oracle::Impl::reflect(std::vector<Constraint>& due, Quad now) {
    std::vector<QuadVec> projected(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) projected[i] = balls[i].velocity;
    solve(due, projected);
    Quad pushed(0), change(0);
    for (const Constraint& contact : due) {
        const Touch& touch = contact.touch;
        QuadVec relative = projected[touch.a] - balls[touch.a].velocity;
        if (!touch.is_wall) relative -= projected[touch.b] - balls[touch.b].velocity;
        pushed -= contact.impulse * dot(relative_velocity(touch), contact.normal);
        change += contact.impulse * dot(relative, contact.normal);
    }
    const Quad strength = change > Quad(0) ? Quad(2) * pushed / change : Quad(0);
    for (const Constraint& contact : due)
        account(contact, contact.normal * (contact.impulse * strength));
    for (const Constraint& contact : due) {
        const QuadVec impulse = contact.normal * (contact.impulse * strength);
        Ball& a = balls[contact.touch.a];
        a.velocity += impulse * a.inverse_mass;
        if (contact.touch.is_wall) continue;
        Ball& b = balls[contact.touch.b];
        b.velocity -= impulse * b.inverse_mass;
    }
    const Quad slower = slice_start + now;
    const Quad kept = Quad(1) - drag * slower / slowed;
    const double passed_s =
        drag > Quad(0)
            ? -std::log1p(-static_cast<double>(drag * slower / slowed)) / static_cast<double>(drag)
            : static_cast<double>(slower);
    for (const Constraint& contact : due) {
        if (!(contact.impulse > Quad(0))) continue;
        const Touch& touch = contact.touch;
        const auto velocity = [&](std::size_t ball) {
            return rounded(balls[ball].velocity * (slowed * kept));
        };
        contacts.push_back({touch.a, touch.is_wall ? std::nullopt : std::optional(touch.b),
                            passed_s, rounded(contact.normal), velocity(touch.a),
                            touch.is_wall ? physics::Vec2d::Zero() : velocity(touch.b)});
        ++(touch.is_wall ? wall_collisions : ball_collisions);
        if (events_left > 0) --events_left;
    }
}

// What walls and immovable balls give to the others, and the work of those that move.
void Oracle::Impl::account(const Constraint& hit, const QuadVec& impulse) {
    const Touch& touch = hit.touch;
    if (touch.is_wall) {
        outer_impulse += impulse;
    } else if (!balls[touch.b].is_movable()) {
        outer_impulse += impulse;
        work += dot(impulse, balls[touch.b].velocity);
    } else if (!balls[touch.a].is_movable()) {
        outer_impulse -= impulse;
        work -= dot(impulse, balls[touch.a].velocity);
    }
}

QuadVec Oracle::Impl::separation(std::size_t a, std::size_t b) const {
    QuadVec d = balls[a].position - balls[b].position;
    if (!rules.periodic) return d;
    const auto fold = [](Quad x, double extent) {
        const double times = std::round(static_cast<double>(x) / extent);
        return x - Quad(times) * Quad(extent);
    };
    const physics::Vec2d extent = rules.periodic->max_m - rules.periodic->min_m;
    return {fold(d.x, extent.x()), fold(d.y, extent.y())};
}

Quad Oracle::Impl::gap(const Touch& touch) const {
    const Ball& a = balls[touch.a];
    if (!touch.is_wall) {
        return norm(separation(touch.a, touch.b)) - a.radius - balls[touch.b].radius;
    }
    switch (touch.b) {
        case 0:
            return a.position.x - Quad(rules.walls->min_m.x()) - a.radius;
        case 1:
            return Quad(rules.walls->max_m.x()) - a.position.x - a.radius;
        case 2:
            return a.position.y - Quad(rules.walls->min_m.y()) - a.radius;
        default:
            return Quad(rules.walls->max_m.y()) - a.position.y - a.radius;
    }
}

Quad Oracle::Impl::touch_tolerance(const Touch& touch) const {
    Quad reach = balls[touch.a].radius;
    Quad extent = magnitude(balls[touch.a].position.x) + magnitude(balls[touch.a].position.y);
    if (!touch.is_wall) {
        reach += balls[touch.b].radius;
        extent += magnitude(balls[touch.b].position.x) + magnitude(balls[touch.b].position.y);
    }
    return Quad(physics::kTouchTolerance) * reach +
           Quad(std::numeric_limits<double>::epsilon()) * extent;
}

QuadVec Oracle::Impl::normal_of(const Touch& touch) const {
    if (touch.is_wall) {
        constexpr double kNormals[kSides][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
        return {Quad(kNormals[touch.b][0]), Quad(kNormals[touch.b][1])};
    }
    const QuadVec d = separation(touch.a, touch.b);
    const Quad distance = norm(d);
    return distance > Quad(0) ? d * (Quad(1) / distance) : QuadVec{};
}

QuadVec Oracle::Impl::relative_velocity(const Touch& touch) const {
    const QuadVec& velocity = balls[touch.a].velocity;
    return touch.is_wall ? velocity : velocity - balls[touch.b].velocity;
}

bool Oracle::Impl::approaches(const Touch& touch, const QuadVec& normal) const {
    Quad speeds = norm(balls[touch.a].velocity);
    if (!touch.is_wall) speeds += norm(balls[touch.b].velocity);
    const bool can_move =
        balls[touch.a].is_movable() || (!touch.is_wall && balls[touch.b].is_movable());
    return can_move && dot(relative_velocity(touch), normal) < -Quad(kRestsBelow) * speeds;
}

}  // namespace fts::lab
