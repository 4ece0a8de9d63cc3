// What Fast DDS complains of, in our log: by itself it writes to stdout, which is for data.
#pragma once

namespace swivel {

// For the whole process, as Fast DDS has it.
void log_what_fast_dds_says();

}  // namespace swivel
