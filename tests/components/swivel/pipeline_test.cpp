// The pipeline from end to end, as processes on the real wires.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "components/swivel/live/child_process.hpp"
#include "run_swivel.hpp"
#include "scratch_folder.hpp"
#include "tests/components/dds/test_participant.hpp"
#include "witness.hpp"

namespace swivel {
namespace {

nlohmann::json report_in(const std::string& folder) {
  return nlohmann::json::parse(content_of(folder + "/report.json"));
}

// Of what npm's packages read in an MCAP file.
nlohmann::json read_by_others(const ScratchFolder& scratch, const std::string& recording) {
  const std::string command = "cd " FOREIGN_READERS " && node read_mcap.mjs " + recording + " >" +
                              scratch.file("foreign.json");
  EXPECT_EQ(std::system(command.c_str()), 0);
  return nlohmann::json::parse(content_of(scratch.file("foreign.json")), nullptr, false);
}

// Issue 2: with the ring mean within 2 deg in mode 1 and 0.5 deg in mode 7, walls within 40 mm.
TEST(Pipeline, ScansTheBenchWithinThePapersAccuracy) {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("demo");
  ParticipantOptions options = loopback_participant("witness", domain_of_this_test());
  options.rig = "swivel";
  Participant participant(options);
  const Witness witness(participant);
  participant.start();
  const std::string recording = scratch.file("demo.mcap");
  const int code =
      run_swivel(scratch, "demo --modes 1,7 -o " + folder + " --domain " +
                              std::to_string(domain_of_this_test()) + " --record " + recording);
  ASSERT_EQ(code, 0) << content_of(scratch.file("out")) << content_of(scratch.file("err"));
  const auto sweeps = report_in(folder)["sweeps"];
  ASSERT_EQ(sweeps.size(), 2U);
  EXPECT_LT(std::abs(sweeps[0]["attitude_error_deg"].get<double>()), 2.0);
  EXPECT_LT(std::abs(sweeps[1]["attitude_error_deg"].get<double>()), 0.5);
  for (const auto& sweep : sweeps) {
    EXPECT_EQ(sweep["verdict"], "good");
    EXPECT_TRUE(sweep["complete"]);
    EXPECT_TRUE(sweep["alpha_calibrated"]);
    for (const auto& plane : sweep["largest_planes"]) {
      // 3 sd: 99.7 % of the points within 40 mm of their plane.
      EXPECT_LT(3.0 * plane["thickness_sd_mm"].get<double>(), 40.0);
    }
  }
  for (const char* name : {"cloud.pcd", "cloud.ply", "top_view.png", "density.png"}) {
    EXPECT_EQ(access((folder + "/" + name).c_str(), R_OK), 0) << name;
  }
  EXPECT_EQ(run_swivel(scratch, "check " + recording), 0) << content_of(scratch.file("out"));
  const auto topics = read_by_others(scratch, recording)["topics"];
  for (const auto& [name, published] : witness.topics().items()) {
    for (const auto& [key, value] : published.items())
      EXPECT_DOUBLE_EQ(topics[name][key].get<double>(), value.get<double>()) << name << " " << key;
  }
  EXPECT_EQ(topics["rt/swivel/cloud"]["messages"], 5) << "three of the calibration";
}

// Zeng 2018, live: the bias that the bench's lidar was given is found, and the next sweep stands as
// if there were none: its planes are as thin as the range noise, and where the room has them. All
// of it with keys and the shipped permissions, and recorded: nobody is denied what he needs.
TEST(Pipeline, CalibratesAndScansARigThatMeasuresItsAxis) {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("demo");
  const std::string keys = scratch.file("keys");
  const std::string recording = scratch.file("demo.mcap");
  ASSERT_EQ(run_swivel(scratch, "keys --rig zeng -o " + keys), 0)
      << content_of(scratch.file("err"));
  const int code =
      run_swivel(scratch, "demo --rig zeng --secure " + keys + " -o " + folder + " --record " +
                              recording + " --domain " + std::to_string(domain_of_this_test()));
  ASSERT_EQ(code, 0) << content_of(scratch.file("out")) << content_of(scratch.file("err"));
  const nlohmann::json report = report_in(folder);
  EXPECT_NEAR(report["bias_deg"].get<double>(), report["true_bias_deg"].get<double>(), 0.01);
  const auto& sweep = report["sweeps"].at(0);
  EXPECT_EQ(sweep["verdict"], "measured");
  EXPECT_TRUE(sweep["complete"]);
  EXPECT_LT(sweep["axis_error_rms_deg"].get<double>(), 0.5);  // on a loaded machine
  const auto& roof = sweep["largest_planes"].at(0);
  EXPECT_NEAR(roof["distance_m"].get<double>(), 2.0, 0.003);
  EXPECT_LT(roof["normal"][2].get<double>(), -0.99999);
  EXPECT_LT(roof["thickness_sd_mm"].get<double>(), 11.0);
  EXPECT_EQ(run_swivel(scratch, "check " + recording), 0) << content_of(scratch.file("out"));
}

// Live and recorded are two sources of the same stages.
TEST(Pipeline, ReplayedThroughTheParticipantsGivesWhatProcessGives) {
  const ScratchFolder scratch;
  const std::string recording = std::string(SWIVEL_TEST_DATA) + "/recordings/plate_period";
  ASSERT_EQ(run_swivel(scratch, "process " + recording + " -o " + scratch.file("processed") +
                                    " --no-clouds --no-pictures"),
            0)
      << content_of(scratch.file("err"));
  const auto processed = report_in(scratch.file("processed"))["sweeps"];
  ASSERT_GT(processed.size(), 0U);

  const std::string domain = std::to_string(domain_of_this_test());
  ParticipantOptions options = loopback_participant("pipeline_test", std::stoi(domain));
  options.rig = "swivel";
  Participant participant(options);
  std::mutex mutex;
  std::vector<msg::Attitude> attitudes;
  participant.subscribe<msg::Attitude>(kAttitudeTopic, [&](const msg::Attitude& attitude) {
    const std::lock_guard lock(mutex);
    attitudes.push_back(attitude);
  });
  participant.start();
  ChildProcess up("swivel", {"up", "--role", "workstation", "--domain", domain, "--log-level",
                             "warning", "--calibration", scratch.file("none.yaml")});
  ASSERT_EQ(run_swivel(scratch, "replay --max " + recording + " --domain " + domain), 0)
      << content_of(scratch.file("err"));
  ASSERT_TRUE(wait_until([&] {
    const std::lock_guard lock(mutex);
    return attitudes.size() >= processed.size();
  }));
  for (std::size_t i = 0; i < processed.size(); ++i) {
    EXPECT_EQ(attitudes[i].lines_missing(), 0U);
    EXPECT_NEAR(attitudes[i].beta_deg(), processed[i]["beta_deg"].get<double>(), 1e-9);
  }
}

}  // namespace
}  // namespace swivel
