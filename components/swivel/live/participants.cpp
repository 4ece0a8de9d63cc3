#include "components/swivel/live/participants.hpp"

#include <map>

#include "components/log/log.hpp"

namespace swivel {
namespace {

constexpr auto kStopsWithin = std::chrono::milliseconds(2500);  // they promise 2 s

std::vector<std::string> arguments_of(const std::string& name, const CommonOptions& common,
                                      const ParticipantsOptions& options) {
  std::vector<std::string> arguments = common.as_arguments();
  const auto add = [&](const std::string& option, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {option, value});
  };
  if (name == "hokuyo_reader") add("--lidar", options.lidar);
  if (name == "stepper_sequencer") add("--stepper", options.stepper);
  if (name == "alpha_calibrator") add("--calibration", options.calibration_file);
  return arguments;
}

}  // namespace

const std::vector<std::string>& participants_of(const std::string& role) {
  static const std::map<std::string, std::vector<std::string>> roles{
      {"robot", {"stepper_sequencer", "hokuyo_reader"}},
      {"workstation", {"cloud_assembler", "attitude_corrector", "alpha_calibrator"}},
      {"all",
       {"stepper_sequencer", "hokuyo_reader", "cloud_assembler", "attitude_corrector",
        "alpha_calibrator"}}};
  return roles.at(role);
}

Participants::Participants(const CommonOptions& common, const ParticipantsOptions& options) {
  for (const std::string& name : participants_of(options.role)) {
    children_.push_back(std::make_unique<ChildProcess>(name, arguments_of(name, common, options)));
  }
}

std::optional<std::string> Participants::ended() {
  for (const auto& child : children_) {
    if (const auto how = child->ended()) {
      exit_code_ = child->exit_code();
      return how;
    }
  }
  return std::nullopt;
}

void Participants::stop() {
  for (const auto& child : children_) child->ask_to_stop();
  for (const auto& child : children_) {
    if (!child->wait_or_kill(kStopsWithin))
      log_error("{} did not stop and was killed", child->name());
  }
  children_.clear();
}

}  // namespace swivel
