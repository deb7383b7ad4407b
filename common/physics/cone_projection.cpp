#include "common/physics/cone_projection.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace fts::physics {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// What is left of an approach, in units of the largest one's round-off, that is none.
constexpr double kResidualRoundOff = 64.0;
// A normal whose part across the active ones is shorter than this depends on them.
constexpr double kIndependent = 1e-7;
// A contact may leave and join the active set again; so often, for each contact.
constexpr std::size_t kChangesPerContact = 8;
// The gradient method is done when no step changes the impulses by more, relative to the largest.
constexpr double kGradientResidual = 1e-13;

}  // namespace

void ConeProjection::begin() {
    inverse_mass_.clear();
    contacts_.clear();
}

void ConeProjection::add_body(double inverse_mass_per_kg) {
    assert(inverse_mass_per_kg > 0.0);
    inverse_mass_.push_back(inverse_mass_per_kg);
}

void ConeProjection::add_contact(std::uint32_t a, std::uint32_t b, const Vec2d& normal,
                                 double approach_mps) {
    assert(a != kFixed || b != kFixed);
    const double inverse_mass = (a == kFixed ? 0.0 : inverse_mass_[a]) +  //
                                (b == kFixed ? 0.0 : inverse_mass_[b]);
    const double scale = 1.0 / std::sqrt(inverse_mass);
    contacts_.push_back({a, b, normal, approach_mps * scale, scale});
}

std::span<const double> ConeProjection::solve() {
    lambda_.assign(contacts_.size(), 0.0);
    if (contacts_.size() <= kMaxExactContacts) {
        solve_exactly();
    } else {
        solve_by_gradient();
    }
    for (std::size_t i = 0; i < contacts_.size(); ++i) lambda_[i] *= contacts_[i].scale;
    return lambda_;
}

double ConeProjection::coupling(const Contact& first, const Contact& second) const {
    const double along = first.normal.dot(second.normal);
    double sum = 0.0;
    if (first.a != kFixed && first.a == second.a) sum += inverse_mass_[first.a] * along;
    if (first.a != kFixed && first.a == second.b) sum -= inverse_mass_[first.a] * along;
    if (first.b != kFixed && first.b == second.a) sum -= inverse_mass_[first.b] * along;
    if (first.b != kFixed && first.b == second.b) sum += inverse_mass_[first.b] * along;
    return sum * first.scale * second.scale;
}

void ConeProjection::fill_couplings() {
    const std::size_t size = contacts_.size();
    coupling_.resize(size * size);
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double c = coupling(contacts_[i], contacts_[j]);
            coupling_[i * size + j] = c;
            coupling_[j * size + i] = c;
        }
        coupling_[i * size + i] = 1.0;
    }
}

void ConeProjection::solve_exactly() {
    fill_couplings();
    const std::size_t size = contacts_.size();
    factor_.resize(size * size);
    solution_.resize(size);
    residual_.resize(size);
    refused_.assign(size, 0);
    active_.clear();
    double largest = 0.0;
    for (const Contact& contact : contacts_) largest = std::max(largest, std::abs(contact.target));
    const double least = kResidualRoundOff * kEpsilon * largest;
    for (std::size_t changes = 0; changes < kChangesPerContact * size; ++changes) {
        const std::size_t next = most_pressed(least);
        if (next == size) return;
        if (!activate(next)) {
            refused_[next] = 1;
            continue;
        }
        std::fill(refused_.begin(), refused_.end(), std::uint8_t{0});
        while (!step_to_solution()) refactorise();
    }
}

// The inactive contact that approaches fastest at the present impulses; their number when none
// does.
std::size_t ConeProjection::most_pressed(double least) const {
    const std::size_t size = contacts_.size();
    std::size_t found = size;
    double fastest = least;
    for (std::size_t i = 0; i < size; ++i) {
        if (lambda_[i] > 0.0 || refused_[i] != 0) continue;
        double approach = -contacts_[i].target;
        for (const std::size_t j : active_) approach -= coupling_[i * size + j] * lambda_[j];
        if (approach > fastest) {
            fastest = approach;
            found = i;
        }
    }
    return found;
}

// False when its normal depends on the active ones, or when it would pull, which happens only by
// round-off.
bool ConeProjection::activate(std::size_t contact) {
    active_.push_back(contact);
    if (factorise_row(active_.size() - 1)) {
        solve_active();
        if (solution_[active_.size() - 1] > 0.0) return true;
    }
    active_.pop_back();
    return false;
}

