#include "server/lab/exact_tick.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/physics/periodic.h"
#include "common/physics/solver.h"

namespace fts::lab {
namespace {

using physics::BodyDef;
using physics::Scene;
using physics::Vec2d;

// Beyond round-off, so that what just touches is looked at in full precision.
constexpr double kReachSlack = 1e-9;

std::optional<physics::Model<double>::Box> periodic_box(const Scene& scene) {
    if (!scene.periodic) return std::nullopt;
    return physics::Model<double>::Box{scene.periodic->min_m, scene.periodic->max_m};
}

class Groups {
  public:
    Groups(const Scene& scene, double span_s, double max_work)
        : scene_(scene), box_(periodic_box(scene)), span_s_(span_s), work_left_(max_work) {
        const std::size_t count = scene.bodies.size();
        parent_.resize(count);
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
        paths_.resize(count);
        contacts_.resize(count);
        dirty_.assign(count, false);
        velocity_after_mps_.resize(count);
        const double kept = std::exp(-scene.drag_per_s * span_s);
        for (std::size_t i = 0; i < count; ++i) {
            velocity_after_mps_[i] = scene.bodies[i].velocity_mps * kept;
        }
    }

    std::optional<ExactTick> run() {
        group_by_straight_paths();
        while (anything_dirty()) {
            if (!ask_oracle()) return std::nullopt;
            join_what_came_near();
        }
        ExactTick tick{std::move(velocity_after_mps_), {}, work_};
        for (auto& of_group : contacts_) {
            tick.contacts.insert(tick.contacts.end(), of_group.begin(), of_group.end());
        }
        std::stable_sort(
            tick.contacts.begin(), tick.contacts.end(),
            [](const OracleContact& a, const OracleContact& b) { return a.time_s < b.time_s; });
        return tick;
    }

  private:
    // Where a body's centre is during the tick; not wrapped in a periodic box.
    struct Path {
        Vec2d min_m, max_m;
        bool bent = false;
        void reach(const Vec2d& place) {
            min_m = min_m.cwiseMin(place);
            max_m = max_m.cwiseMax(place);
        }
    };

    // How far a body goes in a time, in units of its velocity at the start.
    double flight_s(double time_s) const {
        const double drag = scene_.drag_per_s;
        return drag > 0.0 ? -std::expm1(-drag * time_s) / drag : time_s;
    }

    std::size_t root(std::size_t i) const {
        while (parent_[i] != i) i = parent_[i];
        return i;
    }
    // The lower number stays the root.
    void join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
        contacts_[std::max(a, b)].clear();
        dirty_[std::max(a, b)] = false;
        dirty_[std::min(a, b)] = true;
    }
    bool anything_dirty() const {
        return std::find(dirty_.begin(), dirty_.end(), true) != dirty_.end();
    }

    void group_by_straight_paths();
    bool meet_on_straight_paths(const BodyDef& a, const BodyDef& b) const;
    bool paths_come_near(std::size_t i, std::size_t j) const;
    bool ask_oracle();
    bool ask_oracle_of(const std::vector<std::size_t>& members);
    void join_what_came_near();

