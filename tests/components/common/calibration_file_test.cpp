#include "components/common/calibration_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "components/common/strict_yaml.hpp"

namespace swivel {
namespace {

namespace fs = std::filesystem;

class CalibrationFile : public testing::Test {
 public:
  CalibrationFile() { fs::create_directories(folder_); }
  ~CalibrationFile() override {
    std::error_code error;
    fs::remove_all(folder_, error);
  }

  std::string write(const std::string& text) {
    const std::string path = folder_ / "written.yaml";
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("swivel_calibration_" + std::to_string(getpid()));
};

// Numbers without a short decimal form; words that YAML would stumble over.
msg::Calibration awkward_calibration() {
  msg::Calibration calibration;
  calibration.rig("swivel");
  calibration.time_ns(1'700'000'000'123'456'789);
  calibration.alpha_deg(88.0 / 3.0);
  calibration.bias_deg(-1.0 / 7.0);
  calibration.mounting_xyz_mm({13.9, -0.1 / 3.0, 1e-17});
  calibration.mounting_rpy_deg({0.1, 0.2, -180.0});
  calibration.hysteresis_deg(1.0 / 7.0);
  calibration.hysteresis_sigma_deg(0.01 / 3.0);
  for (std::size_t index = 0; index < calibration.covariance().size(); ++index) {
    calibration.covariance()[index] = 1.0 / (3.0 + static_cast<double>(index));
  }
  calibration.residual_deg(0.0437);
  calibration.chi_square(100.0 / 7.0);
  calibration.degrees_of_freedom(16);
  calibration.plate_shape({0.1, -1.0 / 3.0, 0.3, 1.9, 0.08, -2.0 / 7.0});
  calibration.plate_shape_sigma({0.1, 0.05, 0.05, 0.1, 0.06, 0.4});
  calibration.plate_residual_mm(13.0 / 3.0);
  calibration.sweeps_used(50);
  calibration.mode(7);
  calibration.serial_number("H1\"23\\4: #x");
  calibration.firmware("3.02 {a: [b]}");
  calibration.provenance("four walls, it's \ttold");
  return calibration;
}

TEST_F(CalibrationFile, ComesBackExactly) {
  const std::string path = folder_ / "new" / "folder" / "rig.yaml";
  const msg::Calibration saved = awkward_calibration();
  ASSERT_EQ(save_calibration(saved, path), "");
  msg::Calibration expected = saved;
  expected.provenance("four walls, it's  told");
  EXPECT_TRUE(load_calibration(path) == expected);
  EXPECT_DOUBLE_EQ(alpha_sigma_deg(saved), std::sqrt(1.0 / 3.0));
}

TEST_F(CalibrationFile, OneFromBeforeThereWasATestOrAHysteresisIsRead) {
  const std::string path = folder_ / "rig.yaml";
  ASSERT_EQ(save_calibration(awkward_calibration(), path), "");
  std::ostringstream whole;
  whole << std::ifstream(path).rdbuf();
  std::string text = whole.str();
  const auto start = text.find("chi_square");
  text.erase(start, text.find("sweeps_used") - start);
  const auto hysteresis = text.find("hysteresis_deg");
  text.erase(hysteresis, text.find("residual_deg") - hysteresis);
  msg::Calibration expected = load_calibration(path);
  expected.chi_square(0.0);
  expected.degrees_of_freedom(0);
  expected.hysteresis_deg(0.0);
  expected.hysteresis_sigma_deg(0.0);
  EXPECT_TRUE(load_calibration(write(text)) == expected);
}

TEST_F(CalibrationFile, ReplacesTheOneBefore) {
  const std::string path = folder_ / "rig.yaml";
  msg::Calibration calibration = awkward_calibration();
  ASSERT_EQ(save_calibration(calibration, path), "");
  calibration.alpha_deg(31.0);
  ASSERT_EQ(save_calibration(calibration, path), "");
  EXPECT_EQ(load_calibration(path).alpha_deg(), 31.0);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(CalibrationFile, WhatCannotBeWrittenIsSaid) {
  const std::string blocked = write("not a folder");
  EXPECT_NE(save_calibration(awkward_calibration(), blocked + "/rig.yaml"), "");
  EXPECT_NE(save_calibration(awkward_calibration(), folder_.string()), "");
  EXPECT_NE(save_calibration(awkward_calibration(), "/proc/rig.yaml"), "");
}

// A file cut anywhere is refused, unless nothing but white space is gone.
TEST_F(CalibrationFile, HalfOfOneIsRefused) {
  const std::string path = folder_ / "rig.yaml";
  ASSERT_EQ(save_calibration(awkward_calibration(), path), "");
  std::ostringstream whole;
  whole << std::ifstream(path).rdbuf();
  const std::string text = whole.str();
  for (std::size_t length = 0; length + 1 < text.size(); length += 11) {
    EXPECT_THROW(load_calibration(write(text.substr(0, length))), ConfigurationError) << length;
  }
}

TEST_F(CalibrationFile, ATimeThatIsNoWholeNumberIsRefused) {
  const std::string path = folder_ / "rig.yaml";
  ASSERT_EQ(save_calibration(awkward_calibration(), path), "");
  std::ostringstream whole;
  whole << std::ifstream(path).rdbuf();
  for (const std::string time : {"1.7e18", "1700000000.5", "-1", "9e18", "99999999999999999999"}) {
    std::string text = whole.str();
    text.replace(text.find("1700000000123456789"), 19, time);
    EXPECT_THROW(load_calibration(write(text)), ConfigurationError) << time;
  }
}

TEST_F(CalibrationFile, OneThatIsNotThereIsRefused) {
  EXPECT_THROW(load_calibration(folder_ / "none.yaml"), ConfigurationError);
  EXPECT_THROW(load_calibration(folder_), ConfigurationError);
  EXPECT_THROW(load_calibration("/dev/zero"), ConfigurationError);
}

}  // namespace
}  // namespace swivel
