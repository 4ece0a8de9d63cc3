// swivel up: the participants of a role, until Ctrl-C or until one of them ends.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>

#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/log/log.hpp"
#include "components/swivel/live/participants.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

int up(const CommonOptions& common, const ParticipantsOptions& options, StopSignal& stop) {
  start_log("swivel", common.log_level);
  load_rig_file(common.rig_file);  // one message about a wrong file, not five
  Participants participants(common, options);
  while (!stop.wait_for(std::chrono::milliseconds(200))) {
    if (const auto how = participants.ended()) {
      log_error("{}; stopping the others", *how);
      return participants.exit_code() == 0 ? kExitInternal : participants.exit_code();
    }
  }
  return kExitOk;
}

}  // namespace

void add_up(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb =
      app.add_subcommand("up", "Starts the participants, and stops them together");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<ParticipantsOptions>();
  verb->add_option("--role", options->role, "robot: lidar and stepper; workstation: the rest")
      ->check(CLI::IsMember({"robot", "workstation", "all"}))
      ->capture_default_str();
  verb->add_option("--lidar", options->lidar, "tcp://HOST:PORT or /dev/NAME, not the rig file's");
  verb->add_option("--stepper", options->stepper, "/dev/NAME[@BAUD], not the rig file's");
  verb->add_option("--calibration", options->calibration_file, "Where the calibration is kept");
  add_common_options(*verb, *common);
  verb->callback(
      [=, &stop, &chosen] { chosen = [=, &stop] { return up(*common, *options, stop); }; });
}

}  // namespace swivel
