#include "server/lab/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace fts::lab {
namespace {

using Clock = std::chrono::steady_clock;

// A tick that is taken up so often without getting on never ends.
constexpr int kMaxFruitlessSteps = 64;
// A part of a tick below which a last, shorter one is round-off.
constexpr double kWholeTick = 1e-9;

struct Ticks {
    std::uint64_t whole = 0;
    double rest_s = 0.0;
    std::uint64_t in_all() const { return whole + (rest_s > 0.0 ? 1 : 0); }
};

Ticks ticks_of(const RunSettings& settings) {
    const double exact = settings.seconds * settings.rate_hz;
    Ticks ticks;
    ticks.whole = static_cast<std::uint64_t>(std::floor(exact + kWholeTick));
    const double rest = exact - static_cast<double>(ticks.whole);
    if (rest > kWholeTick) ticks.rest_s = rest / settings.rate_hz;
    return ticks;
}

template <typename Scalar>
class RunInProgress {
  public:
    RunInProgress(const physics::Scene& scene, const RunSettings& settings,
                  const Observer& observer)
        : settings_(settings),
          observer_(observer),
          ticks_(ticks_of(settings)),
          world_(scene, settings.setting.solver) {
        result_.bodies_at_start = world_.size();
        result_.energy_at_start_j = world_.kinetic_energy_j();
        result_.momentum_at_start_ns = world_.momentum_ns();
        for (const physics::BodyDef& body : scene.bodies) {
            if (std::isinf(body.mass_kg)) continue;
            result_.momentum_scale_ns += body.mass_kg * body.velocity_mps.norm();
        }
        state_.ticks_in_all = ticks_.in_all();
    }

    RunResult go() {
        show();
        while (state_.tick < state_.ticks_in_all && result_.stuck.empty() && !result_.was_stopped) {
            tick();
        }
        result_.ticks = state_.tick;
        result_.simulated_s = state_.time_s;
        result_.bodies_at_end = world_.size();
        result_.audit = world_.audit();
        result_.deepest_overlap =
            std::max(result_.deepest_overlap, result_.audit.worst_penetration);
        result_.energy_at_end_j = world_.kinetic_energy_j();
        result_.momentum_at_end_ns = world_.momentum_ns();
        result_.state_hash = world_.state_hash();
        return result_;
    }

  private:
    void tick() {
        const bool is_whole = state_.tick < ticks_.whole;
        const double span_s = is_whole ? 1.0 / settings_.rate_hz : ticks_.rest_s;
        result_.body_ticks += static_cast<double>(world_.size());
        advance(static_cast<Scalar>(span_s));
        ++state_.tick;
        state_.time_s =
            is_whole ? static_cast<double>(state_.tick) / settings_.rate_hz : settings_.seconds;
        const physics::CollisionAudit& audit = world_.audit();
        state_.collisions = audit.ball_collisions + audit.wall_collisions;
        result_.deepest_overlap = std::max(result_.deepest_overlap, world_.deepest_overlap());
        show();
        if (observer_.go_on && !observer_.go_on(state_)) result_.was_stopped = true;
    }

    // What a step leaves unspent is stepped again, so that no time is lost.
    void advance(Scalar span_s) {
        int fruitless = 0;
        for (;;) {
            const Clock::time_point began = Clock::now();
            const physics::StepReport report = world_.step(span_s);
            result_.stepping_s += std::chrono::duration<double>(Clock::now() - began).count();
            result_.falls += world_.falls().size();
            if (!report.overrun) return;
            ++result_.overruns;
            const auto unspent_s = static_cast<Scalar>(report.unspent_time_s);
            fruitless = unspent_s < span_s ? 0 : fruitless + 1;
            if (fruitless >= kMaxFruitlessSteps) {
                result_.stuck = "collisions never end at " + std::to_string(state_.time_s) +
                                " s, as for a ball that just fills the room between two infinite "
                                "masses; give it more room";
                return;
            }
            if (observer_.go_on && !observer_.go_on(state_)) {
                result_.was_stopped = true;
                return;
            }
            span_s = unspent_s;
        }
    }

    void show() {
        if (!observer_.wants_bodies || !observer_.wants_bodies(state_)) return;
        for (const physics::BodyId id : world_.ids()) {
            const auto body = world_.body(id);
            observer_.show(state_, id.index, body.position_m.template cast<double>(),
                           body.velocity_mps.template cast<double>());
        }
    }

    const RunSettings& settings_;
    const Observer& observer_;
    Ticks ticks_;
    physics::World<Scalar> world_;
    RunState state_;
    RunResult result_;
};

}  // namespace

double RunResult::energy_error() const {
    const double change_j = energy_at_end_j - energy_at_start_j;
    return change_j == 0.0 ? 0.0 : change_j / energy_at_start_j;
}

double RunResult::momentum_error() const {
    const double change_ns = (momentum_at_end_ns - momentum_at_start_ns).norm();
    return change_ns == 0.0 ? 0.0 : change_ns / momentum_scale_ns;
}

double RunResult::ns_per_body_tick() const {
    return body_ticks > 0.0 ? 1e9 * stepping_s / body_ticks : 0.0;
}

double RunResult::collisions_per_s() const {
    const auto collisions = static_cast<double>(audit.ball_collisions + audit.wall_collisions);
    return stepping_s > 0.0 ? collisions / stepping_s : 0.0;
}

RunResult run(const physics::Scene& scene, const RunSettings& settings, const Observer& observer) {
    return settings.setting.scalar == physics::ScalarKind::kFloat
               ? RunInProgress<float>(scene, settings, observer).go()
               : RunInProgress<double>(scene, settings, observer).go();
}

}  // namespace fts::lab
