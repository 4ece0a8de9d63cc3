// What a scanner needs of the computer itself. What judges is apart from what looks, so that it can
// be given any computer.
#pragma once

#include <cstdint>
#include <string>

#include "components/swivel/doctor/diagnosis.hpp"

namespace swivel {

Diagnosis judge_shared_memory(std::uint64_t free_bytes);
Diagnosis judge_disk(std::uint64_t free_bytes, const std::string& folder);

// Of a folder that is usually /dev/shm.
Diagnosis check_shared_memory(const std::string& folder);
Diagnosis check_stale_segments(const std::string& folder);
Diagnosis check_other_users(const std::string& folder);

Diagnosis check_disk(const std::string& folder);
Diagnosis check_clock();

// A serial device, /dev/NAME[@BAUD]. It is not opened: that would reset an Arduino.
Diagnosis check_serial_port(const std::string& subject, const std::string& address);

}  // namespace swivel
