#pragma once

#include "swivel/idl/swivel.h"

namespace swivel {

// "idle", "homing", ...: as swivel.idl calls it.
const char* phase_word(msg::SweepPhase phase);

}  // namespace swivel
