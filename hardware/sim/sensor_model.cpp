#include "hardware/sim/sensor_model.hpp"

namespace swivel::sim {
namespace {

// Answers from 0.1 to 30 m; 1 and 19 are seen where it found nothing (recordings).
SensorModel utm_30lx() {
  SensorModel model;
  model.product = "UTM-30LX";
  model.firmware = "1.18.01";
  model.protocol = "SCIP 2.0";
  model.serial_number = "H0000030";
  model.interface_words = "USB Full Speed";
  model.said_nearest_mm = 23;
  model.said_farthest_mm = 60000;
  model.nearest_mm = 100.0;
  model.too_near = 19;
  model.no_return = 1;
  return model;
}

// 240 deg of 1024 steps, ten turns a second.
SensorModel urg_04lx() {
  SensorModel model;
  model.product = "URG-04LX";
  model.firmware = "3.3.00";
  model.protocol = "SCIP 2.0";
  model.serial_number = "H0000004";
  model.interface_words = "USB Full Speed";
  model.tells_intensities = false;
  model.revolutions_per_minute = 600;
  model.said_nearest_mm = 20;
  model.said_farthest_mm = 5600;
  model.nearest_mm = 20.0;
  model.farthest_mm = 5600.0;
  model.too_near = 6;
  model.no_return = 0;
  model.first_step = 44;
  model.last_step = 725;
  model.front_step = 384;
  model.steps_per_turn = 1024;
  return model;
}

}  // namespace

std::optional<SensorModel> sensor_model(const std::string& product) {
  for (const SensorModel& model : {SensorModel(), utm_30lx(), urg_04lx()}) {
    if (model.product == product) return model;
  }
  return std::nullopt;
}

}  // namespace swivel::sim
