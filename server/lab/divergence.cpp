#include "server/lab/divergence.h"

#include <algorithm>
#include <cmath>

namespace fts::lab {
namespace {

// What each body hits, in order, from some place on.
class Partners {
  public:
    Partners(const std::vector<Hit>& hits, std::size_t bodies) : of_(bodies), next_(bodies, 0) {
        for (const Hit& hit : hits) {
            of_[hit.a].push_back(hit.b);
            if (hit.b < kFirstWall) of_[hit.b].push_back(hit.a);
        }
    }

    bool has_none_left(std::uint32_t body) const {
        return body < kFirstWall && next_[body] >= of_[body].size();
    }
    // Takes `partner` out of the body's next `window` ones.
    bool take(std::uint32_t body, std::uint32_t partner, std::size_t window) {
        if (body >= kFirstWall) return true;
        auto& partners = of_[body];
        const std::size_t end = std::min(next_[body] + window, partners.size());
        for (std::size_t k = next_[body]; k < end; ++k) {
            if (partners[k] != partner) continue;
            std::swap(partners[k], partners[next_[body]]);
            ++next_[body];
            return true;
        }
        return false;
    }

  private:
    std::vector<std::vector<std::uint32_t>> of_;
    std::vector<std::size_t> next_;
};

}  // namespace

std::uint32_t wall_with_normal(const physics::Vec2d& normal) {
    const bool is_x = std::abs(normal.x()) >= std::abs(normal.y());
    const bool positive = (is_x ? normal.x() : normal.y()) > 0.0;
    return kFirstWall + (is_x ? 0U : 2U) + (positive ? 0U : 1U);
}

Divergence divergence(const std::vector<Hit>& exact, const std::vector<Hit>& solver,
                      std::size_t bodies, double end_s, double grace_s, double instant_s) {
    Partners partners(solver, bodies);
    std::size_t instant = 0;  // the first hit of the present one
    for (std::size_t k = 0; k < exact.size(); ++k) {
        const Hit& hit = exact[k];
        if (hit.time_s - exact[instant].time_s > instant_s) instant = k;
        std::size_t at_once = 1;
        while (instant + at_once < exact.size() &&
               exact[instant + at_once].time_s - exact[instant].time_s <= instant_s) {
            ++at_once;
        }
        const bool last_tick = hit.time_s > end_s - grace_s;
        if (last_tick && (partners.has_none_left(hit.a) || partners.has_none_left(hit.b))) {
            return {k, false};
        }
        if (!partners.take(hit.a, hit.b, at_once) || !partners.take(hit.b, hit.a, at_once)) {
            return {k, true};
        }
    }
    return {exact.size(), false};
}

}  // namespace fts::lab
