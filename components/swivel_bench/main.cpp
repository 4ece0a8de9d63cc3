// swivel-bench: a lidar on TCP and a stepper on a pty that are not there, and the truth about
// them.
#include <future>
#include <iostream>
#include <thread>

#include "components/common/program.hpp"
#include "components/log/log.hpp"
#include "components/swivel_bench/bench_options.hpp"
#include "components/swivel_bench/capture_file.hpp"
#include "hardware/io/wake_up.hpp"

namespace {

using namespace swivel;

// One line, for scripts and tests.
template <class Bench>
void print_addresses(const Bench& bench, const std::string& link) {
  std::cout << "lidar tcp://127.0.0.1:" << bench.port() << " stepper "
            << (link.empty() ? bench.stepper_path() : link) << std::endl;
}

void log_losses(const sim::Bench& bench) {
  log_info("{} lines sent", bench.lines_sent());
  if (bench.scans_dropped() > 0) {
    log_warning("{} scans dropped: the client reads too slowly", bench.scans_dropped());
  }
  if (bench.stepper_bytes_lost() > 0) {
    log_warning("{} bytes to the stepper lost: its buffer was full", bench.stepper_bytes_lost());
  }
}

// The bench runs on a thread of its own, since this one waits for the signal.
template <class Bench>
void serve(Bench& bench, const std::string& link, StopSignal& stop) {
  print_addresses(bench, link);
  const WakeUp end;
  auto running = std::async(std::launch::async, [&] { bench.run(end); });
  const auto ended = [&] {
    return running.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  };
  while (!stop.wait_for(std::chrono::milliseconds(200)) && !ended()) {
  }
  end.notify();
  running.get();  // throws what the bench could not go on with
}

void replay_capture(const std::string& path, const sim::BenchOptions& options, StopSignal& stop) {
  auto capture = load_capture(path);
  if (!capture) throw ExitError(kExitBadData, capture.reason());
  for (const std::string& remark : capture->remarks) log_info("{}", remark);
  sim::CaptureBench bench({std::move(capture->lidar), std::move(capture->stepper),
                           options.server.port, options.stepper_link},
                          [](const std::string& words) { log_warning("{}", words); });
  serve(bench, options.stepper_link, stop);
  log_info("{} times something else was asked than in the capture", bench.differences());
}

}  // namespace

int main(int argc, char** argv) {
  StopSignal stop;
  CLI::App app("Stands in for lidar and stepper on the real wires, and knows the truth",
               "swivel-bench");
  BenchCommandLine command_line(app);
  return run_program(app, argc, argv, [&] {
    start_log("swivel-bench", command_line.log_level());
    const sim::BenchOptions options = command_line.options();
    try {
      if (!command_line.capture().empty()) {
        replay_capture(command_line.capture(), options, stop);
        return kExitOk;
      }
      sim::Bench bench(options);
      serve(bench, options.stepper_link, stop);
      log_losses(bench);
      return kExitOk;
    } catch (const ExitError&) {
      throw;
    } catch (const std::exception& error) {
      throw ExitError(kExitUnavailable, error.what());
    }
  });
}
