// The whole pipeline for as long as is asked for, in SWIVEL_SOAK_MINUTES: ./run soak. Nothing may
// grow, nothing may be lost, every sweep must be right.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/components/faults/fault_rig.hpp"

namespace swivel::test {
namespace {

using std::chrono::steady_clock;

constexpr std::array<int, 5> kModes{7, 1, 4, 2, 1};
constexpr std::array<int, 8> kLinesOfMode{0, 40, 80, 160, 200, 320, 400, 640};
constexpr int kWarmUpRounds = 3;  // until every history holds its largest messages
constexpr double kMostGrowth_mb = 2.0;
// The counter of the lidar wraps once the warm-up is over, as it does every 4.7 hours.
constexpr const char* kStampStart_ms = "16600000";
constexpr std::uint32_t kWrap_ms = 1U << 24;

struct Footprint {
  double memory_mb = 0.0;  // its own: heap and stacks; not its program's file
  int threads = 0;
  int descriptors = 0;
};

Footprint footprint_of(pid_t process) {
  const std::string folder = "/proc/" + std::to_string(process);
  std::ifstream status(folder + "/status");
  Footprint footprint;
  std::string key;
  while (status >> key) {
    double value = 0.0;
    if (key == "RssAnon:" && status >> value) footprint.memory_mb = value / 1024.0;
    if (key == "Threads:") status >> footprint.threads;
  }
  std::error_code gone;
  const std::filesystem::directory_iterator files(folder + "/fd", gone);
  footprint.descriptors = static_cast<int>(std::distance(begin(files), end(files)));
  return footprint;
}

// What all share. A process's part of it says nothing: who reads a cloud of 11 MB here and there in
// its writer's segment comes to hold ever more of the same pages.
Footprint shared_memory() {
  std::error_code none;
  const std::filesystem::space_info space = std::filesystem::space("/dev/shm", none);
  Footprint footprint;
  footprint.memory_mb = static_cast<double>(space.capacity - space.free) / (1 << 20);
  return footprint;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Of one process, a footprint a round.
class Growth {
 public:
  void add(const Footprint& footprint) { footprints_.push_back(footprint); }

  void expect_none(const std::string& name) const {
    const std::size_t part = std::max<std::size_t>(footprints_.size() / 4, 1);
    const double first_mb = median(memory_mb(0, part));
    const double last_mb = median(memory_mb(footprints_.size() - part, footprints_.size()));
    const Footprint& first = footprints_.front();
    const Footprint& last = footprints_.back();
    std::printf("%-20s %7.2f -> %7.2f MB, %2d -> %2d threads, %3d -> %3d descriptors\n",
                name.c_str(), first_mb, last_mb, first.threads, last.threads, first.descriptors,
                last.descriptors);
    EXPECT_LT(last_mb - first_mb, kMostGrowth_mb) << name;
    EXPECT_LE(last.threads, first.threads) << name;
    EXPECT_LE(last.descriptors, first.descriptors) << name;
  }

 private:
  std::vector<double> memory_mb(std::size_t begin, std::size_t end) const {
    std::vector<double> values;
    for (std::size_t i = begin; i < end; ++i) values.push_back(footprints_[i].memory_mb);
    return values;
  }

  std::vector<Footprint> footprints_;
};

class Soak : public ::testing::Test {
 protected:
  void sweep_in(int mode) {
    rig_.mark();
    rig_.ask(mode);
    const auto assembled = rig_.await(msg::PHASE_ASSEMBLED, 40.0);
    ASSERT_TRUE(assembled) << "mode " << mode << ", sweep " << sweeps_;
    EXPECT_TRUE(assembled->complete()) << assembled->reason();
    EXPECT_EQ(assembled->lines_used(),
              static_cast<std::uint32_t>(kLinesOfMode[static_cast<std::size_t>(mode)]));
    const auto attitude = rig_.await_attitude(assembled->sweep_id(), 20.0);
    ASSERT_TRUE(attitude);
    EXPECT_EQ(attitude->verdict(), msg::VERDICT_GOOD) << attitude->reason();
    expect_true(rig_, *attitude);
    EXPECT_TRUE(rig_.await(msg::PHASE_IDLE, 20.0));
    ++sweeps_;
    wraps_ += attitude->first_device_stamp_ms() < last_stamp_ms_ ? 1 : 0;
    last_stamp_ms_ = attitude->first_device_stamp_ms();
  }

  void measure() {
    for (const std::string& name : names_) growth_[name].add(footprint_of(rig_.process(name)));
    growth_["/dev/shm"].add(shared_memory());
  }

  const std::vector<std::string> names_{"stepper_sequencer",  "hokuyo_reader",    "cloud_assembler",
                                        "attitude_corrector", "alpha_calibrator", "view_gateway"};
  FaultRig rig_{names_, {{}, {"--stamp-start-ms", kStampStart_ms}, {}}};
  std::map<std::string, Growth> growth_;
  int sweeps_ = 0;
  int wraps_ = 0;
  std::uint32_t last_stamp_ms_ = 0;
};

TEST_F(Soak, NothingGrowsAndNothingIsLost) {
  const char* const asked = std::getenv("SWIVEL_SOAK_MINUTES");
  const double minutes = asked == nullptr ? 30.0 : std::atof(asked);
  ASSERT_TRUE(rig_.ready());
  const auto began = steady_clock::now();
  const auto elapsed_min = [&] {
    return std::chrono::duration<double>(steady_clock::now() - began).count() / 60.0;
  };
  for (int round = 0; round < kWarmUpRounds + 4 || elapsed_min() < minutes; ++round) {
    for (const int mode : kModes) ASSERT_NO_FATAL_FAILURE(sweep_in(mode));
    if (round >= kWarmUpRounds) measure();
  }
  std::printf("%.1f minutes, %d sweeps, the stamps wrapped %d times\n", elapsed_min(), sweeps_,
              wraps_);
  for (const auto& [name, growth] : growth_) growth.expect_none(name);
  EXPECT_EQ(rig_.counter("hokuyo_reader", "clock_restarts"), 0U);
  EXPECT_EQ(rig_.counter("hokuyo_reader", "scans_lost"), 0U);
  expect_balanced_books(rig_);
}

}  // namespace
}  // namespace swivel::test
