// The impulses of several contacts that press at once: the lambda >= 0 that bring the velocity v to
// the nearest one, in the norm of the masses M, at which no contact approaches,
//
//     minimise |v + M^-1 N lambda|_M^2 / 2  over lambda >= 0,
//
// for which v' = v + M^-1 N lambda has N^T v' >= 0 and lambda . (N^T v') = 0. v' is unique; lambda
// is not where normals depend on each other, and then any of them does.
//
// Up to kMaxExactContacts by the active set method of Lawson and Hanson, "Solving Least Squares
// Problems" (1974), chapter 23: a contact joins the active set only while its own approach is left
// over, so that the active normals never depend on each other and the normal equations have a
// Cholesky factor. Above that by an accelerated projected gradient, restarted when it turns back
// (O'Donoghue and Candes, "Adaptive restart for accelerated gradient schemes", 2015), in
// kGradientSteps: to an accuracy that need not be perfect, since whoever uses it scales the step
// (see simultaneous.h).
//
// In double whatever the scene's scalar. No allocation after warm-up.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/physics/scene.h"

namespace fts::physics {

inline constexpr std::size_t kMaxExactContacts = 512;
inline constexpr std::uint32_t kGradientSteps = 4000;

class ConeProjection {
  public:
    static constexpr std::uint32_t kFixed = 0xffffffff;

    void begin();
    // Movable; named 0, 1, 2 ... in the order they are added.
    void add_body(double inverse_mass_per_kg);
    // `normal` is a unit vector from b to a; kFixed for what does not move. Not both are fixed.
    void add_contact(std::uint32_t a, std::uint32_t b, const Vec2d& normal, double approach_mps);

    // By contact, newton seconds. At least one is above 0 when anything approaches (has a negative
    // approach_mps). Valid until begin.
    std::span<const double> solve();

  private:
    struct Contact {
        std::uint32_t a, b;
        Vec2d normal;
        double target;  // approach in units in which the contact's own effective mass is 1
        double scale;   // from such units to newton seconds
    };

    double coupling(const Contact& first, const Contact& second) const;
    void solve_exactly();
    void solve_by_gradient();
    void fill_couplings();
    bool activate(std::size_t contact);
    bool factorise_row(std::size_t row);
    void refactorise();
    void solve_active();
    bool step_to_solution();
    std::size_t most_pressed(double least) const;
    std::uint32_t largest_degree();
    struct Descent {
        double largest_change;
        bool turned_back;  // the step went against the momentum it started with
    };
    Descent descend(double rate, double momentum);

    std::vector<double> inverse_mass_;
    std::vector<Contact> contacts_;
    std::vector<double> lambda_;    // in units of each contact's scale while solving
    std::vector<double> coupling_;  // contact by contact
    std::vector<double> factor_;    // lower triangle, row after row, by place in active_
    std::vector<std::size_t> active_;
    std::vector<double> solution_;  // by place in active_
    std::vector<double> residual_;  // by contact
    std::vector<double> ahead_;     // gradient: where the next step starts from
    std::vector<Vec2d> velocity_;   // gradient: by body
    std::vector<std::uint32_t> degree_;
    std::vector<std::uint8_t> refused_;
};

}  // namespace fts::physics
