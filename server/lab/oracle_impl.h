// The inside of the oracle, which its two sources share: oracle.cpp predicts and moves,
// oracle_contacts.cpp says what a contact does.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "server/lab/oracle.h"
#include "server/lab/quad.h"

namespace fts::lab::oracle {

inline constexpr std::size_t kSides = 4;  // of the box: -x, +x, -y, +y

struct Ball {
    QuadVec position, velocity;
    Quad radius = Quad(0), mass = Quad(0);
    Quad inverse_mass = Quad(0);  // 0: no impact moves it
    bool is_movable() const { return inverse_mass > Quad(0); }
};

struct Box {
    double min[2], max[2];
};

struct Images {
    int first, last;
};

// Two balls, or a ball and one of the sides.
struct Touch {
    std::size_t a = 0;
    std::size_t b = 0;
    bool is_wall = false;
    friend bool operator==(const Touch&, const Touch&) = default;
};

struct Meeting {
    Touch touch;
    Quad at = Quad(0);  // in the slice
};

struct Constraint {
    Touch touch;
    QuadVec normal;  // from b towards a
    Quad impulse = Quad(0);
};

}  // namespace fts::lab::oracle

namespace fts::lab {

struct Oracle::Impl {
    using Ball = oracle::Ball;
    using Box = oracle::Box;
    using Constraint = oracle::Constraint;
    using Images = oracle::Images;
    using Meeting = oracle::Meeting;
    using Touch = oracle::Touch;

    explicit Impl(const physics::Scene& scene);

    bool advance(double span_s, std::size_t max_events);
    bool run_slice(Quad slice);
    Quad slice_length(Quad left) const;
    void predict_all(Quad slice);
    void predict(std::size_t ball, Quad now, Quad slice, std::size_t others_from);
    void predict_pair(std::size_t a, std::size_t b, Quad now, Quad slice);
    void predict_images(std::size_t a, std::size_t b, Quad now, Quad slice);
    Images images_that_may_meet(const Box& first, const Box& second, int axis) const;
    void predict_walls(std::size_t ball, Quad now, Quad slice);
    void expect(const Touch& touch, Quad wait, Quad now, Quad slice);
    Quad time_until_contact(const QuadVec& d, const QuadVec& w, const Touch& touch) const;

    std::vector<std::size_t> resolve(const Touch& first, Quad now);
    std::vector<Constraint> touching_cluster(const Touch& first) const;
    void add_neighbours(std::size_t ball, std::vector<Constraint>& all,
                        std::vector<std::size_t>& members) const;
    void solve(std::vector<Constraint>& due, std::vector<QuadVec>& velocity) const;
    void reflect(std::vector<Constraint>& due, Quad now);
    void account(const Constraint& hit, const QuadVec& impulse);

    QuadVec separation(std::size_t a, std::size_t b) const;
    Quad gap(const Touch& touch) const;
    Quad touch_tolerance(const Touch& touch) const;
    QuadVec normal_of(const Touch& touch) const;
    QuadVec relative_velocity(const Touch& touch) const;
    bool approaches(const Touch& touch, const QuadVec& normal) const;
    Box swept_box(std::size_t ball, Quad span) const;
    void move_all(Quad span);
    void wrap_all();
    Quad energy() const;
    QuadVec momentum() const;
    Quad momentum_scale() const;

    physics::Scene rules;  // without bodies
    std::vector<Ball> balls;
    Quad drag;
    // Velocities are kept as they would be without drag, in a time that runs slower by this.
    Quad slowed = Quad(1);
    Quad slice_start = Quad(0);  // since the start of the advance, in the slower time

    std::vector<Box> boxes;  // where each ball is until the slice ends
    std::vector<Meeting> meetings;
    std::vector<OracleContact> contacts;
    std::size_t events_left = 0;
    std::size_t ball_collisions = 0, wall_collisions = 0;
    Quad energy_at_start = Quad(0), work = Quad(0);
    QuadVec momentum_at_start, outer_impulse;
};

}  // namespace fts::lab
