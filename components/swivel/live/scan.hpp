// A scan by a live rig: sweeps requested, awaited and written out.
#pragma once

#include <string>

#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/swivel/live/live_sweeps.hpp"
#include "components/swivel/offline/output_folder.hpp"

namespace swivel {

struct ScanOptions {
  int mode = 1;
  int count = 1;
  msg::SweepSequence action_sequence = msg::SEQUENCE_IMPROVED;
};

// Throws ExitError where the rig has no such mode.
void check_mode(const RigFile& rig, int mode);

// Returns how many sweeps were whole and their attitude known. Throws ExitError when the scan
// comes to nothing; a stop signal cancels it.
int scan(LiveSweeps& sweeps, const ScanOptions& options, OutputFolder& output, StopSignal& stop,
         const Remark& remark = {});

// Likewise by a participant of its own, once those whose work a scan is are there.
int scan_live(const ParticipantOptions& participant, const ScanOptions& options,
              OutputFolder& output, StopSignal& stop, const Remark& remark = {});

}  // namespace swivel
