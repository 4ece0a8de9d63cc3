// The plate's shape in a Calibration, and back. Millimetres and degrees there, metres and radians
// here.
#pragma once

#include <optional>

#include "calibration/plate_learning.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

void to_message(const LearnedPlate& plate, msg::Calibration& calibration);

// None where the calibration did not look at the plate's shape.
std::optional<PlateShape> plate_shape_of(const msg::Calibration& calibration);

}  // namespace swivel
