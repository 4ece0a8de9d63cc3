// The program as a user runs it: what it writes, what it says, how it ends.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "calibration/units.hpp"
#include "scratch_folder.hpp"

namespace swivel {
namespace {

using testing::HasSubstr;

struct Ended {
  int code;
  std::string out;
  std::string err;
};

Ended run(const ScratchFolder& scratch, const std::string& arguments) {
  const std::string command =
      SWIVEL_PROGRAM " " + arguments + " >" + scratch.file("out") + " 2>" + scratch.file("err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(scratch.file("out")),
          content_of(scratch.file("err"))};
}

std::string recording(const std::string& name) {
  return std::string(SWIVEL_TEST_DATA) + "/recordings/" + name;
}

std::vector<std::vector<std::string>> csv(const std::string& path) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(content_of(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

std::map<std::string, double> truth_of(const std::string& name) {
  std::map<std::string, double> truth;
  for (const auto& row : csv(recording(name) + "/truth.csv"))
    if (row.size() == 2) truth[row[0]] = std::atof(row[1].c_str());
  return truth;
}

TEST(Process, FindsTheAttitudeOfAPlateCaseWithinThePapersAccuracy) {
  const ScratchFolder scratch;
  const Ended ended =
      run(scratch, "process " + recording("plate_period") + " -o " + scratch.file("out_dir"));
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto rows = csv(scratch.file("out_dir/attitude.csv"));
  auto truth = truth_of("plate_period");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"sweep", "mode", "beta_deg", "phi_offset_deg",
                                               "sigma_deg", "verdict"}));
  for (std::size_t sweep = 0; sweep < 2; ++sweep) {
    const auto& row = rows[sweep + 1];
    EXPECT_EQ(row[0], std::to_string(sweep));
    EXPECT_EQ(row[1], "1");
    EXPECT_EQ(row[5], "good");
    const double true_deg = truth["sweep" + std::to_string(sweep) + "_phi_start_deg"];
    EXPECT_NEAR(std::stod(row[3]), true_deg, 2.0) << "as the issue asks of mode 1";
    EXPECT_NEAR(std::stod(row[2]) + std::stod(row[3]), 30.0, 1e-5) << "eq. 10, alpha as drawn";
    EXPECT_GT(std::stod(row[4]), 0.0);
  }
}

TEST(Map, DrawsEverySweepFromAboveAndClose) {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("maps");
  const Ended ended = run(scratch, "map " + recording("plate_period") + " -o " + folder);
  ASSERT_EQ(ended.code, 0) << ended.err;
  for (const char* kind : {"top_view", "density", "surfaces", "seam", "plate"}) {
    for (const char* sweep : {"_00.png", "_01.png"})
      EXPECT_GT(std::filesystem::file_size(folder + "/" + kind + sweep), 10000U) << kind;
  }
  EXPECT_FALSE(std::filesystem::exists(folder + "/cloud_00.pcd"));
}

TEST(Process, WritesCloudsPicturesAndAReport) {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("deep/out_dir");
  ASSERT_EQ(run(scratch, "process " + recording("plate_period") + " -o " + folder).code, 0);
  for (const char* name : {"cloud_00.pcd", "cloud_01.ply", "top_view_00.png", "density_01.png"})
    EXPECT_GT(std::filesystem::file_size(folder + "/" + name), 10000U) << name;
  const auto report = nlohmann::json::parse(content_of(folder + "/report.json"));
  EXPECT_NEAR(report["scan_period_ms"], 25.059091, 0.005);
  ASSERT_EQ(report["sweeps"].size(), 2U);
  const auto& sweep = report["sweeps"][0];
  EXPECT_EQ(sweep["lines_missing"], 0);
  EXPECT_EQ(sweep["complete"], true);
  EXPECT_EQ(sweep["points"].get<int>() + sweep["invalid_points_left_out_of_ply"].get<int>(),
            40 * 1081);
  ASSERT_GE(sweep["largest_planes"].size(), 3U);
  for (const auto& plane : sweep["largest_planes"]) EXPECT_LT(plane["thickness_sd_mm"], 17.0);
}

TEST(Process, TwiceTheSameGivesTheSame) {
  const ScratchFolder scratch;
  const std::string process = "process " + recording("plate_period") + " -o ";
  ASSERT_EQ(run(scratch, process + scratch.file("a")).code, 0);
  ASSERT_EQ(run(scratch, process + scratch.file("b")).code, 0);
  for (const char* name : {"attitude.csv", "cloud_01.pcd", "report.json"})
    EXPECT_EQ(content_of(scratch.file("a/") + name), content_of(scratch.file("b/") + name)) << name;
}

TEST(Process, TheTiltingRigIsMeasured) {
  const ScratchFolder scratch;
  const Ended ended = run(scratch, "process " + recording("tilting_room_turning.csv.gz") + " -o " +
                                       scratch.path() + " --no-clouds --no-pictures");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto rows = csv(scratch.file("attitude.csv"));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1][5], "measured");
  EXPECT_EQ(rows[1][2], "nan");
  EXPECT_EQ(std::stod(rows[1][3]), 0.0);
  EXPECT_FALSE(std::filesystem::exists(scratch.file("cloud_00.pcd")));
  EXPECT_FALSE(std::filesystem::exists(scratch.file("top_view_00.png")));
}

