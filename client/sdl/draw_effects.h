// What passes: sparks and rings at hits, short trails behind fast balls, and balls that fall.
//
// Effects remembers the last fraction of a second of the views it was shown, nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "client/core/view.h"
#include "client/sdl/camera.h"
#include "client/sdl/canvas.h"

namespace fts::sdl {

class Effects {
  public:
    // Call once per view, before drawing it.
    void observe(const client::View& view, double now_s);
    void draw_below_balls(const Canvas& canvas, const Camera& camera) const;
    void draw_above_balls(const Canvas& canvas, const Camera& camera) const;

  private:
    struct Spark {
        physics::Vec2d point_m;
        double impulse_ns;
        double born_s;
        std::uint32_t seed;
    };
    struct Falling {
        client::BallView ball;
        double born_s = 0.0;
    };
    struct Sample {
        physics::Vec2d position_m;
        double time_s;
    };
    static constexpr std::size_t kTrailSamples = 14;
    struct Trail {
        std::array<Sample, kTrailSamples> samples{};
        std::size_t count = 0;  // the newest is samples[count - 1]
        client::BallView last;
        double seen_s = 0.0;
    };

    void observe_hits(const client::View& view, double now_s);
    void observe_balls(const client::View& view, double now_s);
    void draw_trail(const Canvas& canvas, const Camera& camera, const Trail& trail,
                    double now_s) const;

    std::vector<Spark> sparks_;
    std::vector<Falling> falling_;
    std::map<std::uint16_t, Trail> trails_;
    std::uint32_t hits_seen_ = 0;
};

}  // namespace fts::sdl
