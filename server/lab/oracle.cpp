#include "server/lab/oracle.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "server/lab/oracle_impl.h"

namespace fts::lab {
namespace {

// Boxes are larger by this part of all lengths that go into them.
constexpr double kBoxSlack = 1e-6;
// Time is cut so that most balls sweep past a few neighbours only, into so many slices at most.
constexpr double kMaxSlices = 4096.0;
constexpr std::size_t kFewBalls = 16;

}  // namespace

using oracle::kSides;

Oracle::Impl::Impl(const physics::Scene& scene) : rules(scene), drag(Quad(scene.drag_per_s)) {
    assert(!validate(scene, physics::Overlaps::kAccepted));
    assert(scene.restitution == 1.0 && !scene.platform);
    for (const physics::BodyDef& body : scene.bodies) {
        const bool heavy_for_ever = std::isinf(body.mass_kg);
        balls.push_back({quad_of(body.position_m), quad_of(body.velocity_mps), Quad(body.radius_m),
                         heavy_for_ever ? Quad(0) : Quad(body.mass_kg),
                         heavy_for_ever ? Quad(0) : Quad(1) / Quad(body.mass_kg)});
    }
    rules.bodies.clear();
    wrap_all();
    energy_at_start = energy();
    momentum_at_start = momentum();
}

bool Oracle::Impl::advance(double span_s, std::size_t max_events) {
    assert(std::isfinite(span_s) && span_s >= 0.0);
    contacts.clear();
    events_left = max_events;
    const Quad kept = decay_less_one(drag * Quad(span_s));
    const Quad span = drag > Quad(0) ? -kept / drag * slowed : Quad(span_s);
    slice_start = Quad(0);
    bool done = true;
    while (done && slice_start < span) {
        const Quad slice = slice_length(span - slice_start);
        done = run_slice(slice);
    }
    slowed *= Quad(1) - drag * slice_start / slowed;
    wrap_all();
    return done;
}

// In a periodic box nobody moves further than a quarter of it.
Quad Oracle::Impl::slice_length(Quad left) const {
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    double fastest = 0.0, squares = 0.0;
    for (const Ball& ball : balls) {
        const physics::Vec2d position = rounded(ball.position);
        for (int axis = 0; axis < 2; ++axis) {
            low[axis] = std::min(low[axis], position[axis]);
            high[axis] = std::max(high[axis], position[axis]);
        }
        const double speed = rounded(ball.velocity).norm();
        fastest = std::max(fastest, speed);
        squares += speed * speed;
    }
    double longest = static_cast<double>(left);
    if (balls.size() > kFewBalls && squares > 0.0) {
        const double number = static_cast<double>(balls.size());
        const double each = std::sqrt((high[0] - low[0]) * (high[1] - low[1]) / number);
        const double cut = each / std::sqrt(squares / number);
        longest = std::min(longest, std::max(cut, longest / kMaxSlices));
    }
    if (rules.periodic && fastest > 0.0) {
        const double width = (rules.periodic->max_m - rules.periodic->min_m).minCoeff();
        longest = std::min(longest, 0.2499 * width / fastest);
    }
    return Quad(longest) < left ? Quad(longest) : left;
}

bool Oracle::Impl::run_slice(Quad slice) {
    wrap_all();
    predict_all(slice);
    Quad now(0);
    bool done = true;
    while (!meetings.empty()) {
        const auto next =
            std::min_element(meetings.begin(), meetings.end(),
                             [](const Meeting& m, const Meeting& n) { return m.at < n.at; });
        if (events_left == 0) {
            done = false;
            break;
        }
        const Meeting meeting = *next;
        move_all(meeting.at - now);
        now = meeting.at;
        const std::vector<std::size_t> hit = resolve(meeting.touch, now);
        const auto is_hit = [&](std::size_t ball) {
            return std::find(hit.begin(), hit.end(), ball) != hit.end();
        };
        std::erase_if(meetings, [&](const Meeting& m) {
            return m.touch == meeting.touch || is_hit(m.touch.a) ||
                   (!m.touch.is_wall && is_hit(m.touch.b));
        });
        for (const std::size_t ball : hit) boxes[ball] = swept_box(ball, slice - now);
        for (const std::size_t ball : hit) predict(ball, now, slice, 0);
    }
    const Quad end = done ? slice : now;
    move_all(end - now);
    slice_start += end;
    return done;
}

void Oracle::Impl::predict_all(Quad slice) {
    meetings.clear();
    boxes.clear();
    for (std::size_t i = 0; i < balls.size(); ++i) boxes.push_back(swept_box(i, slice));
    for (std::size_t i = 0; i < balls.size(); ++i) predict(i, Quad(0), slice, i + 1);
}

// A pair of balls that were both hit is found twice, which does no harm.
void Oracle::Impl::predict(std::size_t ball, Quad now, Quad slice, std::size_t others_from) {
    for (std::size_t other = others_from; other < balls.size(); ++other) {
        if (other == ball) continue;
        const std::size_t a = std::min(ball, other), b = std::max(ball, other);
        if (!balls[a].is_movable() && !balls[b].is_movable()) continue;
        if (rules.periodic) {
            predict_images(a, b, now, slice);
            continue;
        }
        const Box& p = boxes[a];
        const Box& q = boxes[b];
        if (p.min[0] <= q.max[0] && q.min[0] <= p.max[0] && p.min[1] <= q.max[1] &&
            q.min[1] <= p.max[1]) {
            predict_pair(a, b, now, slice);
        }
    }
    if (rules.walls && balls[ball].is_movable()) predict_walls(ball, now, slice);
}

void Oracle::Impl::predict_pair(std::size_t a, std::size_t b, Quad now, Quad slice) {
    const Touch touch{a, b, false};
    const QuadVec w = relative_velocity(touch);
    expect(touch, time_until_contact(balls[a].position - balls[b].position, w, touch), now, slice);
}

void Oracle::Impl::predict_images(std::size_t a, std::size_t b, Quad now, Quad slice) {
    const Images x = images_that_may_meet(boxes[a], boxes[b], 0);
    if (x.first > x.last) return;
    const Images y = images_that_may_meet(boxes[a], boxes[b], 1);
    if (y.first > y.last) return;
    const physics::Vec2d extent = rules.periodic->max_m - rules.periodic->min_m;
    const Touch touch{a, b, false};
    const QuadVec d = balls[a].position - balls[b].position;
    const QuadVec w = relative_velocity(touch);
    for (int i = x.first; i <= x.last; ++i) {
        for (int j = y.first; j <= y.last; ++j) {
            const QuadVec shift{Quad(i) * Quad(extent.x()), Quad(j) * Quad(extent.y())};
            expect(touch, time_until_contact(d + shift, w, touch), now, slice);
        }
    }
}

// By how many widths of the box the first may be shifted to overlap the second: a range, empty
// where `first` is above `last`.
oracle::Images Oracle::Impl::images_that_may_meet(const Box& first, const Box& second,
                                                  int axis) const {
    const double width = rules.periodic->max_m[axis] - rules.periodic->min_m[axis];
    const double least = (second.min[axis] - first.max[axis]) / width;
    const double most = (second.max[axis] - first.min[axis]) / width;
    int from = static_cast<int>(least), to = static_cast<int>(most);
    if (from < least) ++from;
    if (to > most) --to;
    return {from, to};
}

void Oracle::Impl::predict_walls(std::size_t ball, Quad now, Quad slice) {
    for (std::size_t side = 0; side < kSides; ++side) {
        const Touch touch{ball, side, true};
        const QuadVec normal = normal_of(touch);
        const Quad closing = -dot(balls[ball].velocity, normal);
        if (!(closing > Quad(0))) continue;
        const Quad distance = gap(touch);
        const bool touches = distance <= touch_tolerance(touch);
        if (touches && !approaches(touch, normal)) continue;
        expect(touch, distance > Quad(0) ? distance / closing : Quad(0), now, slice);
    }
}

void Oracle::Impl::expect(const Touch& touch, Quad wait, Quad now, Quad slice) {
    if (wait >= Quad(0) && now + wait <= slice) meetings.push_back({touch, now + wait});
}

// Negative: never. |d + w t| = reach.
Quad Oracle::Impl::time_until_contact(const QuadVec& d, const QuadVec& w,
                                      const Touch& touch) const {
    const Quad never(-1);
    const Quad reach = balls[touch.a].radius + balls[touch.b].radius;
    const Quad b = dot(d, w);
    if (!(b < Quad(0))) return never;
    const Quad distance = norm(d);
    if (distance - reach <= touch_tolerance(touch)) {
        const QuadVec normal = d * (Quad(1) / distance);
        if (!approaches(touch, normal)) return never;
    }
    const Quad c = dot(d, d) - reach * reach;
    if (c <= Quad(0)) return Quad(0);
    const Quad discriminant = b * b - dot(w, w) * c;
    if (discriminant < Quad(0)) return never;
    return c / (root(discriminant) - b);
}

oracle::Box Oracle::Impl::swept_box(std::size_t ball, Quad span) const {
    const physics::Vec2d from = rounded(balls[ball].position);
    const physics::Vec2d to = rounded(balls[ball].position + balls[ball].velocity * span);
    const double radius = static_cast<double>(balls[ball].radius);
    const double lengths = from.norm() + to.norm() + radius;
    const double reach = radius + kBoxSlack * lengths;
    Box box{};
    for (int axis = 0; axis < 2; ++axis) {
        box.min[axis] = std::min(from[axis], to[axis]) - reach;
        box.max[axis] = std::max(from[axis], to[axis]) + reach;
    }
    return box;
}

void Oracle::Impl::move_all(Quad span) {
    if (!(span > Quad(0))) return;
    for (Ball& ball : balls) ball.position += ball.velocity * span;
}

void Oracle::Impl::wrap_all() {
    if (!rules.periodic) return;
    const auto wrapped = [](Quad x, double low, double high) {
        const Quad extent = Quad(high) - Quad(low);
        while (x < Quad(low)) x += extent;
        while (x >= Quad(high)) x -= extent;
        return x;
    };
    const physics::Vec2d& low = rules.periodic->min_m;
    const physics::Vec2d& high = rules.periodic->max_m;
    for (Ball& ball : balls) {
        ball.position.x = wrapped(ball.position.x, low.x(), high.x());
        ball.position.y = wrapped(ball.position.y, low.y(), high.y());
    }
}

Quad Oracle::Impl::energy() const {
    Quad sum(0);
    for (const Ball& ball : balls) sum += ball.mass * dot(ball.velocity, ball.velocity) / Quad(2);
    return sum;
}

QuadVec Oracle::Impl::momentum() const {
    QuadVec sum;
    for (const Ball& ball : balls) sum += ball.velocity * ball.mass;
    return sum;
}

Quad Oracle::Impl::momentum_scale() const {
    Quad sum(0);
    for (const Ball& ball : balls) sum += norm(ball.velocity) * ball.mass;
    return sum;
}

Oracle::Oracle(const physics::Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Oracle::~Oracle() = default;
Oracle::Oracle(Oracle&&) noexcept = default;
Oracle& Oracle::operator=(Oracle&&) noexcept = default;

bool Oracle::advance(double span_s, std::size_t max_events) {
    return impl_->advance(span_s, max_events);
}

void Oracle::reverse() {
    for (Impl::Ball& ball : impl_->balls) ball.velocity = ball.velocity * Quad(-1);
    impl_->momentum_at_start = impl_->momentum_at_start * Quad(-1);
    impl_->outer_impulse = impl_->outer_impulse * Quad(-1);
}

const std::vector<OracleContact>& Oracle::contacts() const {
    return impl_->contacts;
}

std::size_t Oracle::ball_collisions() const {
    return impl_->ball_collisions;
}

std::size_t Oracle::wall_collisions() const {
    return impl_->wall_collisions;
}

std::vector<physics::BodyDef> Oracle::bodies() const {
    std::vector<physics::BodyDef> bodies;
    for (const Impl::Ball& ball : impl_->balls) {
        bodies.push_back({rounded(ball.position), rounded(ball.velocity * impl_->slowed),
                          static_cast<double>(ball.radius),
                          ball.is_movable() ? static_cast<double>(ball.mass)
                                            : std::numeric_limits<double>::infinity()});
    }
    return bodies;
}

double Oracle::energy_error() const {
    const Quad change = magnitude(impl_->energy() - impl_->work - impl_->energy_at_start);
    if (!(change > Quad(0))) return 0.0;
    return static_cast<double>(change / impl_->energy_at_start);
}

double Oracle::momentum_error() const {
    const QuadVec change = impl_->momentum() - impl_->outer_impulse - impl_->momentum_at_start;
    const Quad scale = impl_->momentum_scale();
    const Quad size = norm(change);
    return size > Quad(0) ? static_cast<double>(size / scale) : 0.0;
}

}  // namespace fts::lab
