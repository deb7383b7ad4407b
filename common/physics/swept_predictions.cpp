#include <algorithm>
#include <cmath>
#include <limits>

#include "common/physics/solver_swept.h"
#include "common/physics/swept_engine.h"
#include "common/physics/time_of_impact.h"

namespace fts::physics {
namespace {

// By how many units of round-off a swept box is larger than what it must hold.
constexpr double kBoxSlack = 8.0;

// Before there are so many, a stray more is reason enough to fit their grid anew.
constexpr std::size_t kFirstStrays = 8;

// A part of the span: what is not due within that after the end of a look is not due in it.
template <typename Scalar>
constexpr Scalar kWallSlack = Scalar(16) * std::numeric_limits<Scalar>::epsilon();

// So that round-off does not matter where many are left out together.
template <typename Scalar>
constexpr Scalar kWiderThanRoundOff = Scalar(1.01);

}  // namespace

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_everybody() {
    paths_.begin(*bodies_, places(), model_->equal_radii, seen_until_s_ - from_s_);
    strays_.assign(paths_.strays().begin(), paths_.strays().end());
    if constexpr (!Space::kHasImages) begin_sights();
    if (!is_first_look_) {
        paths_.for_each_pair([&](std::uint32_t a, std::uint32_t b) {
            predict_pair(std::min(a, b), std::max(a, b), Image{});
        });
    } else if (model_->equal_radii) {
        predict_pairs<true>();
    } else {
        predict_pairs<false>();
    }
    predict_images();
    predict_strays();
    if (model_->walls) predict_all_walls();
    if (model_->platform) {
        for (const BodyId id : bodies_->ids) predict_fall(id.index);
    }
}

// Of those that are no strays: within which distance they may touch, and who keeps off all walls.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::begin_sights() {
    constexpr Scalar kInfinite = std::numeric_limits<Scalar>::infinity();
    const Scalar radius = paths_.largest_radius_m(), look_s = seen_until_s_ - from_s_;
    const Scalar way =
        paths_.longest_way_turned_m() * (look_s > Scalar(0) ? span_s_ / look_s : Scalar(1));
    const Scalar tolerance = touch_tolerance_m(Scalar(2) * radius, paths_.farthest_m() + way);
    const Scalar margin =
        kWiderThanRoundOff<Scalar> * radius + tolerance + kWallSlack<Scalar> * way;
    Box<Scalar> inside = {-kInfinite, -kInfinite, kInfinite, kInfinite};
    if (model_->walls) {
        const Vec &low = model_->walls->min_m, &high = model_->walls->max_m;
        inside = {low.x() + margin, low.y() + margin, high.x() - margin, high.y() - margin};
    }
    paths_.begin_sights(tolerance, inside);
}

// Where everybody is when the look begins.
template <typename Scalar, typename Space>
auto SweptEngine<Scalar, Space>::places() -> std::span<const Vec> {
    if (is_first_look_) return bodies_->position_m;
    places_.resize(bodies_->slots());
    for (const BodyId id : bodies_->ids) places_[id.index] = position_at(id.index, from_s_);
    return places_;
}

// Only who starts near a wall may reach it.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_all_walls() {
    const Scalar margin =
        kWiderThanRoundOff<Scalar> * (paths_.longest_way_m() + paths_.largest_radius_m());
    const auto predict_one = [&](std::uint32_t body) {
        if (!is_immovable(body)) predict_walls<false>(body);
    };
    const auto& walls = *model_->walls;
    paths_.for_each_outside({walls.min_m.x() + margin, walls.min_m.y() + margin,
                             walls.max_m.x() - margin, walls.max_m.y() - margin},
                            predict_one);
    for (const std::uint32_t body : strays_) predict_one(body);
}

// Nothing has happened to anybody yet: positions are those of now, and there are no partners.
template <typename Scalar, typename Space>
template <bool kEqualRadii>
void SweptEngine<Scalar, Space>::predict_pairs() {
    const Bodies<Scalar>& all = *bodies_;
    const Scalar twice_radius =
        kEqualRadii && !all.ids.empty() ? Scalar(2) * all.radius_m[all.ids[0].index] : Scalar(0);
    const bool any_immovable = !model_->equal_masses;
    paths_.for_each_pair([&](std::uint32_t a, std::uint32_t b) {
        if (any_immovable && is_immovable(a) && is_immovable(b)) return;
        const Scalar reach = kEqualRadii ? twice_radius : all.radius_m[a] + all.radius_m[b];
        const Vec &at_a = all.position_m[a], &at_b = all.position_m[b];
        const Vec &of_a = all.velocity_mps[a], &of_b = all.velocity_mps[b];
        const Scalar wait_s =
            time_until_contact<Scalar>({at_a.x() - at_b.x(), at_a.y() - at_b.y()},
                                       {of_a.x() - of_b.x(), of_a.y() - of_b.y()}, reach);
        expect_meeting(now_s_ + wait_s, a, b);
    });
}

