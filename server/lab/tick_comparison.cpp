#include "server/lab/tick_comparison.h"

#include <algorithm>
#include <numbers>
#include <tuple>

namespace fts::lab {
namespace {

auto key_of(const SeenContact& contact) {
    return std::tuple(contact.hit.a, contact.hit.b, contact.hit.time_s);
}

bool same_pair(const SeenContact& x, const SeenContact& y) {
    return x.hit.a == y.hit.a && x.hit.b == y.hit.b;
}

void sort_by_pair_and_time(std::vector<SeenContact>& contacts) {
    std::stable_sort(
        contacts.begin(), contacts.end(),
        [](const SeenContact& x, const SeenContact& y) { return key_of(x) < key_of(y); });
}

double angle_between_deg(const physics::Vec2d& u, const physics::Vec2d& v) {
    const double cross = u.x() * v.y() - u.y() * v.x();
    return std::atan2(std::abs(cross), u.dot(v)) * 180.0 / std::numbers::pi;
}

}  // namespace

SeenContact seen(const OracleContact& contact) {
    const auto a = static_cast<std::uint32_t>(contact.a);
    if (!contact.b) {
        return {{a, wall_with_normal(contact.normal), contact.time_s},
                contact.velocity_a_after_mps};
    }
    return {{a, static_cast<std::uint32_t>(*contact.b), contact.time_s},
            contact.velocity_a_after_mps - contact.velocity_b_after_mps};
}

void TickComparison::add(const std::vector<physics::BodyDef>& before, double kept,
                         const ExactTick& exact,
                         const std::vector<physics::Vec2d>& solver_velocity_after_mps,
                         const std::vector<SeenContact>& solver_contacts, double tick_s) {
    if (exact.contacts.empty() && solver_contacts.empty()) return;
    ++sums_.ticks;
    std::vector<SeenContact> true_contacts;
    for (const OracleContact& contact : exact.contacts) true_contacts.push_back(seen(contact));
    std::vector<bool> collides(before.size(), false);
    const auto mark = [&](const std::vector<SeenContact>& contacts) {
        for (const SeenContact& contact : contacts) {
            collides[contact.hit.a] = true;
            if (contact.hit.b < kFirstWall) collides[contact.hit.b] = true;
        }
    };
    mark(true_contacts);
    mark(solver_contacts);
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (!collides[i]) continue;
        const physics::Vec2d& truth = exact.velocity_after_mps[i];
        wrong_ += (solver_velocity_after_mps[i] - truth).squaredNorm();
        ignored_ += (before[i].velocity_mps * kept - truth).squaredNorm();
        speed_ += truth.squaredNorm();
    }
    compare_contacts(std::move(true_contacts), solver_contacts, tick_s);
}

// The k-th hit of a pair is matched with the k-th.
void TickComparison::compare_contacts(std::vector<SeenContact> exact,
                                      std::vector<SeenContact> solver, double tick_s) {
    sort_by_pair_and_time(exact);
    sort_by_pair_and_time(solver);
    sums_.collisions += exact.size();
    std::size_t i = 0, j = 0;
    while (i < exact.size() && j < solver.size()) {
        if (same_pair(exact[i], solver[j])) {
            ++sums_.matched;
            const double late = (solver[j].hit.time_s - exact[i].hit.time_s) / tick_s;
            time_ += late * late;
            const auto &u = exact[i].relative_velocity_after_mps,
                       &v = solver[j].relative_velocity_after_mps;
            if (u.squaredNorm() > 0.0 && v.squaredNorm() > 0.0) {
                const double angle = angle_between_deg(u, v);
                angle_ += angle * angle;
                ++angles_;
            }
            ++i;
            ++j;
        } else if (std::tie(exact[i].hit.a, exact[i].hit.b) <
                   std::tie(solver[j].hit.a, solver[j].hit.b)) {
            ++sums_.missed;
            ++i;
        } else {
            ++sums_.extra;
            ++j;
        }
    }
    sums_.missed += exact.size() - i;
    sums_.extra += solver.size() - j;
}

LocalAccuracy TickComparison::result() const {
    LocalAccuracy result = sums_;
    if (speed_ > 0.0) {
        result.collision_error = std::sqrt(wrong_ / speed_);
        result.error_of_ignoring = std::sqrt(ignored_ / speed_);
    }
    if (result.matched > 0) {
        result.time_error_ticks = std::sqrt(time_ / static_cast<double>(result.matched));
    }
    if (angles_ > 0) result.angle_error_deg = std::sqrt(angle_ / static_cast<double>(angles_));
    return result;
}

}  // namespace fts::lab
