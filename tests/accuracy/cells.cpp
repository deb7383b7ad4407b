#include "tests/accuracy/cells.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "common/physics/world.h"
#include "server/lab/cost.h"
#include "server/lab/digits.h"
#include "tests/accuracy/study_scenes.h"

namespace fts::accuracy {
namespace {

using lab::KeepGoing;
using lab::Setting;
using physics::ScalarKind;
using physics::SolverKind;

constexpr double kCollisionsOfACell = 1000.0;
constexpr double kDriftSpeed = 0.1, kDivergenceSpeed = 0.1, kSizeSpeed = 0.1;
constexpr double kDriftCollisions = 1e5;
constexpr std::size_t kDriftBalls = 64;
constexpr double kCollisionsOfABallToDiverge = 60.0;

// The exact ones, of which there can be many in a tick, are what takes the time.
constexpr lab::SamplingLimits kSampling = {
    .collisions = 1000, .work_of_a_tick = 1e6, .work = 1.5e6, .work_of_reference = 6e6};

Json figure(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json accuracy_figures(const lab::Accuracy& accuracy) {
    const auto& local = accuracy.local;
    const auto& global = accuracy.global;
    return {{"E", figure(local.collision_error)},
            {"ignoring", figure(local.error_of_ignoring)},
            {"ticks", local.ticks},
            {"too_busy", local.ticks_too_busy},
            {"collisions", local.collisions},
            {"missed", figure(local.missed_per_1000())},
            {"extra", figure(local.extra_per_1000())},
            {"time", figure(local.time_error_ticks)},
            {"angle", figure(local.angle_error_deg)},
            {"depth", figure(global.penetration_over_r)},
            {"energy", figure(global.energy_error)},
            {"momentum", figure(global.momentum_error)},
            {"run_collisions", global.ball_collisions},
            {"finite", global.finite}};
}

// `seed` looks at every pair in every substep; where few collide it is given fewer ticks.
lab::Run run_for(const StudyScene& study, const Setting& setting) {
    constexpr std::size_t kMaxSubstepsOfSeed = 32'000;
    lab::Run run = study.run(kCollisionsOfACell);
    if (setting.solver.kind == SolverKind::kSeed) {
        run.ticks = std::min(run.ticks, kMaxSubstepsOfSeed / setting.solver.substeps);
    }
    return run;
}

Cell accuracy_cell(const std::string& scene, double speed, const Setting& setting) {
    return {accuracy_key(scene, speed, setting), [=](const KeepGoing& keep_going) -> Json {
                const StudyScene study = study_scene(scene, speed);
                const auto accuracy = lab::measure_accuracy(
                    study.scene, setting, run_for(study, setting), kSampling, nullptr, keep_going);
                return accuracy ? accuracy_figures(*accuracy) : Json(nullptr);
            }};
}

Json cost_figures(const StudyScene& study, const Setting& setting, const KeepGoing& keep_going) {
    const lab::Run run{static_cast<std::size_t>(1e6), kTickS};
    const auto cost = lab::measure_cost(study.scene, setting, run,
                                        {.repeats = 3, .seconds_of_a_repeat = 0.05}, keep_going);
    if (!cost) return nullptr;
    return {{"ns", cost->ns_per_body_tick},
            {"least", cost->least_ns},
            {"most", cost->most_ns},
            {"per_s", cost->collisions_per_s},
            {"ticks", cost->ticks}};
}

Cell cost_cell(const std::string& scene, double speed, const Setting& setting) {
    return {cost_key(scene, speed, setting), [=](const KeepGoing& keep_going) {
                return cost_figures(study_scene(scene, speed), setting, keep_going);
            }};
}

Cell size_cell(std::size_t balls, const Setting& setting) {
    return {size_key(balls, setting), [=](const KeepGoing& keep_going) {
                return cost_figures(medium_gas(balls, kSizeSpeed, 1), setting, keep_going);
            }};
}

template <typename Scalar>
Json drift_figures(const Setting& setting, const KeepGoing& keep_going) {
    const StudyScene study = medium_gas(kDriftBalls, kDriftSpeed, 3);
    physics::World<Scalar> world(study.scene, setting.solver);
    const double energy_j = world.kinetic_energy_j();
    const auto momentum_ns = world.momentum_ns();
    double momenta_ns = 0.0;
    for (const auto& body : study.scene.bodies) momenta_ns += body.velocity_mps.norm();
    Json points = Json::array();
    double next = 1.0;
    const std::size_t ticks = study.run(kDriftCollisions).ticks;
    for (std::size_t tick = 0; tick < ticks; ++tick) {
        if (!keep_going()) return nullptr;
        world.step(static_cast<Scalar>(kTickS));
        const auto collisions = static_cast<double>(world.audit().ball_collisions);
        if (collisions < next && tick + 1 < ticks) continue;
        const double energy_error = (world.kinetic_energy_j() - energy_j) / energy_j;
        const double momentum_error = (world.momentum_ns() - momentum_ns).norm() / momenta_ns;
        if (!std::isfinite(energy_error) || collisions == 0.0) break;
        points.push_back({collisions, energy_error, momentum_error});
        next = collisions * std::pow(10.0, 0.25);
    }
    return {{"points", points}};
}

Cell drift_cell(const Setting& setting) {
    return {drift_key(setting), [=](const KeepGoing& keep_going) {
                return setting.scalar == ScalarKind::kFloat
                           ? drift_figures<float>(setting, keep_going)
                           : drift_figures<double>(setting, keep_going);
            }};
}

// The true trajectories, which all solvers share. Empty when stopped.
std::optional<lab::Reference> true_trajectory(std::size_t balls, std::uint64_t seed,
                                              const StudyScene& study, const lab::Run& run,
                                              const KeepGoing& keep_going) {
    static std::mutex mutex;
    static std::map<std::pair<std::size_t, std::uint64_t>, lab::Reference> known;
    const std::lock_guard lock(mutex);
    const auto found = known.find({balls, seed});
    if (found != known.end()) return found->second;
    const auto reference = lab::reference_of(study.scene, run, kSampling, keep_going);
    if (reference) known[{balls, seed}] = *reference;
    return reference;
}

Cell divergence_cell(std::size_t balls, std::uint64_t seed, const Setting& setting) {
    return {divergence_key(balls, seed, setting), [=](const KeepGoing& keep_going) -> Json {
                const StudyScene study = medium_gas(balls, kDivergenceSpeed, seed);
                const lab::Run run =
                    study.run(0.5 * kCollisionsOfABallToDiverge * static_cast<double>(balls));
                lab::SamplingLimits limits = kSampling;
                limits.work = 0.0;  // of single ticks, which do not matter here
                const auto reference = true_trajectory(balls, seed, study, run, keep_going);
                if (!reference) return nullptr;
                const auto accuracy = lab::measure_accuracy(study.scene, setting, run, limits,
                                                            &*reference, keep_going);
                if (!accuracy || !accuracy->global.divergence) return nullptr;
                return {{"collisions", accuracy->global.divergence->collisions},
                        {"reached", accuracy->global.divergence->reached}};
            }};
}

}  // namespace

const std::vector<double>& speeds() {
    static const std::vector<double> kSpeeds = {1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0, 3.0, 10.0};
    return kSpeeds;
}

const std::vector<double>& coarse_speeds() {
    static const std::vector<double> kSpeeds = {0.01, 0.1, 1.0};
    return kSpeeds;
}

const std::vector<std::uint32_t>& substeps() {
    static const std::vector<std::uint32_t> kSubsteps = {1, 2, 4, 8, 16};
    return kSubsteps;
}

std::vector<Setting> all_settings() {
    std::vector<Setting> settings;
    for (const ScalarKind scalar : {ScalarKind::kDouble, ScalarKind::kFloat}) {
        for (const SolverKind kind : {SolverKind::kSeed, SolverKind::kDiscrete}) {
            for (const std::uint32_t count : substeps())
                settings.push_back({{kind, count}, scalar});
        }
        settings.push_back({{SolverKind::kSwept, 1}, scalar});
        settings.push_back({{SolverKind::kEvent, 1}, scalar});
    }
    return settings;
}

std::vector<Setting> drift_settings() {
    return {{{SolverKind::kSeed, 1}, ScalarKind::kDouble},
            {{SolverKind::kSeed, 16}, ScalarKind::kDouble},
            {{SolverKind::kDiscrete, 1}, ScalarKind::kDouble},
            {{SolverKind::kDiscrete, 16}, ScalarKind::kDouble},
            {{SolverKind::kDiscrete, 1}, ScalarKind::kFloat},
            {{SolverKind::kSwept, 1}, ScalarKind::kDouble},
            {{SolverKind::kSwept, 1}, ScalarKind::kFloat},
            {{SolverKind::kEvent, 1}, ScalarKind::kDouble},
            {{SolverKind::kEvent, 1}, ScalarKind::kFloat}};
}

std::vector<Setting> divergence_settings() {
    return {{{SolverKind::kSeed, 1}, ScalarKind::kDouble},
            {{SolverKind::kDiscrete, 1}, ScalarKind::kDouble},
            {{SolverKind::kDiscrete, 16}, ScalarKind::kDouble},
            {{SolverKind::kSwept, 1}, ScalarKind::kDouble},
            {{SolverKind::kSwept, 1}, ScalarKind::kFloat},
            {{SolverKind::kEvent, 1}, ScalarKind::kDouble},
            {{SolverKind::kEvent, 1}, ScalarKind::kFloat}};
}

std::vector<Setting> size_settings() {
    return {{{SolverKind::kSeed, 1}, ScalarKind::kDouble},
            {{SolverKind::kDiscrete, 1}, ScalarKind::kDouble},
            {{SolverKind::kDiscrete, 1}, ScalarKind::kFloat},
            {{SolverKind::kSwept, 1}, ScalarKind::kDouble},
            {{SolverKind::kEvent, 1}, ScalarKind::kDouble}};
}

const std::vector<std::size_t>& divergence_sizes() {
    static const std::vector<std::size_t> kSizes = {4, 8, 16, 32, 64, 128, 256};
    return kSizes;
}

const std::vector<std::size_t>& cost_sizes() {
    static const std::vector<std::size_t> kSizes = {10, 30, 100, 300, 1000, 3000, 10000};
    return kSizes;
}

std::string accuracy_key(const std::string& scene, double speed, const Setting& setting) {
    return "accuracy, " + scene + ", " + lab::with_digits("%.4g", speed) + " r/tick, " +
           to_string(setting);
}
std::string cost_key(const std::string& scene, double speed, const Setting& setting) {
    return "cost, " + scene + ", " + lab::with_digits("%.4g", speed) + " r/tick, " +
           to_string(setting);
}
std::string drift_key(const Setting& setting) {
    return "drift, " + to_string(setting);
}
std::string divergence_key(std::size_t balls, std::uint64_t seed, const Setting& setting) {
    return "divergence, " + std::to_string(balls) + " balls, seed " + std::to_string(seed) + ", " +
           to_string(setting);
}
std::string size_key(std::size_t balls, const Setting& setting) {
    return "size, " + std::to_string(balls) + " balls, " + to_string(setting);
}

StudyCells all_cells() {
    StudyCells cells;
    // `seed`, which takes longest, last.
    std::vector<Setting> settings = all_settings();
    std::stable_partition(settings.begin(), settings.end(), [](const Setting& setting) {
        return setting.solver.kind != SolverKind::kSeed;
    });
    for (const Setting& setting : settings) {
        for (const double speed : speeds()) {
            cells.accuracy.push_back(accuracy_cell("gas-medium", speed, setting));
            cells.accuracy.push_back(accuracy_cell(pairs_name(0.5), speed, setting));
            cells.cost.push_back(cost_cell("gas-medium", speed, setting));
        }
        for (const double speed : coarse_speeds()) {
            for (const char* scene : {"gas-dilute", "gas-dense", "heavy-light", "rack"}) {
                cells.accuracy.push_back(accuracy_cell(scene, speed, setting));
            }
        }
        for (const double ratio : mass_ratios()) {
            const std::string scene = pairs_of_mass_name(ratio);
            cells.accuracy.push_back(accuracy_cell(scene, kExtremesSpeed, setting));
        }
        for (const double radii : offsets_radii()) {
            const std::string scene = pairs_off_name(radii);
            cells.accuracy.push_back(accuracy_cell(scene, kExtremesSpeed, setting));
        }
        for (const double parameter : impact_parameters()) {
            if (parameter != 0.5) {
                cells.accuracy.push_back(accuracy_cell(pairs_name(parameter), 0.1, setting));
            }
        }
    }
    for (const Setting& setting : drift_settings()) cells.accuracy.push_back(drift_cell(setting));
    for (const std::size_t balls : divergence_sizes()) {
        for (std::uint64_t seed = 1; seed <= kDivergenceSeeds; ++seed) {
            for (const Setting& setting : divergence_settings()) {
                cells.accuracy.push_back(divergence_cell(balls, seed, setting));
            }
        }
    }
    for (const std::size_t balls : cost_sizes()) {
        for (const Setting& setting : size_settings()) {
            if (setting.solver.kind == SolverKind::kSeed && balls > 1000) continue;
            cells.cost.push_back(size_cell(balls, setting));
        }
    }
    return cells;
}

}  // namespace fts::accuracy
