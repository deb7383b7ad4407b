// Numbers of 113 bits of mantissa and what the oracle needs of them: plane vectors, roots and the
// exponential of a decay. No library: sums, products and quotients are the compiler's, the rest is
// Newton and Taylor.
#pragma once

#include <cfloat>
#include <cmath>

#include "common/physics/scene.h"

namespace fts::lab {

#if LDBL_MANT_DIG == 113
using Quad = long double;
#else
__extension__ using Quad = __float128;
#endif

// Newton's method doubles the right digits: 53 or more become 113 in two steps.
inline Quad root(Quad x) {
    if (!(x > Quad(0))) return Quad(0);
    Quad y = static_cast<Quad>(std::sqrt(static_cast<long double>(x)));
    for (int step = 0; step < 2; ++step) y = (y + x / y) / Quad(2);
    return y;
}

inline Quad magnitude(Quad x) {
    return x < Quad(0) ? -x : x;
}

// exp(-x) - 1, for x >= 0: Taylor where x is small, exp(2y) - 1 = (exp(y) - 1) (exp(y) + 1) above.
inline Quad decay_less_one(Quad x) {
    constexpr double kSmall = 1.0 / 64.0;
    constexpr int kTerms = 24;
    if (x > Quad(kSmall)) {
        const Quad half = decay_less_one(x / Quad(2));
        return half * (half + Quad(2));
    }
    Quad sum(0);
    for (int k = kTerms; k > 0; --k) sum = -x / Quad(k) * (Quad(1) + sum);
    return sum;
}

struct QuadVec {
    Quad x = Quad(0), y = Quad(0);

    friend QuadVec operator+(const QuadVec& a, const QuadVec& b) { return {a.x + b.x, a.y + b.y}; }
    friend QuadVec operator-(const QuadVec& a, const QuadVec& b) { return {a.x - b.x, a.y - b.y}; }
    friend QuadVec operator*(const QuadVec& a, Quad s) { return {a.x * s, a.y * s}; }
    QuadVec& operator+=(const QuadVec& b) { return *this = *this + b; }
    QuadVec& operator-=(const QuadVec& b) { return *this = *this - b; }
};

inline Quad dot(const QuadVec& a, const QuadVec& b) {
    return a.x * b.x + a.y * b.y;
}
inline Quad norm(const QuadVec& a) {
    return root(dot(a, a));
}
inline QuadVec quad_of(const physics::Vec2d& a) {
    return {Quad(a.x()), Quad(a.y())};
}
inline physics::Vec2d rounded(const QuadVec& a) {
    return {static_cast<double>(a.x), static_cast<double>(a.y)};
}

}  // namespace fts::lab
