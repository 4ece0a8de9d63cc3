// ./run bench: the speed of what is ours, each as a ratio to a plain loop or a memcpy measured
// in the same run, since these machines are noisy. The last lines are the ones to read.
#include <benchmark/benchmark.h>

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <map>
#include <optional>
#include <random>

#include "calibration/line_assembly.hpp"
#include "calibration/transform_cloud.hpp"
#include "components/common/cloud_message.hpp"
#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/keys/key_folder.hpp"
#include "hardware/lidar/scip_parser.hpp"
#include "hardware/lidar/scip_replies.hpp"
#include "swivel/idl/point_cloud2PubSubTypes.h"
#include "tests/bench/end_to_end.hpp"
#include "tests/bench/mode_7.hpp"

namespace swivel {
namespace {

constexpr double kAnglePerLine_rad = kPi / kLines;

std::vector<std::uint16_t> some_ranges(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> range_mm(60, 9000);
  std::vector<std::uint16_t> ranges(kBeams);
  for (auto& range : ranges) range = static_cast<std::uint16_t>(range_mm(random));
  ranges[17] = 65533;
  return ranges;
}

std::string me_frame() {
  const auto ranges = some_ranges(1);
  std::string data;
  for (const std::uint16_t range : ranges) {
    scip::append_value(data, range, 3);
    scip::append_value(data, range / 2U, 3);
  }
  std::string frame = "ME0000108000000\n";
  scip::append_text(frame, "99");
  scip::append_text(frame, "0123");
  scip::append_data(frame, data);
  return frame + "\n";
}

void decode_me_scan(benchmark::State& state) {
  const std::string frame = me_frame();
  scip::Parser parser;
  for (auto _ : state) {
    for (const scip::Reply& reply : parser.push(frame)) {
      const auto scan = scip::decode_scan(reply, scip::Measurement::kRangesAndIntensities, kBeams);
      if (!scan) state.SkipWithError(scan.reason().c_str());
      benchmark::DoNotOptimize(scan->ranges_mm.data());
    }
  }
}
BENCHMARK(decode_me_scan);

// The same characters, the sums not looked at, into vectors that are there already.
void decode_plain_loop(benchmark::State& state) {
  const std::string frame = me_frame();
  std::vector<std::uint32_t> values(2 * kBeams);
  for (auto _ : state) {
    const char* character = frame.data() + 24;
    for (auto& value : values) {
      value = 0;
      for (int i = 0; i < 3; ++i)
        value = value << 6 | static_cast<std::uint32_t>(*character++ - 0x30);
    }
    benchmark::DoNotOptimize(values.data());
  }
}
BENCHMARK(decode_plain_loop);

struct Lines {
  std::vector<std::vector<std::uint16_t>> ranges_mm;
  Lines() {
    for (unsigned line = 0; line < kLines; ++line) ranges_mm.push_back(some_ranges(line));
  }
};

void assemble_sweep(benchmark::State& state) {
  const Lines lines;
  RigGeometry rig;
  rig.T_axis_lidar.translate(Eigen::Vector3d(0.0139, 0, 0));
  LineAssembler assembler(ForwardModel(rig, rad_from_deg(-135), rad_from_deg(0.25), kBeams));
  OrganisedCloud cloud(kLines, kBeams);
  for (auto _ : state) {
    for (std::size_t line = 0; line < kLines; ++line) {
      const auto& ranges = lines.ranges_mm[line];
      assembler.assemble({ranges, ranges, 20, 30000}, static_cast<double>(line) * kAnglePerLine_rad,
                         kAnglePerLine_rad / 1440, cloud.line(line));
    }
    benchmark::DoNotOptimize(cloud.points.data());
  }
}
BENCHMARK(assemble_sweep)->Unit(benchmark::kMillisecond);

// x, y, z and intensity from beam directions that are known: no motion, no time.
void assemble_plain_loop(benchmark::State& state) {
  const Lines lines;
  std::vector<Eigen::Vector3f> directions(kBeams);
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    const double angle_rad = rad_from_deg(-135 + 0.25 * static_cast<double>(beam));
    directions[beam] = Eigen::Vector3d(0, std::sin(angle_rad), std::cos(angle_rad)).cast<float>();
  }
  OrganisedCloud cloud(kLines, kBeams);
  for (auto _ : state) {
    for (std::size_t line = 0; line < kLines; ++line) {
      const auto& ranges = lines.ranges_mm[line];
      CloudPoint* const row = cloud.line(line);
      for (std::size_t beam = 0; beam < kBeams; ++beam) {
        const float range_m = static_cast<float>(ranges[beam]) * 1e-3F;
        const Eigen::Vector3f point = range_m * directions[beam];
        row[beam] = {point.x(), point.y(), point.z(), static_cast<float>(ranges[beam])};
      }
    }
    benchmark::DoNotOptimize(cloud.points.data());
  }
}
BENCHMARK(assemble_plain_loop)->Unit(benchmark::kMillisecond);

OrganisedCloud some_cloud() {
  OrganisedCloud cloud(kLines, kBeams);
  float value = 0.0F;
  for (CloudPoint& point : cloud.points) point = {value += 0.001F, value, 1.0F, 100.0F};
  return cloud;
}

void correct_cloud(benchmark::State& state) {
  OrganisedCloud cloud = some_cloud();
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitZ()));
  for (auto _ : state) {
    transform_cloud(turn, cloud);
    benchmark::DoNotOptimize(cloud.points.data());
  }
}
BENCHMARK(correct_cloud)->Unit(benchmark::kMillisecond);

