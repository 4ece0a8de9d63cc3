#include "components/common/phase_word.hpp"

namespace swivel {

const char* phase_word(msg::SweepPhase phase) {
  switch (phase) {
    case msg::PHASE_IDLE:
      return "idle";
    case msg::PHASE_HOMING:
      return "homing";
    case msg::PHASE_ACCELERATING:
      return "accelerating";
    case msg::PHASE_CRUISING:
      return "cruising";
    case msg::PHASE_DECELERATING:
      return "decelerating";
    case msg::PHASE_RETURNING:
      return "returning";
    case msg::PHASE_FAULT:
      return "fault";
    case msg::PHASE_REFUSED:
      return "refused";
    case msg::PHASE_ASSEMBLED:
      return "assembled";
  }
  return "unknown";
}

}  // namespace swivel
