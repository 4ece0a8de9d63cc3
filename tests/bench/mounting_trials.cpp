#include "tests/bench/mounting_trials.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "hardware/sim/random.hpp"
#include "tests/bench/on_all_cores.hpp"

namespace swivel {
namespace {

constexpr std::uint64_t kMountingStream = 11;

sim::RoomOptions room_of(PanRoom room) {
  sim::RoomOptions options;
  options.roof_mm = 2000.0;
  if (room == PanRoom::kFurnished) return options;
  options.front_mm = 5200.0;
  options.left_mm = 3100.0;
  options.yaw_deg = 25.0;
  options.furniture.push_back({900.0, 300.0, 30.0, 1200.0, 250.0, 1900.0, 2000.0, 0.8});
  options.furniture.push_back({-800.0, -500.0, 30.0, 1200.0, 250.0, 1900.0, 2000.0, 0.8});
  return options;
}

double thread_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

const char* name_of(PanRoom room) {
  return room == PanRoom::kFurnished ? "furnished" : "lamps, 25 deg askew";
}

PanScan drawn_pan_scan(PanRoom room, std::uint64_t seed, std::size_t lines) {
  sim::Random random(seed, kMountingStream);
  PanScan scan;
  scan.seed = seed;
  scan.lines = lines;
  scan.room = room_of(room);
  scan.bias_deg = random.uniform(-5.0, 5.0);
  scan.ry_deg = random.uniform(-0.6, 0.6);
  scan.tx_mm = random.uniform(-30.0, 30.0);
  scan.ty_mm = random.uniform(-30.0, 30.0);
  return scan;
}

double MountingTrial::error(MountingValue value) const {
  return result.fit->solution.value[value] - true_mounting(scan)[value];
}

std::vector<MountingTrial> run_mounting_trials(const std::vector<PanScan>& scans) {
  std::vector<MountingTrial> trials(scans.size());
  on_all_cores(scans.size(), [&](std::size_t index) {
    const SweepReadings readings = scan_of(scans[index]);
    const double start_s = thread_time_s();
    MountingResult result = fit_mounting(readings, RigGeometry());
    trials[index] = {scans[index], std::move(result), thread_time_s() - start_s};
  });
  return trials;
}

ErrorsOfValue errors_of(const std::vector<MountingTrial>& trials, MountingValue value) {
  ErrorsOfValue errors;
  double squares = 0.0;
  double squares_in_sigmas = 0.0;
  for (const MountingTrial& trial : trials) {
    if (!trial.result.fit) continue;
    ++errors.found;
    const double error = trial.error(value);
    errors.largest = std::max(errors.largest, std::abs(error));
    squares += error * error;
    squares_in_sigmas += std::pow(error / trial.result.fit->sigma_of(value), 2);
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, errors.found));
  errors.rms = std::sqrt(squares / count);
  errors.rms_in_sigmas = std::sqrt(squares_in_sigmas / count);
  return errors;
}

std::optional<RoofTrial> try_roof(const PanScan& scan) {
  const RigGeometry nominal;
  const SweepReadings readings = scan_of(scan);
  const MountingResult result = fit_mounting(readings, nominal);
  if (!result.fit) return std::nullopt;
  const auto roof = look_at_roof(readings, nominal, *result.fit);
  if (!roof) return std::nullopt;
  RoofTrial trial;
  std::transform(roof->off_m.begin(), roof->off_m.end(), trial.steps_m.begin(), mean_deviation_m);
  trial.noise_m = mean_deviation_m(
      off_their_plane_m(roof->rays, readings, {nominal, true_mounting(scan), readings}));
  return trial;
}

}  // namespace swivel