TEST(Process, ACalibrationMovesTheAttitudeByItsAlpha) {
  const ScratchFolder scratch;
  std::ofstream(scratch.file("calibration.yaml"))
      << "rig: swivel\ndate: \"2026-01-01\"\ntime_ns: 1\nalpha_deg: 29.5\nalpha_sigma_deg: 0\n"
         "bias_deg: 0\nmounting_xyz_mm: [0, 0, 0]\nmounting_rpy_deg: [0, 0, 0]\n"
         "residual_deg: 0\nsweeps_used: 5\nmode: 7\nserial_number: \"\"\nfirmware: \"\"\n"
         "provenance: \"\"\ncovariance: [0"
      <<
      [] {
        std::string zeros;
        for (int value = 1; value < 64; ++value) zeros += ", 0";
        return zeros;
      }()
      << "]\n";
  const std::string process =
      "process " + recording("plate_period") + " --no-clouds --no-pictures -o ";
  ASSERT_EQ(run(scratch, process + scratch.file("drawn")).code, 0);
  const Ended ended = run(scratch, process + scratch.file("calibrated") + " --calibration " +
                                       scratch.file("calibration.yaml"));
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto drawn = csv(scratch.file("drawn/attitude.csv"));
  const auto calibrated = csv(scratch.file("calibrated/attitude.csv"));
  EXPECT_NEAR(std::stod(calibrated[1][3]) - std::stod(drawn[1][3]), -0.5, 1e-5);
}

TEST(Report, JudgesACaseAgainstItsTruthOnAPageOfItsOwn) {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("out_dir");
  const Ended ended = run(scratch, "report " + recording("plate_period") + " -o " + folder);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto report = nlohmann::json::parse(content_of(folder + "/report.json"));
  const auto& evaluation = report["evaluation"];
  auto truth = truth_of("plate_period");
  EXPECT_EQ(evaluation["verdicts"]["good"], 2);
  EXPECT_NEAR(evaluation["true_alpha_deg"], truth["alpha_deg"], 1e-6);
  double largest_deg = 0.0;
  for (std::size_t sweep = 0; sweep < 2; ++sweep) {
    const double start_deg = truth["sweep" + std::to_string(sweep) + "_phi_start_deg"];
    const double offset_deg = report["sweeps"][sweep]["phi_offset_deg"];
    const auto& errors = evaluation["sweeps"][sweep];
    EXPECT_NEAR(errors["phi_error_without_correction_deg"], start_deg, 1e-6);
    EXPECT_NEAR(errors["phi_error_with_correction_deg"], start_deg - offset_deg, 1e-6);
    largest_deg = std::max(largest_deg, std::abs(start_deg - offset_deg));
    for (const auto& surface : report["sweeps"][sweep]["surfaces"]) {
      EXPECT_LT(surface["sd_mm"], 20.0);
      EXPECT_GT(surface["within_40_mm_percent"], 95.0);
    }
  }
  const auto& mode = evaluation["modes"][0];
  EXPECT_NEAR(mode["map_error_mm_at_0_to_10_m"][4], 4000.0 * std::tan(largest_deg * kPi / 180.0),
              1e-3);
  const std::string page = content_of(folder + "/report.html");
  for (const char* name : {"phi_error_sweeps.png", "phi_error_modes.png", "map_error.png"})
    EXPECT_GT(std::filesystem::file_size(folder + "/" + name), 5000U) << name;
  for (const char* name : {"surfaces_00.png", "seam_01.png", "plate_01.png", "top_view_00.png"})
    EXPECT_GT(std::filesystem::file_size(folder + "/" + name), 10000U) << name;
  std::size_t pictures = 0;
  for (auto at = page.find("data:image/png"); at != std::string::npos;
       at = page.find("data:image/png", at + 1))
    ++pictures;
  EXPECT_EQ(pictures, 7U) << "three of all sweeps, four of the worst of mode 1";
}

