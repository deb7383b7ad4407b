// The exponential of a decay and its inverse, from additions, multiplications and divisions only:
// unlike the C library's, they have the same bits on every processor, compiler and library. Both
// within 2 units in the last place.
#pragma once

namespace fts::physics {

struct Decay {
    double factor;  // exp(-x)
    double mean;    // (1 - exp(-x)) / x, and 1 where x is 0
};

// x >= 0; infinity is allowed.
Decay decay(double x);

// The x whose decay takes `lost` of a whole: -log(1 - lost). `lost` in [0, 1]; infinity at 1.
double span_of_decay(double lost);

}  // namespace fts::physics
