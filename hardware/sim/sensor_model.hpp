// The kinds of sensor that the bench can be: what each says of itself, how far it measures and
// what it says where it cannot.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace swivel::sim {

struct SensorModel {
  std::string product = "UST-10LX";
  std::string firmware = "2.23.0000";  // of a UST: sends on the next 1 ms tick
  std::string protocol = "SCIP 2.2";
  std::string serial_number = "H0000000";
  std::string interface_words = "Ethernet 100[Mbps]";
  bool tells_intensities = true;  // knows ME and GE
  int revolutions_per_minute = 2400;
  int said_nearest_mm = 20;  // DMIN and DMAX of PP
  int said_farthest_mm = 30000;
  double nearest_mm = 21.0;  // what it really answers
  double farthest_mm = 30000.0;
  std::uint16_t too_near = 4;  // what it answers below, beyond and without an echo
  std::uint16_t no_return = 65533;
  // The fan: steps are numbered from the rear.
  int first_step = 0;
  int last_step = 1080;
  int front_step = 540;
  int steps_per_turn = 1440;
};

// UST-10LX, UTM-30LX or URG-04LX; nothing for another name.
std::optional<SensorModel> sensor_model(const std::string& product);

}  // namespace swivel::sim
