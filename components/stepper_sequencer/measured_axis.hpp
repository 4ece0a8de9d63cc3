// Position reports of a controller that measures, as samples of the axis.
//
// The angle of a report is that of some instant between question and answer; the middle is at most
// half the round trip off. A report that was long in coming is left out while there are better.
#pragma once

#include <cstdint>
#include <optional>

#include "hardware/stepper/grbl_stepper.hpp"
#include "swivel/idl/swivel.h"

namespace swivel {

class MeasuredAxis {
 public:
  // The longest time without a sample for the sake of better ones.
  static constexpr std::int64_t kLongestGapNs = 200'000'000;

  std::optional<msg::AxisSample> add(const StepperStatus& report);

  std::uint64_t left_out() const { return left_out_; }

 private:
  std::int64_t quick_ns_ = 0;  // a quick round trip of late; 0 for none yet
  std::int64_t last_ns_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace swivel
