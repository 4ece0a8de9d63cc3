// What replies mean. A Failure says which demand was not met.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hardware/lidar/scip.hpp"
#include "hardware/lidar/scip_parser.hpp"
#include "hardware/result.hpp"

namespace swivel {

// VV. Absent lines are empty, but for product, firmware and serial number, which are demanded.
struct LidarIdentity {
  std::string vendor;
  std::string product;
  std::string firmware;
  std::string protocol;
  std::string serial_number;
};

namespace scip {

// PP.
struct Parameters {
  std::string model;  // may be empty
  std::uint16_t range_min_mm = 0;
  std::uint16_t range_max_mm = 0;
  int steps_per_turn = 0;
  int first_step = 0;
  int last_step = 0;
  int front_step = 0;
  int speed_rpm = 0;
  bool clockwise = false;  // seen from above; said by newer sensors only

  int beams() const { return last_step - first_step + 1; }
  // Counter-clockwise seen from above, 0 straight ahead.
  double beam_step_deg() const { return (clockwise ? -360.0 : 360.0) / steps_per_turn; }
  double first_beam_angle_deg() const { return (first_step - front_step) * beam_step_deg(); }
  double scan_period_ns() const { return 60e9 / speed_rpm; }  // as the sensor says: nominal
};

// II.
struct State {
  std::string laser;
  std::string mode;
  std::optional<std::uint32_t> stamp_ms;
  std::string status;  // in the sensor's own words
};

// A scan as it came: ranges in mm with the sensor's codes, intensities in units of its own.
// What does not fit in 16 bits is 65535, and counted.
struct Scan {
  std::uint32_t stamp_ms = 0;
  std::vector<std::uint16_t> ranges_mm;
  std::vector<std::uint16_t> intensities;  // empty unless asked for
  std::size_t saturated = 0;
};

Result<LidarIdentity> decode_identity(const Reply& reply);
Result<Parameters> decode_parameters(const Reply& reply);
Result<State> decode_state(const Reply& reply);
Result<std::uint32_t> decode_clock(const Reply& reply);  // TM1: ms
Result<Scan> decode_scan(const Reply& reply, Measurement measurement, int beams);

}  // namespace scip

enum class BeamStatus { kValid, kTooNear, kNoReturn, kOutOfRange };

// UST-10LX: 4 nearer than 21 mm, 65533 no return or beyond 30 m (specification sheet, section 5).
// Other models say 0, or an error below 20: all of them lie outside of [range_min, range_max].
constexpr BeamStatus beam_status(std::uint16_t range_mm, std::uint16_t range_min_mm,
                                 std::uint16_t range_max_mm) {
  if (range_mm == 4) return BeamStatus::kTooNear;
  if (range_mm == 0 || range_mm == 65533) return BeamStatus::kNoReturn;
  if (range_mm < range_min_mm || range_mm > range_max_mm) return BeamStatus::kOutOfRange;
  return BeamStatus::kValid;
}

}  // namespace swivel
