// Which of a few bodies may meet one body, and which are next to it: most of the time of an
// event-driven simulation goes into this, so it is done for several at a time and without branches.
#pragma once

#include <cstdint>

#include "common/physics/flight.h"

namespace fts::physics {

// So many more may stand behind those that are given, and are overwritten.
inline constexpr std::uint32_t kFilterSpare = 3;

template <typename Scalar>
struct Filter {
    const Flight<Scalar>* flights;  // by body
    Flight<Scalar> self;            // as it flies on, whatever `flights` says of it
    std::uint32_t body;             // who that is; left out
    std::uint32_t partner;          // left out as well
    Vec2<Scalar> shift_m;           // of the image that the others are
    bool equal_radii;
    Scalar close;  // nearer than so many times the reach, when the later of two flights began

    struct Passed {
        std::uint32_t* end;  // of those who may meet (Approach::may_meet); they come first now
        bool any_close;
    };
    // Of [first, end), in their order.
    Passed operator()(std::uint32_t* first, std::uint32_t* end) const;
    // The same, one by one.
    Passed one_by_one(std::uint32_t* first, const std::uint32_t* end) const;
};

extern template struct Filter<double>;
extern template struct Filter<float>;

}  // namespace fts::physics
