#include "components/alpha_calibrator/mounting_calibration.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "components/common/calibration_file.hpp"
#include "components/common/calibration_use.hpp"
#include "components/common/listed.hpp"

namespace swivel {
namespace {

// Where a value of the estimate stands in the message's covariance, and in which unit.
struct MessagePlace {
  MountingValue value;
  CalibrationIndex index;
  double per_unit;
};
constexpr std::array<MessagePlace, 4> kMessagePlaces{{{kMountingBias, kBias, deg_from_rad(1.0)},
                                                      {kMountingTilt, kPitch, deg_from_rad(1.0)},
                                                      {kMountingLeverX, kMountingX, 1e3},
                                                      {kMountingLeverY, kMountingY, 1e3}}};

std::string joint_in_words(const JointMounting& joint, std::size_t sweeps) {
  std::string words = fmt::format(
      "{} from {} sweep{}; planes {:.1f} mm thick; chi-square {:.1f} of {:.0f}; not seen: {}",
      mounting_in_words(joint.fit), sweeps, sweeps == 1 ? "" : "s", mm_from_m(joint.fit.residual_m),
      joint.scatter.sum, joint.scatter.freedom, listed(joint.fit.unobservable));
  if (!joint.fit.advice.empty()) words += "; " + joint.fit.advice;
  return words;
}

}  // namespace

std::string mounting_in_words(const MountingFit& fit) {
  std::vector<std::string> words;
  const auto say = [&](const char* name, MountingValue value, double per_unit, const char* unit) {
    words.push_back(fmt::format("{} {:.4f} +- {:.4f} {}", name,
                                per_unit * fit.solution.value[value],
                                per_unit * fit.sigma_of(value), unit));
  };
  for (std::size_t name = 0; name < kMountingNames.size(); ++name) {
    const MessagePlace& place = kMessagePlaces[name];
    if (is_seen(fit.solution, place.value))
      say(kMountingNames[name], place.value, place.per_unit, name < 2 ? "deg" : "mm");
  }
  if (is_seen(fit.solution, kAxisHysteresis))
    say("hysteresis", kAxisHysteresis, deg_from_rad(1.0), "deg");
  return listed(words);
}

CalibrationAdded MountingCalibration::add(int mode, const MountingResult& result) {
  if (!result.fit) return {false, result.reason};
  fits_.push_back(*result.fit);
  modes_.insert(mode);
  return {true, mounting_in_words(*result.fit)};
}

CalibrationOutcome MountingCalibration::fit(const LidarName& lidar, std::int64_t time_ns) const {
  if (fits_.empty()) return {std::nullopt, "no sweep shows the mounting"};
  const JointMounting joint = join_mountings(fits_, rig_.geometry);
  std::string words = joint_in_words(joint, fits_.size());
  if (!shows_mounting(joint.fit) && !is_seen(joint.fit.solution, kAxisHysteresis)) {
    return {std::nullopt, "the sweeps show nothing of the mounting: " + joint.fit.advice};
  }
  if (!joint.scatter.by_chance()) {
    return {std::nullopt,
            "the sweeps do not agree on one mounting: was the lidar or something in "
            "the room moved meanwhile? " +
                words};
  }
  if (rig_.plate) words += "; alpha was found with the old mounting: calibrate it again";
  return {to_message(joint, lidar, time_ns), words};
}

msg::Calibration MountingCalibration::to_message(const JointMounting& joint, const LidarName& lidar,
                                                 std::int64_t time_ns) const {
  msg::Calibration calibration;
  calibration.rig(rig_.rig);
  calibration.time_ns(time_ns);
  if (rig_.plate) calibration.alpha_deg(deg_from_rad(rig_.plate->alpha_rad));  // as drawn
  set_mounting(joint.fit.geometry, calibration);
  if (is_seen(joint.fit.solution, kAxisHysteresis))
    calibration.hysteresis_sigma_deg(deg_from_rad(joint.fit.sigma_of(kAxisHysteresis)));
  for (const MessagePlace& row : kMessagePlaces) {
    for (const MessagePlace& column : kMessagePlaces) {
      calibration.covariance()[row.index * kCalibrationSize + column.index] =
          joint.fit.solution.covariance(row.value, column.value) * row.per_unit * column.per_unit;
    }
  }
  calibration.chi_square(joint.scatter.sum);
  calibration.degrees_of_freedom(static_cast<std::uint32_t>(std::max(0.0, joint.scatter.freedom)));
  calibration.sweeps_used(static_cast<std::uint32_t>(fits_.size()));
  calibration.mode(static_cast<std::uint8_t>(modes_.size() == 1 ? *modes_.begin() : 0));
  calibration.serial_number(lidar.serial_number);
  calibration.firmware(lidar.firmware);
  calibration.provenance(joint_in_words(joint, fits_.size()));
  return calibration;
}

}  // namespace swivel
