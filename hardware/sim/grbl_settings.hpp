// The settings of GRBL 1.1 ($$). One axis is used, X; its unit is read as degrees.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace swivel::sim {

class GrblSettings {
 public:
  explicit GrblSettings(double travel_deg = 360.0);  // as shipped with the bench

  // False when there is no such setting, or it cannot have that value.
  bool set(int number, double value);
  bool knows(int number) const { return values_.count(number) != 0; }
  std::string listing() const;  // the lines of $$

  double steps_per_deg() const { return values_.at(100); }
  double fastest_deg_s() const { return values_.at(110) / 60.0; }
  double acceleration_deg_s2() const { return values_.at(120); }
  double travel_deg() const { return values_.at(130); }
  double pull_off_deg() const { return values_.at(27); }
  bool homing() const { return values_.at(22) != 0.0; }
  bool hard_limits() const { return values_.at(21) != 0.0; }
  bool soft_limits() const { return values_.at(20) != 0.0; }
  // MPos once homed: -($130 - $27) at the negative end, -$27 at the positive one.
  double homed_position_deg() const;

 private:
  std::map<int, double> values_;
};

}  // namespace swivel::sim
