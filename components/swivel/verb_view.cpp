// swivel view: becomes view_gateway, which has options of its own.
#include <unistd.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cerrno>
#include <cstring>

#include "components/common/program.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

int become_gateway(std::vector<std::string> arguments) {
  const std::string path = program_directory() + "/view_gateway";
  arguments.insert(arguments.begin(), path);
  std::vector<char*> values;
  values.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) values.push_back(argument.data());
  values.push_back(nullptr);
  execv(path.c_str(), values.data());
  throw ExitError(kExitUnavailable,
                  path + ": " + std::strerror(errno) + "; it belongs beside swivel");
}

}  // namespace

void add_view(CLI::App& app, Verb& chosen) {
  CLI::App* const verb = app.add_subcommand(
      "view", "A page for the browser: the running sweep, the cloud, its quality");
  verb->set_help_flag();
  verb->prefix_command();
  verb->callback([=, &chosen] { chosen = [=] { return become_gateway(verb->remaining()); }; });
}

}  // namespace swivel
