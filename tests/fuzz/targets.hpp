// What reads bytes that anybody may have written, each as a function of bytes: for libFuzzer, which
// looks for those that break it, and for the replay of what was found.
#pragma once

#include <array>
#include <string_view>

namespace swivel::fuzz {

void scip(std::string_view bytes);           // a lidar's replies
void grbl(std::string_view bytes);           // a controller's
void rig_file(std::string_view bytes);       // YAML
void calibration(std::string_view bytes);    // YAML, as the calibrator keeps it
void mcap(std::string_view bytes);           // a recording
void case_folder(std::string_view bytes);    // its files, one after the other
void csv_recording(std::string_view bytes);  // .csv, or .csv.gz

struct Target {
  std::string_view name;  // also of the folder of its seeds, in tests/data/fuzz
  void (*run)(std::string_view bytes);
};

inline constexpr std::array<Target, 7> kTargets{{{"scip", scip},
                                                 {"grbl", grbl},
                                                 {"rig_file", rig_file},
                                                 {"calibration", calibration},
                                                 {"mcap", mcap},
                                                 {"case_folder", case_folder},
                                                 {"csv_recording", csv_recording}}};

}  // namespace swivel::fuzz
