#include "server/lab/accuracy.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/physics/world.h"
#include "server/lab/decided_tick.h"
#include "server/lab/oracle.h"
#include "server/lab/tick_comparison.h"

namespace fts::lab {
namespace {

using physics::BodyDef;
using physics::Scene;
using physics::Vec2d;
using physics::World;

// Contacts of the oracle this much of a tick apart belong to one instant, as in a rack.
constexpr double kInstantInTicks = 1e-9;

template <typename Scalar>
Vec2d as_held(const Vec2d& value) {
    return value.cast<Scalar>().template cast<double>();
}

// The boundary as a World in Scalar holds it.
template <typename Scalar>
Scene boundary_of(const Scene& scene) {
    Scene seen = scene;
    seen.bodies.clear();
    if (seen.walls) {
        seen.walls = {as_held<Scalar>(scene.walls->min_m), as_held<Scalar>(scene.walls->max_m)};
    }
    if (seen.periodic) {
        seen.periodic = {as_held<Scalar>(scene.periodic->min_m),
                         as_held<Scalar>(scene.periodic->max_m)};
    }
    return seen;
}

template <typename Scalar>
std::vector<BodyDef> bodies_of(const World<Scalar>& world) {
    std::vector<BodyDef> bodies;
    bodies.reserve(world.size());
    for (const physics::BodyId id : world.ids()) {
        const auto body = world.body(id);
        bodies.push_back({body.position_m.template cast<double>(),
                          body.velocity_mps.template cast<double>(),
                          static_cast<double>(body.radius_m), static_cast<double>(body.mass_kg)});
    }
    return bodies;
}

bool all_finite(const std::vector<BodyDef>& bodies) {
    return std::all_of(bodies.begin(), bodies.end(), [](const BodyDef& body) {
        return body.position_m.allFinite() && body.velocity_mps.allFinite();
    });
}

// A ball that a step or round-off left inside a wall touches it: the oracle has no inside.
void put_out_of_walls(Scene& scene) {
    if (!scene.walls) return;
    for (BodyDef& body : scene.bodies) {
        if (std::isinf(body.mass_kg)) continue;
        const Vec2d room = Vec2d::Constant(body.radius_m);
        const Vec2d low = scene.walls->min_m + room, high = scene.walls->max_m - room;
        body.position_m = body.position_m.cwiseMax(low).cwiseMin(high);
    }
}

struct Conserved {
    double energy_j = 0.0;
    Vec2d momentum_ns = Vec2d::Zero();
    double momenta_ns = 0.0;  // the sum of their sizes
};

Conserved conserved_by(const std::vector<BodyDef>& bodies) {
    Conserved sums;
    for (const BodyDef& body : bodies) {
        if (std::isinf(body.mass_kg)) continue;
        sums.energy_j += 0.5 * body.mass_kg * body.velocity_mps.squaredNorm();
        sums.momentum_ns += body.mass_kg * body.velocity_mps;
        sums.momenta_ns += body.mass_kg * body.velocity_mps.norm();
    }
    return sums;
}

template <typename Scalar>
class Runner {
  public:
    Runner(const Scene& scene, const Setting& setting, const Run& run)
        : scene_(scene), setting_(setting), run_(run), tick_s_(static_cast<Scalar>(run.tick_s)) {}

    // The whole run; also how many of its collisions are to be sampled follows from it.
    bool run_globally(const Reference* reference, const KeepGoing& keep_going, Accuracy& accuracy);
    bool compare_ticks(const SamplingLimits& limits, const KeepGoing& keep_going,
                       Accuracy& accuracy);

  private:
    // What walls and infinite masses gave to the others in the last step, at its end.
    Vec2d outer_impulse_ns(const World<Scalar>& world) const;
    void conclude(const World<Scalar>& world, const Conserved& start, const Vec2d& expected_ns,
                  Accuracy& accuracy) const;

    static constexpr double kEpsilon = static_cast<double>(std::numeric_limits<Scalar>::epsilon());

