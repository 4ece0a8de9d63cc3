// view_gateway: a page that shows what the scanner sees, for a browser, and the Foxglove protocol
// on the same port. A program of its own, since `swivel` has 70 MB of libraries for pictures.
#include <malloc.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdlib>
#include <iostream>
#include <memory>

#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/gateway/gateway.hpp"

namespace {

using namespace swivel;

struct ViewOptions {
  ServerOptions server;
  std::string token_file;
};

// What is this large is given back to the system when it is freed: a cloud is 11 MB.
constexpr int kLargeBlockBytes = 1 << 20;
constexpr std::uint32_t kSharedMemoryBytes = 1 << 20;  // it writes requests and health alone

std::string default_token_file() {
  for (const char* folder : {"XDG_RUNTIME_DIR", "HOME"}) {
    if (const char* path = std::getenv(folder); path != nullptr && *path != '\0')
      return std::string(path) + "/swivel_view_token";
  }
  return {};
}

// Beyond this computer nobody gets in without a token. What was given on the command line is not
// written down; what is made here is, since nothing else tells it.
void arrange_token(ViewOptions& options) {
  std::string& token = options.server.access.token;
  if (!token.empty() && !is_token(token)) {
    throw ExitError(kExitUsage, "a token is 16 or more of A-Z, a-z, 0-9, - and _");
  }
  const auto loopback = is_loopback(options.server.address);
  if (!loopback) throw ExitError(kExitUsage, options.server.address + " is no IP address");
  if (!token.empty() || *loopback) return;
  if (options.token_file.empty()) {
    throw ExitError(kExitUsage, "no place to write a token to: give --token-file or --token");
  }
  token = new_token();
  const std::string wrong = write_token(token, options.token_file);
  if (!wrong.empty()) throw ExitError(kExitCannotWrite, "the token cannot be written: " + wrong);
}

void tell_where(const ViewOptions& options, std::uint16_t port) {
  const bool v6 = options.server.address.find(':') != std::string::npos;
  const std::string host = v6 ? "[" + options.server.address + "]" : options.server.address;
  std::cout << "http://" << host << ":" << port << "/" << std::endl;
  if (options.server.access.token.empty()) return;
  std::cerr << "the address needs ?token=...; the token is "
            << (options.token_file.empty() ? "the one that you gave" : "in " + options.token_file)
            << std::endl;
}

int view(const CommonOptions& common, ViewOptions options, StopSignal& stop) {
  start_log("view_gateway", common.log_level == "info" ? "warning" : common.log_level);
  mallopt(M_MMAP_THRESHOLD, kLargeBlockBytes);
  const RigFile rig = load_rig_file(common.rig_file);
  if (!options.server.access.token.empty()) options.token_file.clear();
  try {
    arrange_token(options);
    ParticipantOptions participant_options = common.participant("view_gateway", rig.rig);
    participant_options.shared_memory_bytes = kSharedMemoryBytes;
    Participant participant(participant_options);
    Gateway gateway(participant, rig, options.server);
    participant.start();
    tell_where(options, gateway.port());
    stop.wait();
    participant.stop();
  } catch (const ServerError& error) {
    throw ExitError(kExitUnavailable, error.what());
  }
  return kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  StopSignal stop;
  CLI::App app("A page for the browser: the running sweep, the cloud, its quality", "swivel view");
  CommonOptions common;
  ViewOptions options;
  options.token_file = default_token_file();
  app.add_option("--port", options.server.port, "0: any that is free")->capture_default_str();
  app.add_option("--listen", options.server.address,
                 "An IP address of this computer; beyond loopback clients need a token")
      ->capture_default_str();
  app.add_option("--token", options.server.access.token,
                 "What clients must know; better in the environment, which others cannot see")
      ->envname("SWIVEL_VIEW_TOKEN");
  app.add_option("--token-file", options.token_file, "Where a token that is made goes")
      ->capture_default_str();
  app.add_option("--allow-origin", options.server.access.allowed_origins,
                 "Another page that may connect: https://app.foxglove.dev");
  add_common_options(app, common);
  return run_program(app, argc, argv, [&] { return view(common, options, stop); });
}
