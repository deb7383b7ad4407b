#include "server/lab/cost.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "common/physics/world.h"

namespace fts::lab {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Timed {
    double seconds = 0.0;
    std::size_t ticks = 0;
    std::size_t collisions = 0;
};

std::size_t collisions_of(const physics::CollisionAudit& audit) {
    return audit.ball_collisions + audit.wall_collisions;
}

// One pass over the run, or as much of it as fits into `budget_s`. The first tick, in which a
// solver allocates and looks at everything anew, is made and not timed.
template <typename Scalar>
Timed timed_pass(const physics::Scene& scene, const Setting& setting, const Run& run,
                 double budget_s) {
    physics::World<Scalar> world(scene, setting.solver);
    const auto tick_s = static_cast<Scalar>(run.tick_s);
    world.step(tick_s);
    const std::size_t before = collisions_of(world.audit());
    // The clock is asked after batches that grow, so that it costs nothing.
    Timed timed;
    std::size_t batch = 1;
    const auto start = Clock::now();
    while (timed.ticks < run.ticks && timed.seconds < budget_s) {
        const std::size_t end = std::min(run.ticks, timed.ticks + batch);
        for (; timed.ticks < end; ++timed.ticks) world.step(tick_s);
        timed.seconds = seconds_since(start);
        if (timed.seconds < budget_s / 16.0) batch *= 2;
    }
    timed.collisions = collisions_of(world.audit()) - before;
    return timed;
}

// Passes until the budget is used, so that a short run is timed as well as a long one.
template <typename Scalar>
Timed timed_repeat(const physics::Scene& scene, const Setting& setting, const Run& run,
                   double budget_s) {
    constexpr int kMaxPasses = 500;
    const auto start = Clock::now();
    Timed sum;
    for (int pass = 0; pass < kMaxPasses; ++pass) {
        const Timed one = timed_pass<Scalar>(scene, setting, run, budget_s - sum.seconds);
        sum.seconds += one.seconds;
        sum.ticks += one.ticks;
        sum.collisions += one.collisions;
        if (sum.seconds > 0.8 * budget_s || seconds_since(start) > 2.0 * budget_s) break;
    }
    return sum;
}

}  // namespace

std::optional<Cost> measure_cost(const physics::Scene& scene, const Setting& setting,
                                 const Run& run, const CostLimits& limits,
                                 const KeepGoing& keep_going) {
    if (scene.bodies.empty() || run.ticks == 0) return std::nullopt;
    const auto bodies = static_cast<double>(scene.bodies.size());
    std::vector<double> ns, rates;
    Cost cost;
    for (unsigned k = 0; k < limits.repeats; ++k) {
        if (!keep_going()) return std::nullopt;
        const Timed timed =
            setting.scalar == physics::ScalarKind::kFloat
                ? timed_repeat<float>(scene, setting, run, limits.seconds_of_a_repeat)
                : timed_repeat<double>(scene, setting, run, limits.seconds_of_a_repeat);
        ns.push_back(1e9 * timed.seconds / (static_cast<double>(timed.ticks) * bodies));
        rates.push_back(static_cast<double>(timed.collisions) / std::max(timed.seconds, 1e-9));
        cost.ticks = timed.ticks;
    }
    std::sort(ns.begin(), ns.end());
    std::sort(rates.begin(), rates.end());
    cost.ns_per_body_tick = ns[ns.size() / 2];
    cost.collisions_per_s = rates[rates.size() / 2];
    cost.least_ns = ns.front();
    cost.most_ns = ns.back();
    cost.repeats = limits.repeats;
    return cost;
}

}  // namespace fts::lab
