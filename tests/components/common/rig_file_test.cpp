// Every shipped rig file loads; a folder of bad ones, one file one fault, does not.
#include "components/common/rig_file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "components/common/strict_yaml.hpp"

namespace swivel {
namespace {

namespace fs = std::filesystem;

std::set<std::string> files_in(const std::string& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") files.insert(entry.path());
  }
  return files;
}

std::string refusal(const std::string& path) {
  try {
    load_rig_file(path);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "it was taken";
}

TEST(RigFiles, EveryShippedOneLoads) {
  const auto files = files_in(std::string(SWIVEL_CONFIG) + "/rigs");
  EXPECT_GE(files.size(), 3U);
  for (const std::string& path : files) {
    RigFile rig;
    EXPECT_NO_THROW(rig = load_rig_file(path)) << path;
    EXPECT_FALSE(rig.rig.empty());
    EXPECT_FALSE(rig.modes.lines.empty());
    EXPECT_TRUE(rig.axis_measured || rig.plate) << path;
  }
}

TEST(RigFiles, YuansIsThePapersRig) {
  const RigFile rig = load_rig_file(std::string(SWIVEL_CONFIG) + "/rigs/yuan.yaml");
  const std::map<int, int> table_1{{1, 40},  {2, 80},  {3, 160}, {4, 200},
                                   {5, 320}, {6, 400}, {7, 640}};
  EXPECT_EQ(rig.modes.lines, table_1);
  EXPECT_EQ(rig.modes.sweep_angle_deg, 180.0);
  EXPECT_NEAR(rig.geometry.T_axis_lidar.translation().x(), 0.0139, 1e-12);
  ASSERT_TRUE(rig.plate);
  EXPECT_NEAR(rig.plate->ring_inner_m, 0.0625, 1e-12);
  EXPECT_NEAR(rig.plate->ring_outer_m, 0.1155, 1e-12);
}

TEST(RigFiles, EveryKeyMeansWhatItSays) {
  const RigFile rig = load_rig_file(std::string(SWIVEL_TEST_DATA) + "/config/valid/every_key.yaml");
  EXPECT_EQ(rig.rig, "unlike_1");
  ASSERT_TRUE(rig.lidar);
  EXPECT_EQ(rig.lidar->address, "tcp://10.0.0.1:10940");
  EXPECT_FALSE(rig.lidar->intensities);
  EXPECT_FALSE(rig.lidar->stamp_at_rear_centre);
  ASSERT_TRUE(rig.stepper);
  EXPECT_EQ(rig.stepper->home_angle_deg, -71.0);
  EXPECT_EQ(rig.stepper->cable_limit_deg, 331.0);
  EXPECT_EQ(rig.stepper->max_speed_deg_s, 200.0);
  EXPECT_EQ(rig.stepper->return_speed_deg_s, 91.0);
  EXPECT_EQ(rig.stepper->settle_s, 0.25);
  EXPECT_EQ(rig.stepper->minimum_step_rate_hz, 31.0);
  EXPECT_EQ(rig.timing, Timing::kEq7);
  EXPECT_EQ(rig.estimator, "other");
  EXPECT_EQ(rig.modes.lines, (std::map<int, int>{{2, 81}, {200, 20000}}));
  EXPECT_DOUBLE_EQ(rig.modes.line_period_s, 0.026);
  EXPECT_NEAR(rig.geometry.bias_rad, rad_from_deg(1.5), 1e-15);
  // Turned about the fixed X, then Y, then Z.
  const Eigen::Isometry3d expected =
      Eigen::Translation3d(0.001, -0.002, 0.003) *
      Eigen::AngleAxisd(rad_from_deg(30.0), Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(rad_from_deg(20.0), Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(rad_from_deg(10.0), Eigen::Vector3d::UnitX());
  EXPECT_TRUE(rig.geometry.T_base_axis.isApprox(expected, 1e-12));
  EXPECT_NEAR(rig.geometry.T_axis_lidar.translation().z(), 0.006, 1e-12);
  ASSERT_TRUE(rig.plate);
  EXPECT_NEAR(rig.plate->alpha_rad, rad_from_deg(31.0), 1e-12);
  EXPECT_NEAR(rig.plate->base_distance_m, 0.055, 1e-12);
  EXPECT_NEAR(rig.plate->hypotenuse_m, 0.113, 1e-12);
  EXPECT_NEAR(rig.plate->depth_m, 0.061, 1e-12);
  EXPECT_NEAR(rig.plate->ring_inner_m, 0.063, 1e-12);
  EXPECT_NEAR(rig.plate->ring_outer_m, 0.116, 1e-12);
  EXPECT_NEAR(rig.plate->ring_thickness_m, 0.021, 1e-12);
}

bool names_file_and_line(const std::string& said, const std::string& path) {
  if (said.find(path + ":") != 0) return false;
  const std::size_t after_line = said.find_first_not_of("0123456789", path.size() + 1);
  return after_line > path.size() + 1 && said.compare(after_line, 2, ": ") == 0;
}

// The first line of each says what its refusal must hold: "# expect: words".
TEST(RigFiles, EveryBadOneIsRefusedByFileAndLine) {
  const auto files = files_in(std::string(SWIVEL_TEST_DATA) + "/config/invalid");
  EXPECT_GE(files.size(), 15U);
  for (const std::string& path : files) {
    std::ifstream file(path, std::ios::binary);
    std::string first;
    std::getline(file, first);
    ASSERT_EQ(first.substr(0, 10), "# expect: ") << path;
    const std::string said = refusal(path);
    EXPECT_NE(said.find(first.substr(10)), std::string::npos) << path << "\n  said: " << said;
    EXPECT_TRUE(names_file_and_line(said, path)) << said;
  }
}

class WrittenFile : public testing::Test {
 public:
  ~WrittenFile() override { fs::remove(path_); }

  std::string refusal_of(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return refusal(path_);
  }

  const std::string path_ =
      fs::temp_directory_path() / ("swivel_rig_" + std::to_string(getpid()) + ".yaml");
};

TEST_F(WrittenFile, AnEmptyOneIsRefused) {
  EXPECT_EQ(refusal_of(""), path_ + ":1: the file is empty");
  EXPECT_NE(refusal_of(" \n\n").find(path_ + ":"), std::string::npos);
}

TEST_F(WrittenFile, EndlessNestingIsRefusedAndDoesNotEndTheProgram) {
  for (const std::string opening : {"[", "{a: ", "- ", "? ", "!a ", "a:\n "}) {
    std::string text;
    while (text.size() < 200'000) text += opening;
    EXPECT_NE(refusal_of(text), "it was taken") << opening;
  }
}

TEST_F(WrittenFile, ALargeOneIsRefused) {
  EXPECT_NE(refusal_of(std::string(2 << 20, '#')).find("1 MiB"), std::string::npos);
}

// Bytes changed by chance: refused with a reason, or a rig; never anything else.
TEST_F(WrittenFile, DamagedBytesDoNoHarm) {
  std::ifstream file(std::string(SWIVEL_CONFIG) + "/rigs/yuan.yaml", std::ios::binary);
  std::ostringstream text_of_it;
  text_of_it << file.rdbuf();
  const std::string whole = text_of_it.str();
  unsigned state = 12345;
  const auto random = [&state] { return state = state * 1664525U + 1013904223U, state >> 8U; };
  int refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::string text = whole;
    for (int change = 0; change < 3; ++change)
      text[random() % text.size()] = static_cast<char>(random());
    const std::string said = refusal_of(text);
    refused += said == "it was taken" ? 0 : 1;
    ASSERT_TRUE(said == "it was taken" || said.find(path_) == 0) << said;
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace swivel
