// swivel: the command line tool. Data goes to stdout, logs to stderr.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "components/common/program.hpp"
#include "components/swivel/verbs.hpp"

int main(int argc, char** argv) {
  using namespace swivel;
  StopSignal stop;
  CLI::App app("Swivel: an accurate 3D scanner from a 2D lidar on an open-loop stepper", "swivel");
  Verb verb;
  add_up(app, stop, verb);
  add_status(app, stop, verb);
  add_scan(app, stop, verb);
  add_calibrate(app, stop, verb);
  add_record(app, stop, verb);
  add_replay(app, stop, verb);
  add_topic_verbs(app, stop, verb);
  add_export(app, verb);
  add_mcap_verbs(app, verb);
  add_process(app, verb);
  add_map(app, stop, verb);
  add_report(app, stop, verb);
  add_view(app, verb);
  add_doctor(app, verb);
  add_discovery_server(app, stop, verb);
  add_keys(app, verb);
  add_demo(app, stop, verb);
  return run_program(app, argc, argv, [&] {
    if (!verb) throw ExitError(kExitUsage, "say what to do; the verbs:\n" + app.help());
    return verb();
  });
}
