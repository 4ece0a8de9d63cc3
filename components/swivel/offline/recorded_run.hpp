// What the verbs that work on a recording have in common: it is opened, its rig and its calibration
// are found, and each of its sweeps goes through the stages into a folder.
#pragma once

#include <optional>
#include <string>

#include "components/common/rig_file.hpp"
#include "components/recording/recording.hpp"
#include "components/swivel/offline/output_folder.hpp"

namespace swivel {

struct RecordedRunOptions {
  std::string recording;
  std::string folder;
  std::string rig_file;          // empty: that which suits
  std::string calibration_file;  // empty: that of the recording, or none
  OutputKinds kinds;
};

class RecordedRun {
 public:
  // Makes the folder. Throws ExitError, or ConfigurationError.
  explicit RecordedRun(const RecordedRunOptions& options);

  const RigFile& rig() const { return rig_; }
  const std::string& title() const { return title_; }
  double room_yaw_deg() const;
  OutputFolder& output() { return output_; }

  // remark: what is to be told of each sweep besides. Once.
  void run(const Remark& remark = {});

  // Whether every sweep was made, once output().finish() is through.
  int exit_code() const;

 private:
  Recording recording_;
  RigFile rig_;
  std::optional<msg::Calibration> calibration_;
  std::string title_;
  OutputFolder output_;
};

}  // namespace swivel