TEST(Report, WithoutATruthJudgesByTheWallsAndSaysSo) {
  const ScratchFolder scratch;
  const std::string copy = scratch.file("case");
  std::filesystem::copy(recording("plate_period"), copy);
  std::filesystem::remove(copy + "/truth.csv");
  const Ended ended = run(scratch, "report " + copy + " -o " + scratch.file("out_dir"));
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto report = nlohmann::json::parse(content_of(scratch.file("out_dir/report.json")));
  const auto& evaluation = report["evaluation"];
  EXPECT_THAT(evaluation["phi_error_is_against"].get<std::string>(), HasSubstr("median"));
  auto truth = truth_of("plate_period");
  std::vector<double> by_walls, by_truth;
  for (std::size_t sweep = 0; sweep < 2; ++sweep) {
    by_walls.push_back(evaluation["sweeps"][sweep]["phi_error_with_correction_deg"]);
    by_truth.push_back(truth["sweep" + std::to_string(sweep) + "_phi_start_deg"] -
                       report["sweeps"][sweep]["phi_offset_deg"].get<double>());
  }
  EXPECT_NEAR(by_walls[0] - by_walls[1], by_truth[0] - by_truth[1], 0.05);
}

TEST(Report, OfAMeasuredAxisHasItsSurfacesAndNoPhiError) {
  const ScratchFolder scratch;
  const Ended ended =
      run(scratch, "report " + recording("tilting_room_turning.csv.gz") + " -o " + scratch.path());
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto report = nlohmann::json::parse(content_of(scratch.file("report.json")));
  EXPECT_TRUE(report["evaluation"]["axis_measured"]);
  EXPECT_FALSE(report["evaluation"].contains("modes"));
  EXPECT_EQ(report["evaluation"]["verdicts"]["measured"], 2);
  EXPECT_FALSE(report["sweeps"][0]["surfaces"].empty());
  const std::string page = content_of(scratch.file("report.html"));
  EXPECT_THAT(page, HasSubstr("has no plate and nothing to correct"));
  EXPECT_THAT(page, testing::Not(HasSubstr("fig. 9")));
  EXPECT_FALSE(std::filesystem::exists(scratch.file("plate_00.png")));
}

TEST(Report, ShowsWhatEachStepOfACalibrationDoesToTheRoof) {
  const ScratchFolder scratch;
  const Ended ended = run(scratch, "report " + recording("pan_sparse") + " -o " + scratch.path());
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto report = nlohmann::json::parse(content_of(scratch.file("report.json")));
  const auto& mean_mm = report["sweeps"][0]["mounting"]["roof_mean_deviation_mm"];
  EXPECT_NEAR(mean_mm["both"], 7.0, 0.7) << "a noise of 10 mm, 30 deg off the axis";
  EXPECT_LT(mean_mm["bias alone"], 8.0) << "this rig is off by its bias only";
  EXPECT_GT(mean_mm["as the rig file has it"], 30.0) << "4 deg";
  EXPECT_GT(mean_mm["mounting without the bias"], 2.0 * mean_mm["both"].get<double>());
  for (const char* name : {"roof_00.png", "roof_deviations_00.png", "bias.png"})
    EXPECT_GT(std::filesystem::file_size(scratch.file(name)), 5000U) << name;
  EXPECT_THAT(content_of(scratch.file("report.html")), HasSubstr("fig. 11"));
}

struct Refusal {
  std::string arguments;
  int code;
  std::string words;
};

TEST(Refusals, EndWithTheirCodeAndOneLineThatSaysWhatToDo) {
  const ScratchFolder scratch;
  std::ofstream(scratch.file("in_the_way")) << "a file";
  std::ofstream(scratch.file("garbage.csv")) << "garbage\n";
  const std::string out = " -o " + scratch.file("out_dir");
  for (const Refusal& refusal : std::vector<Refusal>{
           {"process /nowhere" + out, 66, "/nowhere"},
           {"process " + scratch.file("garbage.csv") + out, 65, "garbage.csv:1"},
           {"process " + recording("corridor.csv.gz") + out, 65, "no axis angle"},
           {"process " + recording("pan_sparse") + out + " --rig " SWIVEL_CONFIG "/rigs/yuan.yaml",
            65, "--rig"},
           {"process " + recording("pan_sparse") + out + " --rig /nowhere.yaml", 78, "nowhere"},
           {"process " + recording("pan_sparse") + " -o " + scratch.file("in_the_way/out"), 73,
            "in_the_way"},
           {"report /nowhere" + out, 66, "/nowhere"},
           {"report " + recording("corridor.csv.gz") + out, 65, "no axis angle"},
           {"report " + recording("plate_period") + out + " --truth /nowhere.csv", 66, "nowhere"},
           {"report live --calibration x.yaml" + out, 64, "live"},
           {"view --listen robot.local", 64, "no IP address"},
           {"view --token short", 64, "16 or more"},
           {"view --listen 0.0.0.0 --port 0 --token-file /nowhere/token", 73, "/nowhere/token"},
           {"view --listen 203.0.113.1 --token 0123456789abcdef", 69, "--port"},
           {"calibrate alpha " + recording("pan_sparse") + out, 78, "plate"},
           {"calibrate alpha " + recording("plate_period") + out, 65, "sweeps"},
           {"calibrate mounting /nowhere" + out, 66, "/nowhere"},
           {"calibrate mounting " + recording("corridor.csv.gz") + out, 65, "no axis angle"}}) {
    const Ended ended = run(scratch, refusal.arguments);
    EXPECT_EQ(ended.code, refusal.code) << refusal.arguments;
    EXPECT_THAT(ended.err, HasSubstr(refusal.words));
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  }
}

