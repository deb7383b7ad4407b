// What is known of a body in straight flight beside its flight (flights.h).
#pragma once

#include <cstdint>

#include "common/physics/body.h"
#include "common/physics/flight.h"

namespace fts::physics {

struct alignas(32) Known {
    double hit_s = 0.0;  // the last event
    BodyId id;
    // Whom it is kept apart from: one, where there are no images, and those in a list.
    std::uint32_t apart_from = kNobody;
    std::uint32_t apart_from_events = 0;
    std::uint32_t apart = kNobody;    // the first
    std::uint8_t sides_kept_off = 0;  // a bit for each

    void move_epoch(double shift_s) { hit_s -= shift_s; }
    template <typename Visit>
    void for_each_other(Visit&& visit) {
        visit(apart_from);
    }
};

// The same, and what a calendar (coasting.h) expects of it: one cache line.
struct alignas(64) Prospect : Known {
    enum class Border : std::uint8_t { kNone, kCell, kWall, kFall };

    Border border = Border::kNone;
    std::uint8_t side = 0;
    double meeting_s = 0.0;
    double border_s = 0.0;
    std::uint32_t with = kNobody;   // whom it meets
    std::uint32_t with_events = 0;  // what had happened to that one when this was predicted
    std::uint32_t cell[2] = {0, 0};

    void move_epoch(double shift_s) {
        Known::move_epoch(shift_s);
        meeting_s -= shift_s;
        border_s -= shift_s;
    }
    template <typename Visit>
    void for_each_other(Visit&& visit) {
        Known::for_each_other(visit);
        visit(with);
    }
};

static_assert(sizeof(Known) == 32 && sizeof(Prospect) == 64);

}  // namespace fts::physics
