#include "server/lab/true_paths.h"

namespace fts::lab {
namespace {

std::vector<physics::Vec2d> places_of(const physics::World<double>& world) {
    std::vector<physics::Vec2d> places_m;
    for (const physics::BodyId id : world.ids()) places_m.push_back(world.body(id).position_m);
    return places_m;
}

struct Turn {  // where a ball's path has a knot
    double time_s;
    physics::Vec2d position_m;
};

physics::Vec2d place_at(const std::vector<Turn>& turns, double time_s) {
    std::size_t next = 1;
    while (next + 1 < turns.size() && turns[next].time_s <= time_s) ++next;
    const Turn &a = turns[next - 1], &b = turns[next];
    if (b.time_s <= a.time_s) return b.position_m;
    const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
    return a.position_m + share * (b.position_m - a.position_m);
}

}  // namespace

void TruePaths::before_tick(const physics::World<double>& world) {
    start_m_ = places_of(world);
}

void TruePaths::after_tick(const physics::World<double>& world, double tick_s) {
    std::vector<std::vector<Turn>> turns(start_m_.size());
    for (std::size_t i = 0; i < start_m_.size(); ++i) turns[i].push_back({0.0, start_m_[i]});
    for (const physics::Contact<double>& contact : world.contacts()) {
        turns[contact.a.index].push_back({contact.time_s, contact.position_a_m});
        if (contact.b) turns[contact.b->index].push_back({contact.time_s, contact.position_b_m});
    }
    const std::vector<physics::Vec2d> end_m = places_of(world);
    for (std::size_t i = 0; i < end_m.size(); ++i) turns[i].push_back({tick_s, end_m[i]});
    for (std::size_t frame = 0; frame < frames_per_tick_; ++frame) {
        std::vector<physics::Vec2d>& places_m = frames_.emplace_back();
        for (const auto& of_ball : turns) {
            places_m.push_back(place_at(of_ball, tick_of(frame) * tick_s));
        }
    }
}

}  // namespace fts::lab
