// swivel discovery-server: says who is there to those who name it, where multicast does not pass.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>

#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

int serve(const CommonOptions& common, StopSignal& stop) {
  start_log("swivel", common.log_level);
  ParticipantOptions options =
      common.participant("swivel_discovery_server", load_rig_file(common.rig_file).rig);
  options.serves_discovery = true;
  Participant participant(options);
  participant.start();
  stop.wait();
  participant.stop();
  return kExitOk;
}

}  // namespace

void add_discovery_server(CLI::App& app, StopSignal& stop, Verb& chosen) {
  CLI::App* const verb = app.add_subcommand(
      "discovery-server",
      "Says who is there, where multicast does not pass: one for both computers");
  const auto common = std::make_shared<CommonOptions>();
  add_common_options(*verb, *common);
  verb->get_option("--discovery-server")->required();
  verb->callback([=, &stop, &chosen] { chosen = [=, &stop] { return serve(*common, stop); }; });
}

}  // namespace swivel
