#include "components/common/calibration_file.hpp"

#include <time.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "components/common/strict_yaml.hpp"

namespace swivel {
namespace {

constexpr int kAllDigits = std::numeric_limits<double>::max_digits10;
constexpr Range kAnyAngle{-360.0, 360.0};
constexpr Range kAnyLength{-1e5, 1e5};
constexpr std::size_t kPlateShapeSize = 6;
constexpr Range kAnyCovariance{-1e12, 1e12};
constexpr Range kNanoseconds{0.0, 9.2e18};

std::string date_of(std::int64_t time_ns) {
  const time_t seconds = time_ns / 1'000'000'000;
  tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

template <class Values>
std::string list_of(const Values& values) {
  std::ostringstream text;
  text.precision(kAllDigits);
  for (const double value : values) text << (text.tellp() == 0 ? "[" : ", ") << value;
  return text.str() + "]";
}

// Quoted as YAML asks for: our own words, and whatever a sensor said of itself.
std::string quoted(const std::string& words) {
  std::string text = "\"";
  for (const char c : words) {
    if (c == '"' || c == '\\') text += '\\';
    text += (static_cast<unsigned char>(c) < 0x20) ? ' ' : c;
  }
  return text + "\"";
}

std::string to_yaml(const msg::Calibration& calibration) {
  std::ostringstream yaml;
  yaml.precision(kAllDigits);
  yaml << "# A calibration of Swivel. Angles in deg, lengths in mm.\n"
       << "rig: " << calibration.rig().to_string() << "\n"
       << "date: " << quoted(date_of(calibration.time_ns())) << "\n"
       << "time_ns: " << calibration.time_ns() << "\n"
       << "alpha_deg: " << calibration.alpha_deg() << "\n"
       << "alpha_sigma_deg: " << alpha_sigma_deg(calibration) << "\n"
       << "bias_deg: " << calibration.bias_deg() << "\n"
       << "mounting_xyz_mm: " << list_of(calibration.mounting_xyz_mm()) << "\n"
       << "mounting_rpy_deg: " << list_of(calibration.mounting_rpy_deg()) << "\n"
       << "hysteresis_deg: " << calibration.hysteresis_deg() << "\n"
       << "hysteresis_sigma_deg: " << calibration.hysteresis_sigma_deg() << "\n"
       << "residual_deg: " << calibration.residual_deg() << "\n"
       << "chi_square: " << calibration.chi_square() << "\n"
       << "degrees_of_freedom: " << calibration.degrees_of_freedom() << "\n"
       << "sweeps_used: " << calibration.sweeps_used() << "\n"
       << "mode: " << int{calibration.mode()} << "\n"
       << "serial_number: " << quoted(calibration.serial_number()) << "\n"
       << "firmware: " << quoted(calibration.firmware()) << "\n"
       << "provenance: " << quoted(calibration.provenance()) << "\n"
       << "# Of the plate against its drawing: height (mm), roll and pitch (deg), growth and\n"
       << "# softness of its edges (mm), offset of ranges (mm); zeros where not estimated.\n"
       << "plate_shape: " << list_of(calibration.plate_shape()) << "\n"
       << "plate_shape_sigma: " << list_of(calibration.plate_shape_sigma()) << "\n"
       << "plate_residual_mm: " << calibration.plate_residual_mm() << "\n"
       << "# Over alpha, bias, mounting x y z, roll pitch yaw; zeros where not estimated.\n"
       << "covariance: " << list_of(calibration.covariance()) << "\n";
  return yaml.str();
}

// A double has not digits enough.
std::int64_t read_time_ns(YamlSection& file) {
  file.number("time_ns", kNanoseconds);
  const std::string text = file.text("time_ns");
  std::int64_t time_ns = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, time_ns);
  if (error != std::errc() || stop != end) file.refuse("time_ns", "must be a whole number");
  return time_ns;
}

void read_plate(YamlSection& file, msg::Calibration& calibration) {
  const auto shape = file.numbers("plate_shape", kPlateShapeSize, kAnyLength);
  const auto sigma = file.numbers("plate_shape_sigma", kPlateShapeSize, {0.0, 1e5});
  std::copy(shape.begin(), shape.end(), calibration.plate_shape().begin());
  std::copy(sigma.begin(), sigma.end(), calibration.plate_shape_sigma().begin());
  calibration.plate_residual_mm(file.number("plate_residual_mm", {0.0, 1e3}));
}

}  // namespace

double alpha_sigma_deg(const msg::Calibration& calibration) {
  return std::sqrt(calibration.covariance()[kAlpha * kCalibrationSize + kAlpha]);
}

msg::Calibration load_calibration(const std::string& path) {
  YamlSection file = YamlSection::load(path);
  msg::Calibration calibration;
  calibration.rig(file.text("rig"));
  file.text("date");
  calibration.time_ns(read_time_ns(file));
  calibration.alpha_deg(file.number("alpha_deg", kAnyAngle));
  file.number("alpha_sigma_deg", {0.0, 360.0});  // for the reader; the covariance has it
  calibration.bias_deg(file.number("bias_deg", kAnyAngle));
  const auto xyz_mm = file.numbers("mounting_xyz_mm", 3, kAnyLength);
  const auto rpy_deg = file.numbers("mounting_rpy_deg", 3, kAnyAngle);
  std::copy(xyz_mm.begin(), xyz_mm.end(), calibration.mounting_xyz_mm().begin());
  std::copy(rpy_deg.begin(), rpy_deg.end(), calibration.mounting_rpy_deg().begin());
  calibration.residual_deg(file.number("residual_deg", {0.0, 360.0}));
  // Files from before there was a test, or a hysteresis, have none.
  calibration.hysteresis_deg(file.number("hysteresis_deg", kAnyAngle, 0.0));
  calibration.hysteresis_sigma_deg(file.number("hysteresis_sigma_deg", {0.0, 360.0}, 0.0));
  calibration.chi_square(file.number("chi_square", {0.0, 1e12}, 0.0));
  calibration.degrees_of_freedom(
      static_cast<std::uint32_t>(file.integer("degrees_of_freedom", {0.0, 1e9}, 0)));
  calibration.sweeps_used(static_cast<std::uint32_t>(file.integer("sweeps_used", {0.0, 1e6})));
  calibration.mode(static_cast<std::uint8_t>(file.integer("mode", {0.0, 255.0})));
  calibration.serial_number(file.text("serial_number"));
  calibration.firmware(file.text("firmware"));
  calibration.provenance(file.text("provenance"));
  if (file.has("plate_shape")) read_plate(file, calibration);
  const auto covariance =
      file.numbers("covariance", kCalibrationSize * kCalibrationSize, kAnyCovariance);
  std::copy(covariance.begin(), covariance.end(), calibration.covariance().begin());
  for (std::size_t index = 0; index < kCalibrationSize; ++index) {
    if (covariance[index * kCalibrationSize + index] < 0.0) {
      file.refuse("covariance", "has a negative variance");
    }
  }
  file.finish();
  return calibration;
}

std::string save_calibration(const msg::Calibration& calibration, const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::path(path).has_parent_path()) fs::create_directories(fs::path(path).parent_path(), error);
  const std::string part = path + ".part";
  std::ofstream file(part);
  file << to_yaml(calibration);
  file.close();
  if (!file) return path + " cannot be written; is the directory there, and yours?";
  fs::rename(part, path, error);
  return error ? path + ": " + error.message() : "";
}

std::string default_calibration_path(const std::string& rig) {
  const char* const state = std::getenv("STATE_DIRECTORY");
  if (state != nullptr) return std::string(state) + "/" + rig + ".calibration.yaml";
  const char* const user_state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  const std::string base = user_state != nullptr ? user_state
                           : home != nullptr     ? std::string(home) + "/.local/state"
                                                 : ".";
  return base + "/swivel/" + rig + ".calibration.yaml";
}

}  // namespace swivel
