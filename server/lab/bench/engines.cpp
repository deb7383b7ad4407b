#include <algorithm>
#include <cassert>
#include <functional>
#include <utility>

#include "common/physics/world.h"
#include "server/lab/bench/engine.h"
#include "server/lab/bench/memory_pass.h"
#ifdef FTS_BOX2D
#include "server/lab/peers/box2d_engine.h"
#endif
#ifdef FTS_CHIPMUNK
#include "server/lab/peers/chipmunk_engine.h"
#endif

namespace fts::lab {
namespace {

using physics::Scene;
using physics::SolverKind;

template <typename Scalar>
class WorldEngine : public Engine {
  public:
    WorldEngine(const Scene& scene, SolverKind solver, double tick_s, bool is_read = true)
        : world_(scene, {solver, 1}), tick_s_(static_cast<Scalar>(tick_s)), is_read_(is_read) {}

    // A solver may keep positions to itself until one is asked for, which brings all up to date.
    // The peers have theirs at hand after every step, and a game reads them.
    void step() override {
        world_.step(tick_s_);
        if (is_read_ && world_.size() > 0) world_.position_m(world_.ids().front());
    }

    BallState ball(std::size_t i) const override {
        const auto body = world_.body(world_.ids()[i]);
        return {body.position_m.template cast<double>(), body.velocity_mps.template cast<double>()};
    }

    std::optional<std::uint64_t> collisions() const override {
        return world_.audit().ball_collisions + world_.audit().wall_collisions;
    }

  private:
    physics::World<Scalar> world_;
    Scalar tick_s_;
    bool is_read_;
};

using Maker = std::function<std::unique_ptr<Engine>(const Scene&, double tick_s)>;

struct Known {
    EngineInfo info;
    Maker make;
};

template <typename Scalar>
Known solver_engine(SolverKind kind, const std::string& scalar, std::size_t max_balls) {
    const std::string name(physics::to_string(kind));
    return {{.name = name + "-" + scalar, .title = name + " " + scalar, .max_balls = max_balls},
            [kind](const Scene& scene, double tick_s) {
                return std::make_unique<WorldEngine<Scalar>>(scene, kind, tick_s);
            }};
}

void add_solver(std::vector<Known>& all, SolverKind kind, std::size_t max_balls) {
    all.push_back(solver_engine<float>(kind, "float", max_balls));
    all.push_back(solver_engine<double>(kind, "double", max_balls));
}

void add_peers([[maybe_unused]] std::vector<Known>& all) {
#ifdef FTS_BOX2D
    all.push_back(
        {{.name = "box2d", .title = "Box2D", .max_balls = 100'000, .max_fast_balls = 10'000},
         [](const Scene& scene, double tick_s) {
             return make_box2d(scene, tick_s, Bullets::kNo);
         }});
    // Each time of impact looks at every contact again.
    all.push_back({{.name = "box2d-bullets",
                    .title = "Box2D, bullets",
                    .max_balls = 2'000,
                    .max_fast_balls = 200},
                   [](const Scene& scene, double tick_s) {
                       return make_box2d(scene, tick_s, Bullets::kYes);
                   }});
#endif
#ifdef FTS_CHIPMUNK
    all.push_back(
        {{.name = "chipmunk-hash", .title = "Chipmunk, spatial hash", .max_balls = 100'000},
         [](const Scene& scene, double tick_s) {
             return make_chipmunk(scene, tick_s, ChipmunkIndex::kSpatialHash);
         }});
    all.push_back({{.name = "chipmunk-tree", .title = "Chipmunk, box tree", .max_balls = 100'000},
                   [](const Scene& scene, double tick_s) {
                       return make_chipmunk(scene, tick_s, ChipmunkIndex::kBoxTree);
                   }});
#endif
}

const std::vector<Known>& known() {
    static const std::vector<Known> kAll = [] {
        std::vector<Known> all;
        add_solver(all, SolverKind::kDiscrete, physics::kMaxBodies);
        add_solver(all, SolverKind::kSwept, physics::kMaxBodies);
        add_solver(all, SolverKind::kEvent, physics::kMaxBodies);
        all.push_back({{.name = "event-double-unread",
                        .title = "event double, not read",
                        .is_only_by_name = true},
                       [](const Scene& scene, double tick_s) {
                           return std::make_unique<WorldEngine<double>>(scene, SolverKind::kEvent,
                                                                        tick_s, false);
                       }});
        add_solver(all, SolverKind::kSeed, 2'000);  // looks at every pair
        add_peers(all);
        all.push_back({{.name = "memory-float", .title = "memory, float", .is_floor = true},
                       make_memory_pass<float>});
        all.push_back({{.name = "memory-double", .title = "memory, double", .is_floor = true},
                       make_memory_pass<double>});
        return all;
    }();
    return kAll;
}

}  // namespace

const std::vector<EngineInfo>& engines() {
    static const std::vector<EngineInfo> kInfos = [] {
        std::vector<EngineInfo> infos;
        for (const Known& one : known()) infos.push_back(one.info);
        return infos;
    }();
    return kInfos;
}

const EngineInfo* find_engine(const std::string& name) {
    const auto& all = engines();
    const auto found = std::ranges::find(all, name, &EngineInfo::name);
    return found == all.end() ? nullptr : &*found;
}

std::unique_ptr<Engine> make_engine(const std::string& name, const Scene& scene, double tick_s) {
    for (const Known& one : known()) {
        if (one.info.name == name) return one.make(scene, tick_s);
    }
    assert(false && "no such engine in this build");
    return nullptr;
}

}  // namespace fts::lab