    const Scene& scene_;
    const std::optional<physics::Model<double>::Box> box_;
    const double span_s_;
    double work_left_, work_ = 0.0;
    std::vector<std::size_t> parent_;
    std::vector<bool> dirty_;  // by root: the oracle is to be asked
    std::vector<Path> paths_;
    std::vector<std::vector<OracleContact>> contacts_;  // by root
    std::vector<Vec2d> velocity_after_mps_;
};

bool Groups::meet_on_straight_paths(const BodyDef& a, const BodyDef& b) const {
    const Vec2d start = physics::nearest_image<double>(a.position_m - b.position_m, box_);
    const Vec2d move = (a.velocity_mps - b.velocity_mps) * flight_s(span_s_);
    const double reach = (a.radius_m + b.radius_m) * (1.0 + kReachSlack);
    const double length = move.squaredNorm();
    const double nearest = length > 0.0 ? std::clamp(-start.dot(move) / length, 0.0, 1.0) : 0.0;
    if ((start + nearest * move).squaredNorm() <= reach * reach) return true;
    if (!box_) return false;
    // Another image may come nearer to what moves far.
    const Vec2d extent = box_->extent_m();
    return (move.cwiseAbs().array() + reach >= extent.array() - start.cwiseAbs().array()).any();
}

void Groups::group_by_straight_paths() {
    const std::size_t count = scene_.bodies.size();
    for (std::size_t i = 0; i < count; ++i) {
        const BodyDef& body = scene_.bodies[i];
        const Vec2d end = body.position_m + body.velocity_mps * flight_s(span_s_);
        paths_[i] = {body.position_m.cwiseMin(end), body.position_m.cwiseMax(end), false};
        if (scene_.walls && std::isfinite(body.mass_kg)) {
            const Vec2d room = Vec2d::Constant(body.radius_m * (1.0 + kReachSlack));
            const bool inside =
                ((paths_[i].min_m - room).array() > scene_.walls->min_m.array()).all() &&
                ((paths_[i].max_m + room).array() < scene_.walls->max_m.array()).all();
            if (!inside) dirty_[i] = true;
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i + 1; j < count; ++j) {
            if (!paths_come_near(i, j)) continue;
            if (meet_on_straight_paths(scene_.bodies[i], scene_.bodies[j])) join(i, j);
        }
    }
}

bool Groups::paths_come_near(std::size_t i, std::size_t j) const {
    const double reach =
        (scene_.bodies[i].radius_m + scene_.bodies[j].radius_m) * (1.0 + kReachSlack);
    const Path &a = paths_[i], &b = paths_[j];
    const Vec2d half = (a.max_m - a.min_m + b.max_m - b.min_m) / 2;
    const Vec2d apart =
        physics::nearest_image<double>((a.min_m + a.max_m - b.min_m - b.max_m) / 2, box_);
    return ((apart.cwiseAbs() - half).array() <= reach).all();
}

bool Groups::ask_oracle() {
    std::vector<std::vector<std::size_t>> members(parent_.size());
    for (std::size_t i = 0; i < parent_.size(); ++i) {
        if (dirty_[root(i)]) members[root(i)].push_back(i);
    }
    for (std::size_t i = 0; i < parent_.size(); ++i) {
        if (!dirty_[i]) continue;
        if (!ask_oracle_of(members[i])) return false;
        dirty_[i] = false;
    }
    return true;
}

bool Groups::ask_oracle_of(const std::vector<std::size_t>& members) {
    Scene group = scene_;
    group.bodies.clear();
    for (const std::size_t i : members) group.bodies.push_back(scene_.bodies[i]);
    const auto size = static_cast<double>(members.size());
    const double pairs = 0.5 * size * (size + 1.0);
    const double events_left = std::min((work_left_ - pairs) / (2.0 * size), 1e7);
    if (events_left < 1.0) return false;
    Oracle oracle(group);
    if (!oracle.advance(span_s_, static_cast<std::size_t>(events_left))) return false;
    const double work = pairs + 2.0 * size * static_cast<double>(oracle.contacts().size());
    work_left_ -= work;
    work_ += work;

    const auto after = oracle.bodies();
    std::vector<Vec2d> place(members.size()), velocity(members.size());
    std::vector<double> since_s(members.size(), 0.0);
    for (std::size_t k = 0; k < members.size(); ++k) {
        place[k] = group.bodies[k].position_m;
        velocity[k] = group.bodies[k].velocity_mps;
        paths_[members[k]] = {place[k], place[k], false};
        velocity_after_mps_[members[k]] = after[k].velocity_mps;
    }
    const auto fly = [&](std::size_t k, double until_s) {
        place[k] += velocity[k] * flight_s(until_s - since_s[k]);
        since_s[k] = until_s;
        paths_[members[k]].reach(place[k]);
    };
    auto& contacts = contacts_[members.front()];
    contacts.clear();
    for (OracleContact contact : oracle.contacts()) {
        fly(contact.a, contact.time_s);
        velocity[contact.a] = contact.velocity_a_after_mps;
        paths_[members[contact.a]].bent = true;
        if (contact.b) {
            fly(*contact.b, contact.time_s);
            velocity[*contact.b] = contact.velocity_b_after_mps;
            paths_[members[*contact.b]].bent = true;
            contact.b = members[*contact.b];
        }
        contact.a = members[contact.a];
        contacts.push_back(contact);
    }
    for (std::size_t k = 0; k < members.size(); ++k) fly(k, span_s_);
    return true;
}

// Two straight paths of different groups have been looked at already.
void Groups::join_what_came_near() {
    for (std::size_t i = 0; i < paths_.size(); ++i) {
        if (!paths_[i].bent) continue;
        for (std::size_t j = 0; j < paths_.size(); ++j) {
            if (root(i) != root(j) && paths_come_near(i, j)) join(i, j);
        }
    }
}

}  // namespace

std::optional<ExactTick> exact_tick(const Scene& scene, double span_s, double max_work) {
    return Groups(scene, span_s, max_work).run();
}

}  // namespace fts::lab
