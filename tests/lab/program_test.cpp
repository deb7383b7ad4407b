// fts-lab as people run it: what it writes, and how it ends.
#include "tests/lab/program.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/harness/process.h"
#include "tests/harness/temp_folder.h"

namespace fts::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Lab : public testing::Test {
  protected:
    std::string scene(const std::string& text) {
        const std::string file = folder_.file("given.scene");
        std::ofstream(file) << text;
        return file;
    }
    nlohmann::json json_of(std::vector<std::string> arguments) {
        const std::string file = folder_.file("out.json");
        arguments.insert(arguments.end(), {"--json", file});
        const Ended ended = lab(arguments);
        EXPECT_EQ(ended.code, 0) << ended.output;
        return nlohmann::json::parse(content_of(file), nullptr, false);
    }
    harness::TempFolder folder_;
};

TEST_F(Lab, run_says_everything_to_programs) {
    const auto json = json_of({"run", "gas-in-a-box", "--solver", "swept", "--scalar", "double",
                               "--rate", "60", "--seconds", "1"});
    for (const char* field :
         {"solver", "scalar", "bodies", "ticks", "collisions", "wall_collisions", "energy_initial",
          "energy_final", "momentum_initial", "momentum_final", "max_penetration_over_r",
          "overruns", "state_hash", "ns_per_body_tick", "collisions_per_s"}) {
        EXPECT_TRUE(json.contains(field)) << field;
    }
    EXPECT_EQ(json["solver"], "swept");
    EXPECT_EQ(json["scalar"], "double");
    EXPECT_EQ(json["bodies"], 500);
    EXPECT_EQ(json["ticks"], 60);
    EXPECT_GT(json["collisions"], 100);
    EXPECT_NEAR(json["energy_initial"].get<double>(), 250.0, 1e-9);
    EXPECT_NEAR(json["energy_final"].get<double>(), 250.0, 1e-9);
    EXPECT_EQ(json["momentum_final"].size(), 2U);
    EXPECT_EQ(json["state_hash"].get<std::string>().size(), 16U);
    EXPECT_LT(json["max_penetration_over_r"], 1e-12);
}

TEST_F(Lab, run_runs_every_solver_in_both_precisions) {
    for (const std::string solver : {"seed", "discrete", "swept", "event", "auto"}) {
        for (const std::string scalar : {"float", "double"}) {
            SCOPED_TRACE(solver + " " + scalar);
            const auto json = json_of({"run", "gas-in-a-box", "--solver", solver, "--scalar",
                                       scalar, "--substeps", "2", "--seconds", "0.25"});
            EXPECT_GT(json["collisions"], 10);
            EXPECT_EQ(json["scalar"], scalar);
            if (solver != "auto") {
                EXPECT_EQ(json["solver"], solver);
            }
        }
    }
}

TEST_F(Lab, run_repeats_itself_to_the_bit) {
    const std::vector<std::string> arguments = {"run", "periodic-gas", "--seconds", "0.5"};
    EXPECT_EQ(json_of(arguments)["state_hash"], json_of(arguments)["state_hash"]);
}

TEST_F(Lab, run_ends_where_it_was_told_to_though_ticks_do_not_fit) {
    const auto json = json_of({"run", "head-on", "--rate", "7", "--seconds", "1.5"});
    EXPECT_EQ(json["ticks"], 11);
    EXPECT_EQ(json["seconds"], 1.5);
}

TEST_F(Lab, run_writes_a_row_for_each_body_and_sample) {
    const std::string csv = folder_.file("out.csv");
    const Ended ended = lab({"run", "right-angle", "--seconds", "4", "--csv", csv});
    EXPECT_EQ(ended.code, 0) << ended.output;
    std::istringstream rows(content_of(csv));
    std::string row, last;
    std::getline(rows, row);
    EXPECT_EQ(row, "time_s,body,x_m,y_m,vx_mps,vy_mps");
    int count = 0;
    while (std::getline(rows, row)) {
        if (++count == 1) {
            EXPECT_EQ(row, "0,0,-2,0.6,1,0");
        }
        last = row;
    }
    EXPECT_EQ(count, 2 * 241);
    EXPECT_EQ(last.substr(0, 4), "4,1,");
    lab({"run", "right-angle", "--seconds", "4", "--csv", csv, "--csv-rate", "2"});
    const std::string sparse = content_of(csv);
    EXPECT_EQ(std::count(sparse.begin(), sparse.end(), '\n'), 1 + 2 * 9);
}

TEST_F(Lab, run_does_not_lose_the_time_that_an_overrun_leaves) {
    std::string text = "walls { min { x: -1 y: -1 } max { x: 2 y: 1 } }\n";
    text += "body { position { x: 0 y: 0 } velocity { x: 9e8 } radius: 0.5 }\n";
    const auto json = json_of({"run", scene(text), "--seconds", "0.001", "--rate", "1000"});
    EXPECT_GT(json["overruns"], 1);
    EXPECT_NEAR(json["wall_collisions"].get<double>(), 9e8 * 0.001 / 2.0, 2.0);
}

