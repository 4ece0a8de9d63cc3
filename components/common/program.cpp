#include "components/common/program.hpp"

#include <time.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>

#include "components/common/strict_yaml.hpp"
#include "components/dds/fast_dds_log.hpp"
#include "components/log/log.hpp"

namespace swivel {

StopSignal::StopSignal() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

bool StopSignal::wait_for(std::chrono::milliseconds timeout) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(timeout);
  const auto rest = std::chrono::nanoseconds(timeout - seconds);
  const timespec time_left{seconds.count(), rest.count()};
  if (!received_) received_ = sigtimedwait(&signals_, nullptr, &time_left) > 0;
  return received_;
}

void StopSignal::wait() {
  while (!wait_for(std::chrono::hours(1))) {
  }
}

ParticipantOptions CommonOptions::participant(const std::string& name,
                                              const std::string& rig) const {
  ParticipantOptions options{name, rig, domain, network, profiles_file};
  options.discovery_server = discovery_server;
  options.peers = peers;
  options.security_folder = security_folder;
  return options;
}

std::vector<std::string> CommonOptions::as_arguments() const {
  std::vector<std::string> arguments{"--rig",       rig_file, "--domain",   std::to_string(domain),
                                     "--network",   network,  "--profiles", profiles_file,
                                     "--log-level", log_level};
  const auto add = [&](const std::string& option, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {option, value});
  };
  add("--discovery-server", discovery_server);
  for (const std::string& peer : peers) add("--peer", peer);
  add("--security", security_folder);
  return arguments;
}

std::string program_directory() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

std::string shared_file(const std::string& name) {
  return (std::filesystem::path(program_directory()) / "../share/swivel" / name).lexically_normal();
}

std::string rig_file_of(const std::string& path_or_name) {
  const bool name = path_or_name.find_first_of("./") == std::string::npos;
  return name ? shared_file("rigs/" + path_or_name + ".yaml") : path_or_name;
}

void add_common_options(CLI::App& app, CommonOptions& options) {
  options.rig_file = shared_file("rigs/yuan.yaml");
  options.profiles_file = shared_file("dds_profiles.xml");
  app.add_option("--rig", options.rig_file, "The rig file, or the name of a shipped one")
      ->transform(rig_file_of, "", "rig")
      ->capture_default_str();
  app.add_option("--domain", options.domain, "The DDS domain")
      ->envname("SWIVEL_DOMAIN")
      ->check(CLI::Range(0, 232))
      ->capture_default_str();
  app.add_option("--network", options.network,
                 "loopback: this computer alone; lan: every interface; or a participant profile")
      ->envname("SWIVEL_NETWORK")
      ->capture_default_str();
  app.add_option("--discovery-server", options.discovery_server,
                 "A.B.C.D[:PORT] of `swivel discovery-server`, where multicast does not pass")
      ->envname("SWIVEL_DISCOVERY_SERVER");
  app.add_option("--peer", options.peers,
                 "A.B.C.D of the other computer, to find each other where multicast does not pass")
      ->envname("SWIVEL_PEER")
      ->check(CLI::ValidIPV4)
      ->allow_extra_args(false);
  app.add_option("--security,--secure", options.security_folder,
                 "The folder of `swivel keys`: encrypted, with those alone who have keys of it")
      ->envname("SWIVEL_SECURITY");
  app.add_option("--profiles", options.profiles_file, "The DDS profiles")->capture_default_str();
  app.add_option("--log-level", options.log_level, "What to log")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->capture_default_str();
}

void start_log(const std::string& program, const std::string& level) {
  open_log(program, level);
  log_what_fast_dds_says();
}

int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  app.set_version_flag("--version", app.get_name() + " " SWIVEL_VERSION);
  try {
    app.parse(argc, argv);
    return body();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  } catch (const ExitError& error) {
    std::cerr << app.get_name() << ": " << error.what() << '\n';
    return error.code;
  } catch (const ConfigurationError& error) {
    std::cerr << app.get_name() << ": " << error.what() << '\n';
    return kExitConfiguration;
  } catch (const DdsError& error) {
    std::cerr << app.get_name() << ": " << error.what() << '\n';
    return kExitUnavailable;
  } catch (const std::exception& error) {
    std::cerr << app.get_name() << ": unexpected: " << error.what() << '\n';
    return kExitInternal;
  }
}

ParticipantProgram::ParticipantProgram(std::string name, const std::string& purpose)
    : name_(std::move(name)), app_(std::make_unique<CLI::App>(purpose, name_)) {
  add_common_options(*app_, options_);
}

ParticipantProgram::~ParticipantProgram() = default;

void ParticipantProgram::add_option(const std::string& name, std::string& value,
                                    const std::string& purpose) {
  app_->add_option(name, value, purpose);
}

int ParticipantProgram::run(
    int argc, char** argv,
    const std::function<void(const CommonOptions& options, StopSignal& stop)>& body) {
  return run_program(*app_, argc, argv, [&] {
    start_log(name_, options_.log_level);
    body(options_, stop_);
    return kExitOk;
  });
}

}  // namespace swivel
