#include "common/physics/packing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "common/physics/disc_grid.h"
#include "common/physics/disc_lattice.h"

namespace fts::physics {
namespace {

constexpr double kRoundOff = 0.2 * kTouchTolerance;

// Below this cover chance alone finds room for all; above, it needs more and more attempts.
constexpr double kDilute = 0.4;
constexpr std::size_t kAttemptsPerDisc = 2000;
constexpr std::size_t kAttemptsPerDiscOnAverage = 60;

// While overlaps are relaxed discs are larger by this part, so that they end up apart.
constexpr double kSwollen = 1.004;
constexpr double kDensestRelaxed = 0.87;
constexpr std::size_t kMaxSweeps = 4000;
constexpr std::size_t kMinSweeps = 300;
constexpr std::size_t kMovesInAll = 100'000'000;

class Packing {
  public:
    Packing(const Region& region, std::span<const double> radii_m,
            std::span<const BodyDef> obstacles, SplitMix& random);

    std::optional<std::vector<Vec2d>> found();

  private:
    double cover() const;
    bool place_by_chance();
    bool place_on_lattice();
    bool relax();
    void put_on_lattice(std::vector<Vec2d> lattice);
    std::vector<Vec2d> clear_places(double radius_m);
    double lattice_radius_beside_obstacles_m();

    void refill_grid();
    void insert_obstacles();
    bool is_clear(const Vec2d& place, double radius_m) const;
    void make_room_for(std::uint32_t disc);
    bool all_clear();
    Vec2d random_place(double radius_m);

    const Region& region_;
    std::size_t count_;
    std::size_t obstacles_;
    SplitMix& random_;
    std::vector<double> radius_m_;  // to round-off; those of obstacles follow
    std::vector<Vec2d> place_m_;    // likewise
    double widest_m_ = 0.0;
    DiscGrid grid_;
};

double widest_of(std::span<const double> radii_m) {
    return *std::max_element(radii_m.begin(), radii_m.end());
}

Packing::Packing(const Region& region, std::span<const double> radii_m,
                 std::span<const BodyDef> obstacles, SplitMix& random)
    : region_(region),
      count_(radii_m.size()),
      obstacles_(obstacles.size()),
      random_(random),
      radius_m_(radii_m.begin(), radii_m.end()),
      place_m_(radii_m.size(), Vec2d::Zero()),
      grid_(region, widest_of(radii_m) * kSwollen, radii_m.size() + obstacles.size()) {
    for (const BodyDef& obstacle : obstacles) {
        radius_m_.push_back(obstacle.radius_m);
        place_m_.push_back(obstacle.position_m);
    }
    // What fits exactly must fit, and is off by round-off at most; but far from the origin
    // coordinates are coarse, and that must not make anything overlap.
    const double coarse_m = 4.0 * std::numeric_limits<double>::epsilon() * region.reach_m();
    for (double& radius_m : radius_m_) radius_m = radius_m * (1.0 - kRoundOff) + coarse_m;
    widest_m_ = *std::max_element(radius_m_.begin(),
                                  radius_m_.begin() + static_cast<std::ptrdiff_t>(count_));
}

std::optional<std::vector<Vec2d>> Packing::found() {
    const bool is_dilute = cover() <= kDilute;
    if (!(is_dilute && place_by_chance()) && !place_on_lattice() && !relax()) return std::nullopt;
    place_m_.resize(count_);
    return std::move(place_m_);
}

double Packing::cover() const {
    double covered_m2 = 0.0;
    for (const double radius_m : radius_m_) covered_m2 += std::numbers::pi * radius_m * radius_m;
    return covered_m2 / region_.area_m2();
}

// Large ones first: small ones find room between them.
bool Packing::place_by_chance() {
    grid_.clear();
    insert_obstacles();
    std::vector<std::uint32_t> order(count_);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
        return radius_m_[a] > radius_m_[b];
    });
    std::size_t attempts_left = kAttemptsPerDiscOnAverage * count_ + 10 * kAttemptsPerDisc;
    for (const std::uint32_t disc : order) {
        std::size_t attempts = 0;
        do {
            if (++attempts > kAttemptsPerDisc || attempts_left-- == 0) return false;
            place_m_[disc] = random_place(radius_m_[disc]);
        } while (!region_.holds(place_m_[disc], radius_m_[disc]) ||
                 !is_clear(place_m_[disc], radius_m_[disc]));
        grid_.insert(disc, place_m_[disc]);
    }
    return true;
}

Vec2d Packing::random_place(double radius_m) {
    const double margin = region_.is_periodic || region_.round ? 0.0 : radius_m;
    const double x = random_.between(region_.min_m.x() + margin, region_.max_m.x() - margin);
    return {x, random_.between(region_.min_m.y() + margin, region_.max_m.y() - margin)};
}

// Each disc moves about its place as far as its neighbours leave it room to.
bool Packing::place_on_lattice() {
    const double roomy_m = lattice_radius_beside_obstacles_m();
    if (roomy_m < widest_m_) return false;
    put_on_lattice(clear_places(roomy_m));
    for (std::size_t disc = 0; disc < count_; ++disc) {
        const double free_m = 0.99 * (roomy_m - radius_m_[disc]);
        const double x = random_.between(-1.0, 1.0);
        const double y = random_.between(-1.0, 1.0);
        const double length = std::max(1.0, std::sqrt(x * x + y * y));
        const Vec2d moved = place_m_[disc] + Vec2d(x, y) * (free_m / length);
        place_m_[disc] = region_.nearest_place_m(moved, radius_m_[disc]);
    }
    return true;
}

