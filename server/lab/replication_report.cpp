// What a study of replication found: for the terminal, for programs, and as a picture.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "server/lab/arena_trace.h"
#include "server/lab/replication_study.h"
#include "server/lab/snapshot_coders.h"
#include "server/lab/svg_plot.h"
#include "server/lab/text_table.h"

namespace fts::lab {
namespace {

std::string setting_text(const ReplicationRequest& request) {
    return fmt::format("{} balls, {:g} snapshots a second, acknowledged {:g} ms later, {:g} % lost",
                       request.count, request.rate_hz, request.delay_ms, 100.0 * request.loss);
}

std::string notes_of(const ReplicationStudy& study) {
    std::string out = fmt::format(
        "  Two traces of one start and steering: free, and snapped, whose server puts its state\n"
        "  on the lattice at every snapshot (for the two coders that need it). Snapping changes\n"
        "  that trace's kinetic energy by {:+.1e} of it a second.\n"
        "  The game's delta format says velocities in its own steps, {:g} of which are one of the\n"
        "  trace's, so as to predict as in a game: it tells more than the others.\n"
        "  Steps: height/4096, and ten of these a second; rms speed {:.3f} heights/s.\n",
        study.snapping_energy_per_s, kGameStepsPerTraceStep, study.rms_speed_mps / kTraceHeightM);
    std::uint64_t decoded = 0, wrong = 0;
    for (const CoderRow& row : study.rows) {
        decoded += row.decoded;
        wrong += row.wrong;
    }
    out += fmt::format("  {} snapshots decoded and compared with the truth, {} of them wrong.\n",
                       decoded, wrong);
    return out;
}

// There are few, and each has its number.
void show_whole_decades(Axis& axis, const std::vector<CoderRow>& rows) {
    const auto [least, most] = std::ranges::minmax_element(rows, {}, &CoderRow::encode_us);
    if (least == rows.end() || least->encode_us <= 0.0) return;
    axis.min = std::pow(10.0, std::floor(std::log10(least->encode_us)));
    axis.max = std::pow(10.0, std::ceil(std::log10(most->encode_us)));
}

}  // namespace

std::string command_of(const ReplicationRequest& request) {
    return fmt::format(
        "fts-lab replication --count {} --seed {} --rate {:g} --delay-ms {:g} --loss {:g} "
        "--seconds {:g}",
        request.count, request.seed, request.rate_hz, request.delay_ms, request.loss,
        request.seconds);
}

std::string table_of(const ReplicationRequest& request, const ReplicationStudy& study) {
    const bool some_of_nothing = std::any_of(study.rows.begin(), study.rows.end(),
                                             [](const CoderRow& row) { return row.keyframes > 0; });
    std::vector<std::string> heads{"coder",     "bits/ball", "bytes",     "datagrams", "usable",
                                   "encode us", "baselines", "decode us", "damaged",   "shown"};
    if (some_of_nothing) heads.emplace_back("of nothing");
    TextTable table(std::move(heads));
    for (const CoderRow& row : study.rows) {
        std::vector<std::string> cells{row.coder,
                                       fmt::format("{:.2f}", row.bits_per_ball),
                                       fmt::format("{:.0f}", row.bytes_per_snapshot),
                                       fmt::format("{:.2f}", row.datagrams),
                                       fmt::format("{:.1f} %", 100.0 * row.usable),
                                       fmt::format("{:.1f}", row.encode_us),
                                       fmt::format("{:.1f}", row.baselines),
                                       fmt::format("{:.0f}", row.decode_us),
                                       std::to_string(row.damaged),
                                       std::to_string(row.damaged_shown)};
        if (some_of_nothing) cells.push_back(std::to_string(row.keyframes));
        table.add(std::move(cells));
    }
    std::string out = setting_text(request) + "\n\n" + table.text() + "\n";
    out += fmt::format(
        "  bits/ball  of a snapshot, all headers of the format included\n"
        "  usable     snapshots of which every datagram arrives\n"
        "  encode us  of the processor, a client and snapshot, with the prediction where there is\n"
        "             one; what is encoded once for a baseline is shared by {} clients\n"
        "  baselines  different ones that these clients hold\n"
        "  decode us  of the processor, a snapshot, with the prediction or the replay\n"
        "  damaged    snapshots with a byte altered or missing, and how many of them were shown\n",
        kStudyClients);
    if (some_of_nothing) {
        out += "  of nothing snapshots to a client of which no acknowledgement had come in time\n";
    }
    out += notes_of(study);
    out += "Again: " + command_of(request) + "\n";
    if (study.stopped()) out += fmt::format("stopped after {} of {}\n", study.done, study.of);
    return out;
}

std::string json_of(const ReplicationRequest& request, const ReplicationStudy& study) {
    nlohmann::ordered_json json = {{"count", request.count},
                                   {"seed", request.seed},
                                   {"rate_hz", request.rate_hz},
                                   {"delay_ms", request.delay_ms},
                                   {"loss", request.loss},
                                   {"seconds", request.seconds},
                                   {"unmeasured_s", kUnmeasuredS},
                                   {"clients", kStudyClients},
                                   {"rms_speed_heights_per_s", study.rms_speed_mps / kTraceHeightM},
                                   {"snapping_energy_per_s", study.snapping_energy_per_s},
                                   {"command", command_of(request)},
                                   {"snapshots", study.done},
                                   {"stopped", study.stopped()}};
    json["rows"] = nlohmann::ordered_json::array();
    for (const CoderRow& row : study.rows) {
        json["rows"].push_back({{"coder", row.coder},
                                {"trace", row.snapped ? "snapped" : "free"},
                                {"bits_per_ball", row.bits_per_ball},
                                {"bytes_per_snapshot", row.bytes_per_snapshot},
                                {"datagrams", row.datagrams},
                                {"usable", row.usable},
                                {"encode_us", row.encode_us},
                                {"decode_us", row.decode_us},
                                {"baselines", row.baselines},
                                {"decoded", row.decoded},
                                {"wrong", row.wrong},
                                {"of_nothing", row.keyframes},
                                {"damaged", row.damaged},
                                {"damaged_shown", row.damaged_shown}});
    }
    return json.dump(2) + "\n";
}

std::string svg_of(const ReplicationRequest& request, const ReplicationStudy& study) {
    Plot plot;
    plot.title = "What a snapshot costs on the wire";
    plot.subtitle = setting_text(request) + ". Left: fewer bits; down: less work.";
    plot.footnote = command_of(request);
    plot.x = {"bits a ball and snapshot", Scale::kLog, {}, {}};
    plot.y = {"encoding, us a client and snapshot", Scale::kLog, {}, {}};
    show_whole_decades(plot.y, study.rows);
    for (const CoderRow& row : study.rows) {
        const bool ours = row.coder.starts_with("ours");
        Series series;
        series.points.push_back({row.bits_per_ball, row.encode_us, row.coder});
        series.ink = ours ? Ink::kBlue : Ink::kGrey;
        series.marker = ours ? Marker::kCircle : Marker::kSquare;
        series.line = false;
        plot.series.push_back(std::move(series));
    }
    return render_svg(plot);
}

}  // namespace fts::lab