void correct_plain_loop(benchmark::State& state) {
  OrganisedCloud cloud = some_cloud();
  const float c = std::cos(1e-3F);
  const float s = std::sin(1e-3F);
  for (auto _ : state) {
    for (CloudPoint& point : cloud.points) {
      const float x_m = c * point.x_m - s * point.y_m;
      point.y_m = s * point.x_m + c * point.y_m;
      point.x_m = x_m;
    }
    benchmark::DoNotOptimize(cloud.points.data());
  }
}
BENCHMARK(correct_plain_loop)->Unit(benchmark::kMillisecond);

void serialise_cloud(benchmark::State& state) {
  PointCloud2Message message;
  to_message(some_cloud(), 1'700'000'000'000'000'000, "rig/base", message);
  sensor_msgs::msg::dds_::PointCloud2_PubSubType type;
  eprosima::fastrtps::rtps::SerializedPayload_t payload(
      static_cast<std::uint32_t>(message.data().size() + 4096));
  for (auto _ : state) {
    if (!type.serialize(&message, &payload)) state.SkipWithError("did not fit");
    benchmark::DoNotOptimize(payload.data);
  }
}
BENCHMARK(serialise_cloud)->Unit(benchmark::kMillisecond);

void copy_cloud(benchmark::State& state) {
  const OrganisedCloud cloud = some_cloud();
  OrganisedCloud copy(kLines, kBeams);
  for (auto _ : state) {
    std::memcpy(copy.points.data(), cloud.points.data(), cloud.points.size() * sizeof(CloudPoint));
    benchmark::DoNotOptimize(copy.points.data());
  }
}
BENCHMARK(copy_cloud)->Unit(benchmark::kMillisecond);

// Keeps the best of the repetitions: what disturbs only ever adds.
class Best : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      const double time_ms =
          run.GetAdjustedRealTime() * (run.time_unit == benchmark::kMillisecond ? 1 : 1e-6);
      const auto [best, first] = best_ms_.emplace(run.run_name.function_name, time_ms);
      if (!first) best->second = std::min(best->second, time_ms);
    }
    ConsoleReporter::ReportRuns(runs);
  }

  // Of a benchmark that was not filtered out.
  std::optional<double> ms(const std::string& name) const {
    const auto found = best_ms_.find(name);
    return found == best_ms_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::map<std::string, double> best_ms_;
};

void print_ratio(const Best& best, const char* what, const char* name, const char* baseline,
                 const char* aim) {
  const auto time_ms = best.ms(name);
  const auto plain_ms = best.ms(baseline);
  if (!time_ms || !plain_ms) return;
  std::printf("%-52s %6.2f x %-22s %s\n", what, *time_ms / *plain_ms, baseline, aim);
}

// The shipped permissions, and those of the benchmark, which stands in for the hardware.
EndToEnd measure_secured(int sweeps) {
  const std::int64_t now_s = std::time(nullptr);
  KeyFolderOptions keys{"swivel",
                        read_document(shared_file("security/governance.xml")),
                        load_grants(shared_file("security/permissions.yaml")),
                        {now_s - 60, now_s + 3600},
                        {}};
  keys.grants.push_back({"benchmark", {"scan_line", "axis", "sweep"}, {"cloud", "health"}});
  const std::string folder =
      std::filesystem::temp_directory_path() / ("swivel_bench_keys_" + std::to_string(getpid()));
  make_key_folder(folder, keys);
  EndToEnd result = measure_end_to_end(sweeps, folder);
  std::filesystem::remove_all(folder);
  return result;
}

void print_secured(const EndToEnd& secured, const EndToEnd& plain) {
  std::printf("%-52s %6.1f ms, %.2f x in the clear; two clouds of 11 MB cross\n",
              "the same with --security, all of it encrypted", secured.median_ms,
              secured.median_ms / plain.median_ms);
}

void print_summary(const Best& best) {
  std::printf("\n");
  print_ratio(best, "decode of an ME scan, sums checked", "decode_me_scan", "decode_plain_loop",
              "");
  print_ratio(best, "assembly, per-beam time and rotation", "assemble_sweep", "assemble_plain_loop",
              "(aim: at most 2)");
  print_ratio(best, "correction of a cloud", "correct_cloud", "correct_plain_loop", "");
  print_ratio(best, "serialisation of a cloud", "serialise_cloud", "copy_cloud", "");
  const auto copy_ms = best.ms("copy_cloud");
  if (!copy_ms) return;
  constexpr int kSweeps = 5;
  const EndToEnd result = measure_end_to_end(kSweeps);
  std::printf("%-52s %6.1f ms, median of %zu (aim: at most 60 ms and 4 copies, %.1f ms)\n",
              "end to end over DDS, mode 7", result.median_ms, result.times_ms.size(),
              60.0 + 4.0 * *copy_ms);
  for (const auto& [name, megabytes] : result.peak_memory_mb) {
    std::printf("%-20s at most %.0f MB (aim: at most 150)\n", name.c_str(), megabytes);
  }
  print_secured(measure_secured(kSweeps), result);
}

}  // namespace
}  // namespace swivel

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  swivel::Best best;
  benchmark::RunSpecifiedBenchmarks(&best);
  swivel::print_summary(best);
  return 0;
}
