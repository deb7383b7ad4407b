// The exponential of a decay, from additions, multiplications and divisions only: unlike the C
// library's, it has the same bits on every processor, compiler and library. Within 2 units in the
// last place.
#pragma once

namespace fts::physics {

struct Decay {
    double factor;  // exp(-x)
    double mean;    // (1 - exp(-x)) / x, and 1 where x is 0
};

// x >= 0; infinity is allowed.
Decay decay(double x);

}  // namespace fts::physics
