// stepper_sequencer: homes the shaft and, for each request, turns it through a sweep and back.
// Says when the speed is constant, and the axis angle over time.
#include "components/common/health_reporter.hpp"
#include "components/common/phase_word.hpp"
#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/common/strict_yaml.hpp"
#include "components/common/wire_publisher.hpp"
#include "components/log/log.hpp"
#include "components/stepper_sequencer/sequencer.hpp"

namespace {

using namespace swivel;

constexpr double kMeasuringInterval_s = 0.02;  // from one measured angle to the next

SequencerOptions sequencer_options(const RigFile& rig, const std::string& address) {
  if (!rig.stepper) throw ConfigurationError(rig.path + ": has no 'stepper' section to turn");
  SequencerOptions options;
  options.rig = rig.rig;
  options.stepper.address = address.empty() ? rig.stepper->address : address;
  options.stepper.limits.home_angle_deg = rig.stepper->home_angle_deg;
  options.stepper.limits.cable_limit_deg = rig.stepper->cable_limit_deg;
  options.stepper.limits.minimum_step_rate_hz = rig.stepper->minimum_step_rate_hz;
  options.stepper.limits.max_speed_deg_s = rig.stepper->max_speed_deg_s;
  options.stepper.guard_program = program_directory() + "/motor_guard";
  options.sweep.sweep_angle_deg = rig.modes.sweep_angle_deg;
  options.sweep.lines_of_mode.clear();
  for (const auto& [mode, lines] : rig.modes.lines) {
    options.sweep.lines_of_mode[mode] = static_cast<std::uint32_t>(lines);
  }
  options.sweep.line_period_s = rig.modes.line_period_s;
  options.sweep.settle_s = rig.stepper->settle_s;
  options.sweep.return_speed_deg_s = rig.stepper->return_speed_deg_s;
  options.sweep.axis_measured = rig.axis_measured;
  if (rig.axis_measured) options.poll_interval_s = kMeasuringInterval_s;
  return options;
}

void tell(const msg::Sweep& sweep, HealthReporter& health) {
  const std::string reason = sweep.reason().empty() ? "" : ": " + sweep.reason();
  if (sweep.phase() == msg::PHASE_FAULT) {
    health.error("motor fault" + reason);
  } else if (sweep.phase() == msg::PHASE_REFUSED) {
    log_warning("request refused{}", reason);
  } else if (sweep.window_first_line() == 0) {  // stop_and_go cruises once a line
    log_info("{}{}", phase_word(sweep.phase()), reason);
  }
}

void report(const Sequencer& sequencer, HealthReporter& health) {
  const SequencerHealth now = sequencer.health();
  health.set_counter("sweeps_done", now.sweeps_done);
  health.set_counter("requests_refused", now.requests_refused);
  health.set_counter("faults", now.faults);
  health.set_counter("garbage_lines", now.garbage_lines);
  health.set_counter("positions_left_out", now.positions_left_out);
  if (!now.firmware.empty()) health.set_fact("controller", "GRBL " + now.firmware);
  for (std::size_t i = 0; i < now.advice.size(); ++i) {
    health.set_fact("advice " + std::to_string(i + 1), now.advice[i]);
  }
  health.set_state(now.ready ? msg::HEALTH_OK : msg::HEALTH_WAITING, now.doing);
}

// Once all who listened have left, by themselves or with the network, nobody sees where the
// shaft goes: what is under way is cancelled.
class Audience {
 public:
  void check(std::size_t listeners, Sequencer& sequencer) {
    const bool has_left = listeners == 0 && listeners_ > 0;
    listeners_ = listeners;
    if (has_left && sequencer.cancel())
      log_warning("nobody listens any more: the sweep under way is cancelled");
  }

 private:
  std::size_t listeners_ = 0;
};

void sequence(const CommonOptions& options, const std::string& address, StopSignal& stop) {
  const RigFile rig = load_rig_file(options.rig_file);
  SequencerOptions sequencer_settings = sequencer_options(rig, address);
  Participant participant(options.participant("stepper_sequencer", rig.rig));
  HealthReporter health(participant);
  Writer<msg::Sweep> sweeps(participant, kSweepTopic);
  Writer<msg::Axis> axis(participant, kAxisTopic);
  WirePublisher wire(participant, msg::WIRE_OF_STEPPER);
  sequencer_settings.stepper.tap = wire.tap();
  Audience audience;
  Sequencer sequencer(sequencer_settings,
                      {[&](const msg::Sweep& sweep) {
                         tell(sweep, health);
                         sweeps.write(msg::Sweep(sweep));
                       },
                       [&](const msg::Axis& samples) { axis.write(msg::Axis(samples)); }});
  health.watch_over([&] { return sequencer.works(); });
  participant.subscribe<msg::SweepRequest>(
      kSweepRequestTopic, [&](const auto& request) { sequencer.request(request); });
  participant.on_tick(std::chrono::milliseconds(200), [&] {
    audience.check(sweeps.reader_count(), sequencer);
    health.set_counter("messages_not_sent", sweeps.failures() + axis.failures() + wire.not_sent());
    report(sequencer, health);
  });
  participant.start();
  sequencer.start();
  stop.wait();
  sequencer.stop();  // first of all
  participant.stop();
}

}  // namespace

int main(int argc, char** argv) {
  ParticipantProgram program("stepper_sequencer", "Turns the lidar through sweeps");
  std::string address;
  program.add_option("--stepper", address,
                     "/dev/NAME[@BAUD] or tcp://HOST:PORT, instead of the rig's");
  return program.run(argc, argv, [&](const CommonOptions& options, StopSignal& stop) {
    sequence(options, address, stop);
  });
}
