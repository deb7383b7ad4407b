// What a study of replication found: for the terminal, for programs, and as a picture.
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "server/lab/arena_trace.h"
#include "server/lab/replication_study.h"
#include "server/lab/svg_plot.h"
#include "server/lab/text_table.h"

namespace fts::lab {
namespace {

std::string setting_text(const ReplicationRequest& request) {
    return fmt::format("{} balls, {:g} snapshots a second, acknowledged {:g} ms later, {:g} % lost",
                       request.count, request.rate_hz, request.delay_ms, 100.0 * request.loss);
}

}  // namespace

std::string command_of(const ReplicationRequest& request) {
    return fmt::format(
        "fts-lab replication --count {} --rate {:g} --delay-ms {:g} --loss {:g} --seconds {:g}",
        request.count, request.rate_hz, request.delay_ms, request.loss, request.seconds);
}

std::string table_of(const ReplicationRequest& request, const ReplicationStudy& study) {
    TextTable table({"coder", "bits/ball", "bytes", "datagrams", "usable", "encode us", "decode us",
                     "damaged", "shown"});
    for (const CoderRow& row : study.rows) {
        table.add({row.coder, fmt::format("{:.2f}", row.bits_per_ball),
                   fmt::format("{:.0f}", row.bytes_per_snapshot),
                   fmt::format("{:.2f}", row.datagrams),
                   fmt::format("{:.1f} %", 100.0 * row.usable),
                   fmt::format("{:.1f}", row.encode_us), fmt::format("{:.0f}", row.decode_us),
                   std::to_string(row.damaged), std::to_string(row.damaged_shown)});
    }
    std::string out = setting_text(request) + "\n\n" + table.text() + "\n";
    out += fmt::format(
        "  bits/ball  of a snapshot, all headers of the format included\n"
        "  usable     snapshots of which every datagram arrives\n"
        "  encode us  a client and snapshot, with what is encoded once shared by {} clients\n"
        "  decode us  a snapshot; both with the prediction, where there is one\n"
        "  damaged    snapshots with a byte altered or missing, and how many of them were shown\n",
        kStudyClients);
    out += fmt::format(
        "  Steps: height/4096, and ten of these a second; rms speed {:.3f} heights/s.\n",
        study.rms_speed_mps / kTraceHeightM);
    std::uint64_t decoded = 0, wrong = 0;
    for (const CoderRow& row : study.rows) {
        decoded += row.decoded;
        wrong += row.wrong;
    }
    out += fmt::format("  {} snapshots decoded and compared with the truth, {} of them wrong.\n",
                       decoded, wrong);
    out += "Again: " + command_of(request) + "\n";
    if (study.stopped()) out += fmt::format("stopped after {} of {}\n", study.done, study.of);
    return out;
}

std::string json_of(const ReplicationRequest& request, const ReplicationStudy& study) {
    nlohmann::ordered_json json = {{"count", request.count},
                                   {"rate_hz", request.rate_hz},
                                   {"delay_ms", request.delay_ms},
                                   {"loss", request.loss},
                                   {"seconds", request.seconds},
                                   {"unmeasured_s", kUnmeasuredS},
                                   {"clients", kStudyClients},
                                   {"rms_speed_heights_per_s", study.rms_speed_mps / kTraceHeightM},
                                   {"command", command_of(request)},
                                   {"snapshots", study.done},
                                   {"stopped", study.stopped()}};
    json["rows"] = nlohmann::ordered_json::array();
    for (const CoderRow& row : study.rows) {
        json["rows"].push_back({{"coder", row.coder},
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
    plot.subtitle =
        setting_text(request) + ". Further left fewer bits, further down less work for the server.";
    plot.footnote = command_of(request);
    plot.x = {"bits a ball and snapshot", Scale::kLog, {}, {}};
    plot.y = {"encoding, us a client and snapshot", Scale::kLog, {}, {}};
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