    const Scene& scene_;
    const Setting setting_;
    const Run run_;
    const Scalar tick_s_;
};

template <typename Scalar>
Vec2d Runner<Scalar>::outer_impulse_ns(const World<Scalar>& world) const {
    Vec2d sum = Vec2d::Zero();
    for (const auto& contact : world.contacts()) {
        const bool a_given = std::isfinite(contact.mass_a_kg);
        const bool b_given = contact.b && std::isfinite(contact.mass_b_kg);
        if (a_given == b_given) continue;
        const double left =
            std::exp(-scene_.drag_per_s * (run_.tick_s - static_cast<double>(contact.time_s)));
        const double sign = a_given ? 1.0 : -1.0;
        sum += sign * left * static_cast<double>(contact.impulse_ns) *
               contact.normal.template cast<double>();
    }
    return sum;
}

template <typename Scalar>
bool Runner<Scalar>::run_globally(const Reference* reference, const KeepGoing& keep_going,
                                  Accuracy& accuracy) {
    World<Scalar> world(scene_, setting_.solver);
    const Conserved start = conserved_by(bodies_of(world));
    const double kept = std::exp(-scene_.drag_per_s * run_.tick_s);
    Vec2d expected_ns = start.momentum_ns;
    std::vector<Hit> hits;
    GlobalAccuracy& global = accuracy.global;
    for (std::size_t tick = 0; tick < run_.ticks; ++tick) {
        if (!keep_going()) return false;
        const auto report = world.step(tick_s_);
        global.overruns += report.overrun ? 1 : 0;
        ++global.ticks;
        expected_ns = expected_ns * kept + outer_impulse_ns(world);
        if (!reference) continue;
        const double start_s = static_cast<double>(tick) * run_.tick_s;
        if (start_s > reference->until_s) continue;
        for (const auto& contact : world.contacts()) {
            Hit hit = seen(contact).hit;
            hit.time_s += start_s;
            hits.push_back(hit);
        }
    }
    conclude(world, start, expected_ns, accuracy);
    if (reference) {
        global.divergence = divergence(reference->hits, hits, scene_.bodies.size(),
                                       std::min(run_.seconds(), reference->until_s), run_.tick_s,
                                       kInstantInTicks * run_.tick_s);
    }
    return true;
}

template <typename Scalar>
void Runner<Scalar>::conclude(const World<Scalar>& world, const Conserved& start,
                              const Vec2d& expected_ns, Accuracy& accuracy) const {
    GlobalAccuracy& global = accuracy.global;
    global.ball_collisions = world.audit().ball_collisions;
    global.wall_collisions = world.audit().wall_collisions;
    global.penetration_over_r = world.audit().worst_penetration;
    char hash[24];
    std::snprintf(hash, sizeof hash, "%016" PRIx64, world.state_hash());
    global.state_hash = hash;
    const auto bodies = bodies_of(world);
    global.finite = all_finite(bodies);
    if (!global.finite) {
        accuracy.remarks.push_back("the state became infinite or not a number");
        return;
    }
    const Conserved end = conserved_by(bodies);
    const double decay = std::exp(-scene_.drag_per_s * run_.seconds());
    const bool moving_infinite_mass =
        std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [](const BodyDef& body) {
            return std::isinf(body.mass_kg) && body.velocity_mps.squaredNorm() > 0.0;
        });
    if (scene_.restitution < 1.0) {
        accuracy.remarks.push_back("restitution is below 1: energy is not conserved");
    } else if (scene_.platform) {
        accuracy.remarks.push_back("who falls off the platform takes energy and momentum away");
    } else if (moving_infinite_mass) {
        accuracy.remarks.push_back("an infinite mass that moves gives energy");
    } else if (start.energy_j > 0.0) {
        const double expected_j = start.energy_j * decay * decay;
        global.energy_error = (end.energy_j - expected_j) / expected_j;
    } else {
        accuracy.remarks.push_back("nothing moves: there is no energy to compare with");
    }
    if (!scene_.platform && start.momenta_ns > 0.0) {
        global.momentum_error = (end.momentum_ns - expected_ns).norm() /
                                std::max(start.momenta_ns * decay, end.momenta_ns);
    }
}

template <typename Scalar>
bool Runner<Scalar>::compare_ticks(const SamplingLimits& limits, const KeepGoing& keep_going,
                                   Accuracy& accuracy) {
    const std::size_t collisions =
        accuracy.global.ball_collisions + accuracy.global.wall_collisions;
    // Spread over the whole run, at odds with any rhythm that it may have.
    const std::size_t every = std::max<std::size_t>(1, collisions / limits.collisions);
    World<Scalar> world(scene_, setting_.solver);
    Scene before = boundary_of<Scalar>(scene_);
    TickComparison comparison;
    double work_left = limits.work;
    const double kept = std::exp(-scene_.drag_per_s * run_.tick_s);
    for (std::size_t tick = 0; tick < run_.ticks && work_left > 0.0; ++tick) {
        if (!keep_going()) return false;
        if (tick % every != 0) {
            world.step(tick_s_);
            continue;
        }
        before.bodies = bodies_of(world);
        put_out_of_walls(before);
        if (validate(before, physics::Overlaps::kAccepted)) {
            accuracy.remarks.push_back(
                "the solver left what a scene may hold; ticks after it are "
                "not compared");
            break;
        }
        world.step(tick_s_);
        const auto [verdict, exact] = decided_tick(before, static_cast<double>(tick_s_), kEpsilon,
                                                   std::min(limits.work_of_a_tick, work_left));
        if (verdict == Verdict::kUndecided) comparison.add_undecided();
        if (verdict == Verdict::kTooBusy) {
            comparison.add_too_busy();
            work_left -= limits.work_of_a_tick;
        }
        if (!exact) continue;
        work_left -= exact->work;
        std::vector<Vec2d> velocities;
        for (const BodyDef& body : bodies_of(world)) velocities.push_back(body.velocity_mps);
        std::vector<SeenContact> contacts;
        for (const auto& contact : world.contacts()) contacts.push_back(seen(contact));
        comparison.add(before.bodies, kept, *exact, velocities, contacts,
                       static_cast<double>(tick_s_));
    }
    accuracy.local = comparison.result();
    if (accuracy.local.ticks_undecided > 0) {
        accuracy.remarks.push_back(std::to_string(accuracy.local.ticks_undecided) +
                                   " ticks are left out: round-off decides whether a collision is "
                                   "in them or in the next");
    }
    if (accuracy.local.ticks_too_busy > 0) {
        accuracy.remarks.push_back(std::to_string(accuracy.local.ticks_too_busy) +
                                   " ticks had more collisions than the oracle was given time for");
    }
    return true;
}

template <typename Scalar>
std::optional<Accuracy> measure(const Scene& scene, const Setting& setting, const Run& run,
                                const SamplingLimits& limits, const Reference* reference,
                                const KeepGoing& keep_going) {
    Accuracy accuracy;
    const std::string reason = reason_not_to_judge(scene);
    Runner<Scalar> runner(scene, setting, run);
    if (!runner.run_globally(reason.empty() ? reference : nullptr, keep_going, accuracy)) {
        return std::nullopt;
    }
    if (!reason.empty()) {
        accuracy.remarks.push_back(reason);
    } else if (!runner.compare_ticks(limits, keep_going, accuracy)) {
        return std::nullopt;
    }
    return accuracy;
}

}  // namespace