// A pair by way of an image of the one is that by way of the opposite image of the other, and is
// looked for once.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_images() {
    if constexpr (Space::kHasImages) {
        const Scalar margin =
            kWiderThanRoundOff<Scalar> * (paths_.longest_way_m() + paths_.largest_radius_m());
        Box<Scalar> where = space_.box();
        if (!is_first_look_) {
            for (const BodyId id : bodies_->ids) {
                const Vec& place = places_[id.index];
                where = {std::min(where.min_x_m, place.x()), std::min(where.min_y_m, place.y()),
                         std::max(where.max_x_m, place.x()), std::max(where.max_y_m, place.y())};
            }
        }
        space_.cover_only({where.min_x_m - margin, where.min_y_m - margin, where.max_x_m + margin,
                           where.max_y_m + margin});
        const Box<Scalar> inside = space_.without_images(kWiderThanRoundOff<Scalar> * margin);
        paths_.for_each_outside(inside, [&](std::uint32_t body) {
            const Path path = path_of(body);
            space_.for_each_image(swept_box(body), [&](const Box<Scalar>&, Image image) {
                if (!image.is_upper()) return;
                Path moved = path;
                moved.position_m = space_.moved(path.position_m, image);
                paths_.for_each_meeting(paths_.course_of(moved), [&](std::uint32_t other) {
                    if (other == body) return;
                    predict_pair(std::min(body, other), std::max(body, other),
                                 body < other ? image : -image);
                });
            });
        });
    }
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_strays() {
    fit_strays();
    for (const std::uint32_t body : strays_) space_.cover(swept_box(body));
    for (const std::uint32_t body : strays_) {
        predict_meetings<false>(body, course_of(body));
        strays_near_.place(body, swept_box(body));
    }
}

template <typename Scalar, typename Space>
template <bool kAfterSet>
void SweptEngine<Scalar, Space>::predict(std::uint32_t body, const Course& course) {
    predict_meetings<kAfterSet>(body, course);
    if (model_->walls && !is_immovable(body)) predict_walls<kAfterSet>(body);
    if (model_->platform) predict_fall(body);
}