// Any of the places, so that vacancies are anywhere.
void Packing::put_on_lattice(std::vector<Vec2d> lattice) {
    for (std::size_t disc = 0; disc < count_; ++disc) {
        const std::size_t chosen = disc + random_.below(lattice.size() - disc);
        std::swap(lattice[disc], lattice[chosen]);
        place_m_[disc] = lattice[disc];
    }
}

std::vector<Vec2d> Packing::clear_places(double radius_m) {
    std::vector<Vec2d> places = lattice_places(region_, radius_m);
    if (obstacles_ == 0) return places;
    DiscGrid grid(region_, radius_m, count_);
    for (std::size_t i = count_; i < radius_m_.size(); ++i) {
        grid.insert_wide(static_cast<std::uint32_t>(i), place_m_[i], radius_m_[i]);
    }
    std::erase_if(places, [&](const Vec2d& place) {
        bool hit = false;
        grid.for_each_near(place, [&](std::uint32_t other) {
            const double reach = radius_m + radius_m_[other];
            hit = hit || region_.between_m(place, place_m_[other]).squaredNorm() < reach * reach;
        });
        return hit;
    });
    return places;
}

// Obstacles take places of the lattice; a narrower lattice has more.
double Packing::lattice_radius_beside_obstacles_m() {
    double radius_m = lattice_radius_m(region_, count_);
    constexpr double kNarrower = 0.995;
    while (obstacles_ > 0 && radius_m >= widest_m_ && clear_places(radius_m).size() < count_) {
        radius_m *= kNarrower;
    }
    return radius_m;
}

// From an even start, pushes what overlaps apart until nothing does. Equal discs in a box are never
// packed more densely by this than by a lattice.
bool Packing::relax() {
    const bool all_equal = std::all_of(radius_m_.begin(), radius_m_.end(),
                                       [this](double radius) { return radius == widest_m_; });
    if ((all_equal && !region_.round) || cover() > kDensestRelaxed) return false;
    const double start_m = lattice_radius_m(region_, count_ + count_ / 50);
    if (!(start_m > 0.0)) return false;
    put_on_lattice(lattice_places(region_, start_m));
    for (std::size_t disc = 0; disc < count_; ++disc) {
        place_m_[disc] = region_.nearest_place_m(place_m_[disc], radius_m_[disc]);
    }
    const std::size_t sweeps = std::clamp(kMovesInAll / count_, kMinSweeps, kMaxSweeps);
    for (std::size_t sweep = 0; sweep < sweeps; ++sweep) {
        refill_grid();
        if (sweep % 8 == 0 && all_clear()) return true;
        for (std::uint32_t disc = 0; disc < count_; ++disc) make_room_for(disc);
    }
    refill_grid();
    return all_clear();
}

void Packing::make_room_for(std::uint32_t disc) {
    grid_.for_each_near(place_m_[disc], [&](std::uint32_t other) {
        if (other == disc) return;
        const double reach = kSwollen * (radius_m_[disc] + radius_m_[other]);
        const Vec2d away = region_.between_m(place_m_[other], place_m_[disc]);
        const double squared = away.squaredNorm();
        if (squared >= reach * reach) return;
        const double distance = std::sqrt(squared);
        const Vec2d direction = distance > 0.0 ? Vec2d(away / distance) : Vec2d::UnitX();
        const bool fixed = other >= count_;
        const Vec2d push = direction * ((reach - distance) * (fixed ? 1.0 : 0.5));
        place_m_[disc] = region_.nearest_place_m(place_m_[disc] + push, radius_m_[disc]);
        if (fixed) return;
        place_m_[other] = region_.nearest_place_m(place_m_[other] - push, radius_m_[other]);
    });
}

void Packing::refill_grid() {
    grid_.clear();
    insert_obstacles();
    for (std::uint32_t disc = 0; disc < count_; ++disc) grid_.insert(disc, place_m_[disc]);
}

void Packing::insert_obstacles() {
    for (std::size_t i = count_; i < radius_m_.size(); ++i) {
        grid_.insert_wide(static_cast<std::uint32_t>(i), place_m_[i], radius_m_[i]);
    }
}

bool Packing::is_clear(const Vec2d& place, double radius_m) const {
    bool clear = true;
    grid_.for_each_near(place, [&](std::uint32_t other) {
        const double reach = radius_m + radius_m_[other];
        clear = clear && region_.between_m(place, place_m_[other]).squaredNorm() >= reach * reach;
    });
    return clear;
}

bool Packing::all_clear() {
    for (std::uint32_t disc = 0; disc < count_; ++disc) {
        if (!region_.holds(place_m_[disc], radius_m_[disc] * (1.0 - kRoundOff))) return false;
        bool clear = true;
        grid_.for_each_near(place_m_[disc], [&](std::uint32_t other) {
            const double reach = radius_m_[disc] + radius_m_[other];
            const Vec2d between = region_.between_m(place_m_[disc], place_m_[other]);
            clear = clear && (other == disc || between.squaredNorm() >= reach * reach);
        });
        if (!clear) return false;
    }
    return true;
}

}  // namespace

std::optional<std::vector<Vec2d>> pack(const Region& region, std::span<const double> radii_m,
                                       std::span<const BodyDef> obstacles, SplitMix& random) {
    if (radii_m.empty()) return std::vector<Vec2d>{};
    return Packing(region, radii_m, obstacles, random).found();
}

}  // namespace fts::physics