std::optional<double> LocalAccuracy::missed_per_1000() const {
    if (collisions == 0) return std::nullopt;
    return 1000.0 * static_cast<double>(missed) / static_cast<double>(collisions);
}

std::optional<double> LocalAccuracy::extra_per_1000() const {
    if (collisions == 0) return std::nullopt;
    return 1000.0 * static_cast<double>(extra) / static_cast<double>(collisions);
}

std::string reason_not_to_judge(const Scene& scene) {
    if (scene.platform) {
        return "the oracle does not model platforms: no collision errors and no divergence";
    }
    if (scene.restitution < 1.0) {
        return "the oracle does not model restitution below 1: no collision errors and no "
               "divergence";
    }
    return {};
}

std::optional<Reference> reference_of(const Scene& scene, const Run& run,
                                      const SamplingLimits& limits, const KeepGoing& keep_going) {
    if (!reason_not_to_judge(scene).empty()) return std::nullopt;
    const auto bodies = static_cast<double>(scene.bodies.size());
    const auto most =
        static_cast<std::size_t>(std::max(1.0, limits.work_of_reference / (2.0 * bodies)));
    // In pieces, so that it can be stopped.
    constexpr std::size_t kPieces = 200;
    const double piece_s = run.seconds() / kPieces;
    Oracle oracle(scene);
    Reference reference;
    for (std::size_t piece = 0; piece < kPieces; ++piece) {
        if (!keep_going()) return std::nullopt;
        const bool all = oracle.advance(piece_s, most - reference.hits.size());
        for (const OracleContact& contact : oracle.contacts()) {
            Hit hit = seen(contact).hit;
            hit.time_s += static_cast<double>(piece) * piece_s;
            reference.hits.push_back(hit);
        }
        if (!all || reference.hits.size() >= most) {
            if (!reference.hits.empty()) reference.until_s = reference.hits.back().time_s;
            return reference;
        }
        reference.until_s = static_cast<double>(piece + 1) * piece_s;
    }
    return reference;
}

std::optional<Accuracy> measure_accuracy(const Scene& scene, const Setting& setting, const Run& run,
                                         const SamplingLimits& limits, const Reference* reference,
                                         const KeepGoing& keep_going) {
    return setting.scalar == physics::ScalarKind::kFloat
               ? measure<float>(scene, setting, run, limits, reference, keep_going)
               : measure<double>(scene, setting, run, limits, reference, keep_going);
}

}  // namespace fts::lab
