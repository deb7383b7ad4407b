#include "server/lab/trajectory.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace fts::lab {
namespace {

// Of the longest row: six numbers of at most 24 characters.
constexpr std::size_t kMaxRow = 192;

}  // namespace

TrajectoryWriter::TrajectoryWriter(std::ostream& out, double tick_rate_hz, double sample_rate_hz)
    : out_(out), samples_per_tick_(std::min(1.0, sample_rate_hz / tick_rate_hz)) {
    out_ << "time_s,body,x_m,y_m,vx_mps,vy_mps\n";
}

bool TrajectoryWriter::is_sample(std::uint64_t tick, std::uint64_t last_tick) {
    const double sample = std::floor(static_cast<double>(tick) * samples_per_tick_ + 1e-9);
    const bool due = sample >= next_sample_;
    if (due) next_sample_ = sample + 1.0;
    return due || tick == last_tick;
}

void TrajectoryWriter::write(double time_s, std::uint32_t body, const physics::Vec2d& position_m,
                             const physics::Vec2d& velocity_mps) {
    std::array<char, kMaxRow> row{};
    char* end = row.data();
    char* const limit = row.data() + row.size();
    end = std::to_chars(end, limit, time_s).ptr;
    *end++ = ',';
    end = std::to_chars(end, limit, body).ptr;
    for (const double value :
         {position_m.x(), position_m.y(), velocity_mps.x(), velocity_mps.y()}) {
        *end++ = ',';
        end = std::to_chars(end, limit, value).ptr;
    }
    *end++ = '\n';
    out_.write(row.data(), end - row.data());
}

}  // namespace fts::lab