template <typename Scalar, typename Space>
template <bool kAfterSet>
void SweptEngine<Scalar, Space>::predict_meetings(std::uint32_t body, const Course& course) {
    const bool is_stray = paths_.is_stray(body), any_strays = !strays_.empty();
    const Box<Scalar> box = Space::kHasImages || any_strays ? swept_box(body) : Box<Scalar>{};
    space_.for_each_image(box, [&](const Box<Scalar>& moved_box, Image image) {
        const auto meet = [&](std::uint32_t other) {
            if (other == body || !bodies_->alive[other]) return;
            const std::uint32_t a = std::min(body, other), b = std::max(body, other);
            const Image of_a = a == body ? image : -image;
            if (kAfterSet && set_.keeps_apart(a, b, separation_now(a, b, of_a))) {
                return keep({a, b, of_a, known_[a].count, known_[b].count});
            }
            predict_pair(a, b, of_a);
        };
        if (any_strays) strays_near_.for_each_near(body, moved_box, meet);
        if (is_stray) return paths_.for_each_in(moved_box, now_s_ - from_s_, meet);
        if constexpr (Space::kHasImages) {
            Path moved = path_of(body);
            moved.position_m = space_.moved(moved.position_m, image);
            paths_.for_each_meeting(paths_.course_of(moved), meet);
        } else {
            paths_.for_each_meeting(course, meet);
        }
    });
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_pair(std::uint32_t a, std::uint32_t b, Image image) {
    if (known_[a].partner == Partner{b, image} && known_[b].partner == Partner{a, image}) return;
    if (!model_->equal_masses && is_immovable(a) && is_immovable(b)) return;
    if (is_kept({a, b, image, known_[a].count, known_[b].count})) return;
    const Scalar known_s = std::max(known_[a].time_s, known_[b].time_s);
    const Vec at_a = space_.moved(position_at(a, known_s), image), at_b = position_at(b, known_s);
    const Vec separation(at_a.x() - at_b.x(), at_a.y() - at_b.y());
    const Vec &of_a = bodies_->velocity_mps[a], &of_b = bodies_->velocity_mps[b];
    const Vec velocity(of_a.x() - of_b.x(), of_a.y() - of_b.y());
    const Scalar reach = bodies_->radius_m[a] + bodies_->radius_m[b];
    expect({known_s + time_until_contact(separation, velocity, reach), EventKind::kBall, a, b,
            known_[a].count, known_[b].count, image});
}

template <typename Scalar, typename Space>
template <bool kAfterSet>
void SweptEngine<Scalar, Space>::predict_walls(std::uint32_t body) {
    const Scalar known_s = known_[body].time_s;
    const Scalar left_s = seen_until_s_ - known_s + kWallSlack<Scalar> * span_s_;
    const Vec& position = bodies_->position_m[body];
    const Vec& velocity = bodies_->velocity_mps[body];
    const Scalar radius = bodies_->radius_m[body];
    const Vec way(std::abs(velocity.x()) * left_s, std::abs(velocity.y()) * left_s);
    if (keeps_off_walls(position, radius, way)) [[likely]]
        return;
    const auto look_at = [&](std::uint32_t side, Scalar gap, Scalar closing_mps) {
        if (gap > closing_mps * left_s) return;
        const Hold hold = {body, kWallHold + side, Image{}, known_[body].count, 0};
        if (kAfterSet && set_.keeps_off_wall(body, side)) return keep(hold);
        if (is_kept(hold)) return;
        expect({known_s + time_until_wall(gap, closing_mps), EventKind::kWall, body, side,
                known_[body].count, 0});
    };
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        const Scalar below = position[axis] - (model_->walls->min_m[axis] + radius);
        const Scalar above = (model_->walls->max_m[axis] - radius) - position[axis];
        look_at(2 * axis, below, -velocity[axis]);
        look_at(2 * axis + 1, above, velocity[axis]);
    }
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_fall(std::uint32_t body) {
    const Scalar known_s = known_[body].time_s;
    const Vec& position = bodies_->position_m[body];
    const Vec& velocity = bodies_->velocity_mps[body];
    const Vec way = velocity.cwiseAbs() * (seen_until_s_ - known_s);
    if (surely_stays<Scalar>(*model_->platform, position, way)) return;
    const Scalar time = time_until_edge<Scalar>(*model_->platform, position, velocity);
    expect({known_s + time, EventKind::kFall, body, 0, known_[body].count, 0});
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::expect(const Happening& event) {
    if (is_seen(event.time_s)) queue_.push(event);
}

// Of the two themselves, not of an image.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::expect_meeting(Scalar time_s, std::uint32_t one,
                                                std::uint32_t other) {
    if (!is_seen(time_s)) return;
    const std::uint32_t a = std::min(one, other), b = std::max(one, other);
    queue_.push({time_s, EventKind::kBall, a, b, known_[a].count, known_[b].count, {}});
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::place(std::uint32_t body, const Course& course) {
    const bool was_stray = paths_.is_stray(body);
    if (paths_.follow(body, course)) {
        if constexpr (Space::kHasImages) space_.cover(swept_box(body));
        return;
    }
    const Box<Scalar> box = swept_box(body);
    space_.cover(box);
    if (was_stray) return strays_near_.place(body, box);
    strays_.push_back(body);
    if (strays_.size() >= kFirstStrays && strays_.size() < 2 * fitted_strays_) {
        return strays_near_.place(body, box);
    }
    fit_strays();
    for (const std::uint32_t stray : strays_) strays_near_.place(stray, swept_box(stray));
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::fit_strays() {
    boxes_.clear();
    std::erase_if(strays_, [&](std::uint32_t body) { return bodies_->alive[body] == 0; });
    for (const std::uint32_t body : strays_) boxes_.push_back(swept_box(body));
    fitted_strays_ = strays_.size();
    if (!strays_.empty()) strays_near_.begin(boxes_, bodies_->slots());
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::place_and_predict(std::uint32_t body) {
    shorten_stretch(body);
    const Course course = course_of(body);
    place(body, course);
    predict<false>(body, course);
}

// Of two that have hit: as they were seen.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::follow_and_predict(std::uint32_t a, std::uint32_t b) {
    paths_.follow(sight_);
    for (std::size_t i = 0; i < sight_.count; ++i) {
        predict_from_now(sight_.meetings[i].one, sight_.meetings[i].other);
    }
    for (const std::uint32_t body : {a, b}) {
        if (!strays_.empty()) {
            strays_near_.for_each_near(body, swept_box(body), [&](std::uint32_t other) {
                if (bodies_->alive[other]) predict_from_now(body, other);
            });
        }
        if (model_->walls && !sight_.keep_inside) predict_walls<false>(body);
        if (model_->platform) predict_fall(body);
    }
}

// As predict_pair, of one that has just hit a third: it can move, it is where it is now, and
// nothing that was kept, and no partner, is the other one.
template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::predict_from_now(std::uint32_t body, std::uint32_t other) {
    const Vec at = position_at(other, now_s_);
    const Vec& from = bodies_->position_m[body];
    const Vec &of_a = bodies_->velocity_mps[body], &of_b = bodies_->velocity_mps[other];
    const Scalar wait_s = time_until_contact<Scalar>(
        {from.x() - at.x(), from.y() - at.y()}, {of_a.x() - of_b.x(), of_a.y() - of_b.y()},
        bodies_->radius_m[body] + bodies_->radius_m[other]);
    expect_meeting(now_s_ + wait_s, body, other);
}

template <typename Scalar, typename Space>
void SweptEngine<Scalar, Space>::place_and_predict_set() {
    for (const std::uint32_t body : set_.hit_bodies()) shorten_stretch(body);
    for (const std::uint32_t body : set_.hit_bodies()) place(body, course_of(body));
    for (const std::uint32_t body : set_.hit_bodies()) predict<true>(body, course_of(body));
}

template <typename Scalar, typename Space>
Box<Scalar> SweptEngine<Scalar, Space>::swept_box(std::uint32_t body) const {
    const Vec from = position_at(body, now_s_);
    const Vec to = position_at(body, seen_until_s_);
    const Scalar radius = bodies_->radius_m[body];
    const Scalar extent = std::max(std::abs(from.x()), std::abs(from.y())) +
                          std::max(std::abs(to.x()), std::abs(to.y())) + radius;
    const Scalar reach =
        radius + static_cast<Scalar>(kBoxSlack) * std::numeric_limits<Scalar>::epsilon() * extent;
    return {std::min(from.x(), to.x()) - reach, std::min(from.y(), to.y()) - reach,
            std::max(from.x(), to.x()) + reach, std::max(from.y(), to.y()) + reach};
}

template void SweptEngine<double, OpenSpace<double>>::predict_everybody();
template void SweptEngine<double, OpenSpace<double>>::place_and_predict(std::uint32_t);
template void SweptEngine<double, OpenSpace<double>>::follow_and_predict(std::uint32_t,
                                                                         std::uint32_t);
template void SweptEngine<double, OpenSpace<double>>::place_and_predict_set();
template void SweptEngine<float, OpenSpace<float>>::predict_everybody();
template void SweptEngine<float, OpenSpace<float>>::place_and_predict(std::uint32_t);
template void SweptEngine<float, OpenSpace<float>>::follow_and_predict(std::uint32_t,
                                                                       std::uint32_t);
template void SweptEngine<float, OpenSpace<float>>::place_and_predict_set();
template void SweptEngine<double, TorusSpace<double>>::predict_everybody();
template void SweptEngine<double, TorusSpace<double>>::place_and_predict(std::uint32_t);
template void SweptEngine<double, TorusSpace<double>>::follow_and_predict(std::uint32_t,
                                                                          std::uint32_t);
template void SweptEngine<double, TorusSpace<double>>::place_and_predict_set();
template void SweptEngine<float, TorusSpace<float>>::predict_everybody();
template void SweptEngine<float, TorusSpace<float>>::place_and_predict(std::uint32_t);
template void SweptEngine<float, TorusSpace<float>>::follow_and_predict(std::uint32_t,
                                                                        std::uint32_t);
template void SweptEngine<float, TorusSpace<float>>::place_and_predict_set();

}  // namespace fts::physics