TEST(CalibrateMounting, OfARecordingIsTheTruthAndMakesItsCloudsFlat) {
  const ScratchFolder scratch;
  const std::string out = scratch.file("mounting");
  const Ended ended =
      run(scratch, "calibrate mounting " + recording("pan_sparse") + " --per-sweep -o " + out);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto sweeps = nlohmann::json::parse(content_of(out + "/mounting.json"))["sweeps"];
  auto truth = truth_of("pan_sparse");
  ASSERT_EQ(sweeps.size(), 1U);
  const auto& sweep = sweeps[0];
  EXPECT_EQ(sweep["sweep"], 0);
  EXPECT_NEAR(sweep["bias_deg"], -truth["sweep0_obs_rx_deg"], 0.005);
  EXPECT_NEAR(sweep["ry_deg"], truth["sweep0_obs_ry_deg"],
              4.0 * sweep["ry_sigma_deg"].get<double>());
  EXPECT_NEAR(sweep["tx_mm"], truth["sweep0_obs_tx_mm"], 4.0 * sweep["tx_sigma_mm"].get<double>());
  EXPECT_NEAR(sweep["ty_mm"], truth["sweep0_obs_ty_mm"], 4.0 * sweep["ty_sigma_mm"].get<double>());
  EXPECT_EQ(sweep["unobservable"], nlohmann::json({"rz", "tz"}));

  const auto thickness_mm = [&](const std::string& options) {
    const std::string process = "process " + recording("pan_sparse") + " --no-clouds --no-pictures";
    EXPECT_EQ(run(scratch, process + " -o " + scratch.file("clouds") + options).code, 0);
    const auto report = nlohmann::json::parse(content_of(scratch.file("clouds/report.json")));
    return report["sweeps"][0]["largest_planes"][0]["thickness_sd_mm"].get<double>();
  };
  const std::string calibration = " --calibration " + out + "/calibration.yaml";
  EXPECT_LT(thickness_mm(calibration), 10.0) << "the noise";
  EXPECT_GT(thickness_mm(""), 12.0) << "a bias of 4 deg bends walls and roof";

  const Ended refused = run(scratch, "process " + recording("plate_period") + calibration + " -o " +
                                         scratch.file("other"));
  EXPECT_EQ(refused.code, 65);
  EXPECT_THAT(refused.err, HasSubstr("zeng")) << "a calibration of another rig";
}

// A real rig, of which a few lines before and after the turn show its play and nothing else.
TEST(CalibrateMounting, FindsThePlayOfARealAxisAndProcessTakesItOut) {
  const ScratchFolder scratch;
  const std::string turning = recording("tilting_room_turning.csv.gz");
  const std::string out = scratch.file("mounting");
  const Ended ended = run(scratch, "calibrate mounting " + turning + " -o " + out);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto found = nlohmann::json::parse(content_of(out + "/mounting.json"))["sweeps"][0];
  EXPECT_GT(found["hysteresis_deg"], 0.05);
  EXPECT_LT(found["hysteresis_deg"], 0.15);
  EXPECT_LT(found["hysteresis_sigma_deg"], 0.06);
  EXPECT_LT(found["views_apart_mm"].get<double>(),
            0.95 * found["views_apart_nominal_mm"].get<double>());
  EXPECT_LT(found["largest_planes_mm"], found["largest_planes_nominal_mm"]);
  const auto down = [&](const std::string& options) {
    const std::string process =
        "process " + turning + " --no-pictures -o " + scratch.file("clouds");
    EXPECT_EQ(run(scratch, process + options).code, 0);
    return content_of(scratch.file("clouds/cloud_01.ply"));
  };
  EXPECT_NE(down(""), down(" --calibration " + out + "/calibration.yaml"));
}

TEST(Refusals, WrongUsageIs64) {
  const ScratchFolder scratch;
  for (const char* arguments : {"", "fly", "process", "process x", "process x -o y --fly", "report",
                                "report x", "calibrate", "calibrate beta x -o y"})
    EXPECT_EQ(run(scratch, arguments).code, 64) << arguments;
  EXPECT_EQ(run(scratch, "--help").code, 0);
  EXPECT_THAT(run(scratch, "--version").out, HasSubstr("swivel "));
}

}  // namespace
}  // namespace swivel
