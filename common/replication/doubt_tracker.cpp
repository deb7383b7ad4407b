#include "common/replication/doubt_tracker.h"

#include <algorithm>
#include <cmath>

namespace fts::replication {
namespace {

// Of rounding to whole steps.
constexpr double kRoundingVariance = 1.0 / 12.0;
// A glancing hit may not come at all; from here on it is not followed to first order.
constexpr double kLeastCosine = 0.15;
constexpr double kLeanOne = 16384.0;
constexpr double kLeverOne = 65536.0;
// Steering in one direction or another: this part of its square along each axis.
constexpr double kAlongAxis = 0.45;
// When it began is open; the place it leads to has this part of the variance of its greatest.
constexpr double kPlaceOfSteered = 0.02;

}  // namespace

DoubtTracker::DoubtTracker(const Lattice& lattice, std::span<const BallState> baseline,
                           bool rounded, double unforeseen_mps2)
    : lever_per_s_(lattice.velocity_step_mps / lattice.position_step_m),
      position_step_m_(lattice.position_step_m),
      velocity_step_mps_(lattice.velocity_step_mps),
      rounding_variance_(rounded ? kRoundingVariance : 0.0),
      unforeseen_steps_per_s_(unforeseen_mps2 / lattice.velocity_step_mps),
      tracks_(baseline.size()),
      broken_(baseline.size(), false) {
    for (std::size_t i = 0; i < baseline.size(); ++i) {
        tracks_[i].place_variance = tracks_[i].speed_variance = rounding_variance_;
        tracks_[i].steered = baseline[i].kind == static_cast<std::uint8_t>(BallKind::kPlayer);
        tracks_[i].group = static_cast<std::uint32_t>(i);
    }
}

double DoubtTracker::unforeseen_variance(double time_s) const {
    const double steps = unforeseen_steps_per_s_ * time_s;
    return kAlongAxis * steps * steps;
}

void DoubtTracker::bring_to(Track& track, double time_s) const {
    const double lever = lever_per_s_ * (time_s - track.time_s);
    double speed_variance = track.speed_variance;
    if (track.steered) {
        const double gained = unforeseen_variance(time_s) - unforeseen_variance(track.time_s);
        track.speed_variance += gained;
        speed_variance += gained / 4.0;
    }
    track.place_variance += lever * lever * speed_variance;
    track.time_s = time_s;
}

std::uint32_t DoubtTracker::root_of(std::uint32_t index) {
    while (tracks_[index].group != index) {
        index = tracks_[index].group = tracks_[tracks_[index].group].group;
    }
    return index;
}

void DoubtTracker::follow(std::span<const physics::Contact<double>> contacts, double start_s) {
    for (const physics::Contact<double>& contact : contacts) {
        if (contact.b) {
            hit(contact, start_s + contact.time_s);
        } else {
            hit_wall(contact);
        }
    }
}

void DoubtTracker::hit(const physics::Contact<double>& contact, double time_s) {
    const std::uint32_t i = contact.a.index, j = contact.b->index;
    Track& a = tracks_[i];
    Track& b = tracks_[j];
    bring_to(a, time_s);
    bring_to(b, time_s);
    const physics::Vec2d u = contact.velocity_a_before_mps - contact.velocity_b_before_mps;
    const physics::Vec2d n = contact.normal;
    const physics::Vec2d t{-n.y(), n.x()};
    const double speed_mps = u.norm();
    const double reach_m = (contact.position_a_m - contact.position_b_m).norm();
    if (speed_mps > 0.0 && reach_m > 0.0) {
        const double cosine = std::max(kLeastCosine, std::abs(u.dot(n)) / speed_mps);
        const double speed = speed_mps / velocity_step_mps_;
        const double reach = reach_m / position_step_m_;
        const double angle_variance =
            (a.place_variance + b.place_variance) / (reach * reach * cosine * cosine);
        // To first order at most a right angle's worth.
        const double turned = speed * speed * std::min(angle_variance, 0.25);
        const double mixed = (a.speed_variance + b.speed_variance) / 2.0;
        const physics::Vec2d lean = (u.dot(t) * n + u.dot(n) * t) / speed_mps;
        const double masses_kg = contact.mass_a_kg + contact.mass_b_kg;
        const double share_a = 2.0 * contact.mass_b_kg / masses_kg;
        const double share_b = 2.0 * contact.mass_a_kg / masses_kg;
        a.speed_variance = mixed + turned * share_a * share_a;
        b.speed_variance = mixed + turned * share_b * share_b;
        a.variance_before_hit = b.variance_before_hit = mixed;
        a.lean_x = b.lean_x = lean.x();
        a.lean_y = b.lean_y = lean.y();
    }
    a.hit = b.hit = true;
    const std::uint32_t first = std::min(root_of(i), root_of(j));
    const std::uint32_t second = std::max(root_of(i), root_of(j));
    broken_[first] = broken_[first] || broken_[second];
    tracks_[second].group = first;
}

void DoubtTracker::hit_wall(const physics::Contact<double>& contact) {
    Track& track = tracks_[contact.a.index];
    if (!track.hit) return;
    broken_[root_of(contact.a.index)] = true;
    if (std::abs(contact.normal.x()) > 0.5) track.lean_x = -track.lean_x;
    if (std::abs(contact.normal.y()) > 0.5) track.lean_y = -track.lean_y;
}

void DoubtTracker::judge(double end_s, std::span<Expectation> expectations) {
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
        Track& track = tracks_[i];
        Expectation& ball = expectations[i];
        const double since_s = end_s - track.time_s;
        const double unforeseen =
            track.steered ? unforeseen_variance(end_s) - unforeseen_variance(track.time_s) : 0.0;
        // A velocity that nothing has changed is rounded as it was.
        const double changed = track.hit ? track.speed_variance + rounding_variance_ : 0.0;
        const double left = track.hit ? track.variance_before_hit + rounding_variance_ : 0.0;
        ball.speed_doubt = doubt_of(changed + unforeseen);
        ball.speed_doubt_left = doubt_of(left + unforeseen);
        const double lever = lever_per_s_ * since_s;
        ball.place_doubt =
            doubt_of(track.place_variance + rounding_variance_ +
                     lever * lever * (rounding_variance_ + kPlaceOfSteered * unforeseen));
        ball.timed = !track.steered || unforeseen_steps_per_s_ == 0.0;
        ball.lever = static_cast<std::int32_t>(std::min(lever * kLeverOne, 2e9));
        const bool leans = track.hit && unforeseen == 0.0;
        ball.lean_x = leans ? static_cast<std::int32_t>(track.lean_x * kLeanOne) : 0;
        ball.lean_y = leans ? static_cast<std::int32_t>(track.lean_y * kLeanOne) : 0;
        const auto index = static_cast<std::uint32_t>(i);
        const std::uint32_t root = root_of(index);
        ball.group = broken_[root] ? index : root;
    }
}

}  // namespace fts::replication
