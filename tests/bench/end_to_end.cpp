#include "tests/bench/end_to_end.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>

#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/common/roll.hpp"
#include "components/dds/participant.hpp"
#include "components/swivel/live/child_process.hpp"
#include "hardware/io/clock.hpp"
#include "tests/bench/mode_7.hpp"

namespace swivel {
namespace {

using std::chrono::steady_clock;

constexpr int kDomain = 74;
constexpr double kPeriod_ns = 25.04e6;
constexpr double kSpeed_deg_s = 11.25;

// The peak of the resident set, as the kernel counts it: shared memory included.
double peak_memory_mb(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0.0;
}

// A round room, and where the plate is something that fills the ring: the estimator works in full.
void set_ranges(double phi_deg, msg::ScanLine& line) {
  constexpr double kPlateDepth_mm = 60.935;
  constexpr std::size_t kPlateBeams = 66;
  line.ranges_mm().assign(kBeams, 2500);
  if (std::abs(phi_deg - 120.0) > 40.0) return;
  for (std::size_t beam = 0; beam < kPlateBeams; ++beam) {
    const double angle_rad = rad_from_deg(-135.0 + 0.25 * static_cast<double>(beam));
    line.ranges_mm()[beam] = static_cast<std::uint16_t>(-kPlateDepth_mm / std::cos(angle_rad));
  }
}

msg::ScanLine line_at(std::int64_t time_ns, double phi_deg) {
  msg::ScanLine line;
  line.beam0_time_ns(time_ns);
  line.first_beam_angle_deg(-135);
  line.beam_step_deg(0.25);
  line.scan_period_ns(kPeriod_ns);
  line.beam_period_ns(kPeriod_ns / 1440);
  line.range_min_mm(20);
  line.range_max_mm(30000);
  set_ranges(phi_deg, line);
  line.intensities().assign(kBeams, 1000);
  return line;
}

class Sweeper {
 public:
  explicit Sweeper(Participant& participant)
      : lines_(participant, kScanLineTopic),
        axis_(participant, kAxisTopic),
        sweeps_(participant, kSweepTopic) {
    participant.subscribe<PointCloud2>(kCloudTopic, [this](const auto&) {
      taken_ = steady_clock::now();
      ++clouds_;
    });
  }

  // The time from the last line to the cloud.
  double sweep_ms(std::uint64_t id) {
    const std::int64_t start_ns = now_ns();
    announce(id, start_ns);
    for (std::uint32_t line = 0; line < kLines; ++line) {
      if (line % 50 == 0) lines_.wait_until_acknowledged(std::chrono::seconds(5));
      if (line + 1 == kLines) usleep(200'000);  // as live: the lines before are long assembled
      published_ = steady_clock::now();
      lines_.write(line_at(start_ns + std::llround(line * kPeriod_ns),
                           line * kPeriod_ns * 1e-9 * kSpeed_deg_s));
    }
    const int before = static_cast<int>(id) - 1;
    const auto deadline = steady_clock::now() + std::chrono::seconds(20);
    while (clouds_ == before && steady_clock::now() < deadline) usleep(200);
    if (clouds_ == before) throw ExitError(kExitUnavailable, "no cloud came back");
    lines_.wait_until_acknowledged(std::chrono::seconds(5));
    return std::chrono::duration<double, std::milli>(taken_.load() - published_).count();
  }

 private:
  void announce(std::uint64_t id, std::int64_t start_ns) {
    const std::int64_t end_ns = start_ns + std::llround((kLines + 2) * kPeriod_ns);
    msg::Axis axis;
    axis.source(msg::AXIS_COMMANDED);
    for (const std::int64_t time_ns : {start_ns, end_ns}) {
      msg::AxisSample sample;
      sample.time_ns(time_ns);
      sample.angle_deg(static_cast<double>(time_ns - start_ns) * 1e-9 * kSpeed_deg_s);
      axis.samples().push_back(sample);
    }
    axis_.write(axis);
    msg::Sweep sweep;
    sweep.sweep_id(id);
    sweep.phase(msg::PHASE_CRUISING);
    sweep.mode(7);
    sweep.lines_expected(kLines);
    sweep.window_lines(kLines);
    sweep.window_start_ns(start_ns - 1'000'000);
    sweep.window_end_ns(end_ns);
    sweeps_.write(sweep);
    axis_.wait_until_acknowledged(std::chrono::seconds(5));
    sweeps_.wait_until_acknowledged(std::chrono::seconds(5));
  }

  Writer<msg::ScanLine> lines_;
  Writer<msg::Axis> axis_;
  Writer<msg::Sweep> sweeps_;
  steady_clock::time_point published_;
  std::atomic<steady_clock::time_point> taken_{steady_clock::time_point()};
  std::atomic<int> clouds_{0};
};

}  // namespace

EndToEnd measure_end_to_end(int sweeps, const std::string& security_folder) {
  CommonOptions common;
  common.rig_file = shared_file("rigs/yuan.yaml");
  common.profiles_file = shared_file("dds_profiles.xml");
  common.domain = kDomain;
  common.log_level = "error";
  common.security_folder = security_folder;
  const std::vector<std::string> arguments = common.as_arguments();
  ChildProcess assembler("cloud_assembler", arguments);
  ChildProcess corrector("attitude_corrector", arguments);
  Participant participant(common.participant("benchmark", "swivel"));
  const Roll roll(participant);
  Sweeper sweeper(participant);
  participant.start();
  const auto deadline = steady_clock::now() + std::chrono::seconds(20);
  while (roll.entries().size() < 2 && steady_clock::now() < deadline) usleep(10'000);

  EndToEnd result;
  for (int sweep = 1; sweep <= sweeps; ++sweep) {
    result.times_ms.push_back(sweeper.sweep_ms(static_cast<std::uint64_t>(sweep)));
  }
  for (const auto& [name, entry] : roll.entries()) {
    result.peak_memory_mb[name] = peak_memory_mb(static_cast<pid_t>(entry.last.process_id()));
  }
  auto sorted = result.times_ms;
  std::sort(sorted.begin(), sorted.end());
  result.median_ms = sorted[sorted.size() / 2];
  return result;
}

}  // namespace swivel