TEST_F(Lab, run_puts_json_on_the_terminal_when_told_to) {
    EXPECT_THAT(lab({"run", "head-on", "--seconds", "1", "--json", "-"}).output,
                HasSubstr("\"solver\": \"swept\""));
    const Ended both = lab({"run", "head-on", "--seconds", "1", "--json", "-", "--csv", "-"});
    EXPECT_THAT(both.output, HasSubstr("give one of them a file"));
}

TEST_F(Lab, refuses_scenes_with_field_value_and_remedy) {
    const std::pair<std::string, std::string> cases[] = {
        {"body { radius: nan }", "body[0].radius is nan; give a radius from"},
        {"body { radius: inf }", "body[0].radius is inf; give a radius from"},
        {"body { radius: -1 }", "body[0].radius is -1; give a radius from"},
        {"body { radius: 0 }", "body[0].radius is 0; give a radius from"},
        {"body { mass: nan }", "body[0].mass is nan; give a mass from"},
        {"body { mass: -inf }", "body[0].mass is -inf; give a mass from"},
        {"body { mass: -1 }", "body[0].mass is -1; give a mass from"},
        {"body { mass: 0 }", "body[0].mass is 0; give a mass from"},
        {"body { position { x: nan } }", "body[0].position is (nan, 0); give finite"},
        {"body { colour: 3 }", "'colour' is unknown in Body; give position, velocity"},
        {"generator { count: 100 packing_fraction: 0.95 }",
         "generator.packing_fraction is 0.95; give a number above 0 and at most 0.9068"},
        {"generator { count: 100 packing_fraction: 0.9 }",
         "generator.packing_fraction is 0.9; 100 equal balls fill a square to"},
    };
    for (const auto& [text, message] : cases) {
        const std::string file = scene(text);
        for (const std::string command : {"run", "plan"}) {
            const std::string option = command == "run" ? "--seconds" : "--tolerance";
            const Ended ended = lab({command, file, option, "0.1"});
            EXPECT_EQ(ended.code, 2) << text;
            EXPECT_THAT(ended.output,
                        AllOf(HasSubstr("fts-lab: " + file + ":1:"), HasSubstr(message)));
        }
    }
}

TEST_F(Lab, refuses_options_that_make_no_sense) {
    EXPECT_EQ(lab({}).code, 2);
    EXPECT_EQ(lab({"run", "head-on"}).code, 2);
    EXPECT_EQ(lab({"run", "head-on", "--seconds", "-1"}).code, 2);
    EXPECT_EQ(lab({"run", "head-on", "--seconds", "nan"}).code, 2);
    EXPECT_EQ(lab({"run", "head-on", "--seconds", "1", "--solver", "magic"}).code, 2);
    EXPECT_EQ(lab({"run", "head-on", "--seconds", "1", "--substeps", "0"}).code, 2);
    EXPECT_EQ(lab({"run", "head-on", "--seconds", "1", "--rate", "0"}).code, 2);
    EXPECT_THAT(lab({"run", "no-such-scene", "--seconds", "1"}).output,
                HasSubstr("one of: criss-cross, "));
}

TEST_F(Lab, says_before_the_run_that_a_file_cannot_be_written) {
    for (const std::string option : {"--json", "--csv"}) {
        const Ended ended =
            lab({"run", "gas-in-a-box", "--seconds", "1e9", option, "/no/such/folder/file"});
        EXPECT_EQ(ended.code, 1);
        EXPECT_THAT(ended.output, AllOf(HasSubstr("/no/such/folder/file"), HasSubstr(option)));
    }
}

TEST_F(Lab, an_interruption_ends_a_run_with_what_there_is) {
    const std::string json = folder_.file("out.json");
    const std::string csv = folder_.file("out.csv");
    harness::Process process(FTS_LAB_PROGRAM, {"run", "gas-in-a-box", "--seconds", "1e6", "--json",
                                               json, "--csv", csv, "--csv-rate", "1"});
    while (content_of(csv).empty()) usleep(10'000);
    process.signal(SIGINT);
    EXPECT_EQ(process.wait(60.0), 130);
    EXPECT_THAT(process.output(), HasSubstr("stopped before its end"));
    EXPECT_EQ(nlohmann::json::parse(content_of(json))["stopped"], true);
}

TEST_F(Lab, plan_names_a_solver_and_why) {
    const auto json = json_of({"plan", "gas-in-a-box", "--tolerance", "0.01"});
    for (const char* field : {"solver", "scalar", "substeps", "broadphase", "error_bound",
                              "meets_tolerance", "reason"}) {
        EXPECT_TRUE(json.contains(field)) << field;
    }
    EXPECT_EQ(json["meets_tolerance"], true);
    EXPECT_LE(json["error_bound"], 0.01);
    EXPECT_THAT(lab({"plan", "gas-in-a-box", "--tolerance", "0.01"}).output,
                HasSubstr(json["reason"].get<std::string>()));
    EXPECT_EQ(lab({"plan", "gas-in-a-box", "--tolerance", "-1"}).code, 2);
    EXPECT_EQ(lab({"plan", "gas-in-a-box", "--tolerance", "nan"}).code, 2);
}

}  // namespace
}  // namespace fts::lab
