// swivel process RECORDING -o DIR: clouds, pictures and numbers from a recording.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>

#include "components/swivel/source_options.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

int process(const RecordedRunOptions& options) {
  RecordedRun run(options);
  run.run();
  run.output().finish();
  return run.exit_code();
}

}  // namespace

void add_process(CLI::App& app, Verb& chosen) {
  CLI::App* const verb = app.add_subcommand(
      "process", "Turns a recording into clouds, pictures and numbers, without DDS");
  const auto options = std::make_shared<RecordedRunOptions>();
  add_source_options(*verb, *options, false);
  verb->add_option("--rig", options->rig_file, "The rig file [that which suits the recording]");
  verb->add_flag("--no-clouds", options->kinds.no_clouds, "Write no PCD and PLY");
  verb->add_flag("--no-pictures", options->kinds.no_pictures, "Write no PNG");
  verb->callback([options, &chosen] { chosen = [options] { return process(*options); }; });
}

}  // namespace swivel
