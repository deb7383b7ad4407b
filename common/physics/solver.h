// How a span of time is advanced: straight-line motion with collisions and falls, and no
// acceleration. The one stage of a tick in which solvers differ.
#pragma once

#include <cstdint>
#include <optional>

#include "common/physics/bodies.h"
#include "common/physics/record.h"

namespace fts::physics {

template <typename Scalar>
struct Boundary {
    struct Box {
        Vec2<Scalar> min_m, max_m;
    };
    std::optional<Box> walls;
    std::optional<Platform> platform;
    Scalar restitution = Scalar(1);
};

template <typename Scalar>
struct DriftReport {
    std::uint32_t events = 0;
    bool overrun = false;
    Scalar unspent_time_s = Scalar(0);  // the state is that of the span's end less this
};

template <typename Scalar>
class Solver {
  public:
    virtual ~Solver() = default;

    // Advances by `span_s` >= 0, removes bodies that fall, and appends to the record.
    virtual DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Boundary<Scalar>& boundary,
                                      Scalar span_s, Record<Scalar>& record) = 0;
};

}  // namespace fts::physics
