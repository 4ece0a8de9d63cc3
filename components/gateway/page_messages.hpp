// The words between gateway and page, as JSON.
#pragma once

#include <map>
#include <string>

#include "components/common/rig_file.hpp"
#include "components/common/roll.hpp"
#include "components/gateway/live_view.hpp"
#include "hardware/result.hpp"

namespace swivel {

// All that the page shows besides the points. `answer` is what became of the last request that
// did not lead to a sweep.
std::string state_message(const RigFile& rig, const LiveView& view,
                          const std::map<std::string, RollEntry>& participants,
                          const std::string& answer);

// What a click on the page asks for. The page may be anybody's.
struct PageCommand {
  bool cancel = false;  // stop the motor; mode is not read
  int mode = 0;
};
Result<PageCommand> page_command_in(const std::string& text, const RigFile& rig);

}  // namespace swivel