bool ConeProjection::factorise_row(std::size_t row) {
    const std::size_t size = contacts_.size();
    double* const mine = &factor_[row * size];
    double rest = 1.0;
    for (std::size_t k = 0; k < row; ++k) {
        const double* const other = &factor_[k * size];
        double sum = coupling_[active_[row] * size + active_[k]];
        for (std::size_t l = 0; l < k; ++l) sum -= mine[l] * other[l];
        mine[k] = sum / other[k];
        rest -= mine[k] * mine[k];
    }
    if (!(rest > kIndependent * kIndependent)) return false;
    mine[row] = std::sqrt(rest);
    return true;
}

void ConeProjection::refactorise() {
    for (std::size_t row = 0; row < active_.size(); ++row) factorise_row(row);
    solve_active();
}

// The impulses at which no active contact approaches or parts.
void ConeProjection::solve_active() {
    const std::size_t size = contacts_.size();
    const std::size_t count = active_.size();
    for (std::size_t i = 0; i < count; ++i) {
        double sum = -contacts_[active_[i]].target;
        for (std::size_t k = 0; k < i; ++k) sum -= factor_[i * size + k] * solution_[k];
        solution_[i] = sum / factor_[i * size + i];
    }
    for (std::size_t i = count; i-- > 0;) {
        double sum = solution_[i];
        for (std::size_t k = i + 1; k < count; ++k) sum -= factor_[k * size + i] * solution_[k];
        solution_[i] = sum / factor_[i * size + i];
    }
}

// As far towards the solution as no impulse pulls; who would pull leaves the active set. True when
// the solution was reached.
bool ConeProjection::step_to_solution() {
    double share = 1.0;
    for (std::size_t i = 0; i < active_.size(); ++i) {
        const double now = lambda_[active_[i]];
        if (!(solution_[i] > 0.0)) share = std::min(share, now / (now - solution_[i]));
    }
    bool reached = true;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < active_.size(); ++i) {
        double& lambda = lambda_[active_[i]];
        const double target = solution_[i];
        const bool pulls = !(target > 0.0) && lambda / (lambda - target) <= share;
        lambda = pulls ? 0.0 : share < 1.0 ? lambda + share * (target - lambda) : target;
        reached = reached && target > 0.0;
        if (lambda > 0.0) {
            active_[kept++] = active_[i];
        } else {
            lambda = 0.0;
        }
    }
    active_.resize(kept);
    return reached;
}

std::uint32_t ConeProjection::largest_degree() {
    degree_.assign(inverse_mass_.size(), 0);
    for (const Contact& contact : contacts_) {
        if (contact.a != kFixed) ++degree_[contact.a];
        if (contact.b != kFixed) ++degree_[contact.b];
    }
    return *std::max_element(degree_.begin(), degree_.end());
}

// One step down the gradient from `ahead_`, which then is where the next one starts.
ConeProjection::Descent ConeProjection::descend(double rate, double momentum) {
    velocity_.assign(inverse_mass_.size(), Vec2d::Zero());
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const Contact& c = contacts_[i];
        const Vec2d push = (ahead_[i] * c.scale) * c.normal;
        if (c.a != kFixed) velocity_[c.a] += inverse_mass_[c.a] * push;
        if (c.b != kFixed) velocity_[c.b] -= inverse_mass_[c.b] * push;
    }
    Descent descent{0.0, false};
    double against = 0.0;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const Contact& c = contacts_[i];
        double parting = 0.0;
        if (c.a != kFixed) parting += c.normal.dot(velocity_[c.a]);
        if (c.b != kFixed) parting -= c.normal.dot(velocity_[c.b]);
        const double gradient = c.target + parting * c.scale;
        const double next = std::max(0.0, ahead_[i] - rate * gradient);
        const double change = next - lambda_[i];
        descent.largest_change = std::max(descent.largest_change, std::abs(change));
        against += (ahead_[i] - next) * change;
        ahead_[i] = std::max(0.0, next + momentum * change);
        lambda_[i] = next;
    }
    descent.turned_back = against > 0.0;
    return descent;
}

// The largest eigenvalue of the couplings is at most the largest number of contacts of one body,
// since each contact's effective mass is 1.
void ConeProjection::solve_by_gradient() {
    const double rate = 1.0 / static_cast<double>(largest_degree());
    ahead_.assign(contacts_.size(), 0.0);
    double pace = 1.0;
    for (std::uint32_t step = 0; step < kGradientSteps; ++step) {
        const double next_pace = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * pace * pace));
        const Descent descent = descend(rate, (pace - 1.0) / next_pace);
        pace = next_pace;
        if (descent.turned_back) {
            pace = 1.0;
            ahead_ = lambda_;
        }
        const double largest = *std::max_element(lambda_.begin(), lambda_.end());
        if (descent.largest_change <= kGradientResidual * largest) return;
    }
}

}  // namespace fts::physics
