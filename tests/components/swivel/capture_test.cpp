// What passes over the wires of a live rig, captured in the midst of it, and served again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <optional>
#include <sstream>

#include "components/common/cloud_message.hpp"
#include "components/common/roll.hpp"
#include "components/swivel/live/child_process.hpp"
#include "run_swivel.hpp"
#include "scratch_folder.hpp"
#include "tests/components/dds/test_participant.hpp"

namespace swivel {
namespace {

// Bench, participants and one who listens.
class LiveRig {
 public:
  LiveRig(const ScratchFolder& scratch, const std::vector<std::string>& bench_options)
      : scratch_(scratch), bench_("swivel-bench", bench_options, true) {
    std::istringstream words(bench_.read_line(std::chrono::seconds(10)).value_or(""));
    std::string word, lidar, stepper;
    words >> word >> lidar >> word >> stepper;
    participant_.subscribe<PointCloud2>(kRawCloudTopic, [this](const PointCloud2& message) {
      const std::lock_guard lock(mutex_);
      EXPECT_EQ(from_message(message, cloud_), "");
    });
    participant_.start();
    up_ = std::make_unique<ChildProcess>(
        "swivel", std::vector<std::string>{"up", "--domain", domain_, "--log-level", "error",
                                           "--lidar", lidar, "--stepper", stepper, "--calibration",
                                           scratch.file("none.yaml")});
    EXPECT_EQ(roll_.await({"stepper_sequencer", "hokuyo_reader", "cloud_assembler"},
                          std::chrono::seconds(20)),
              "");
  }
  ~LiveRig() {
    up_.reset();
    participant_.stop();
  }

  // The raw cloud of a sweep, whatever becomes of its attitude.
  OrganisedCloud scan() {
    const int code = run_swivel(scratch_, "scan --mode 1 --no-clouds --no-pictures -o " +
                                              scratch_.file("scan") + " --domain " + domain_);
    EXPECT_TRUE(code == 0 || code == 65) << content_of(scratch_.file("err"));
    EXPECT_TRUE(wait_until([this] {
      const std::lock_guard lock(mutex_);
      return !cloud_.points.empty();
    }));
    const std::lock_guard lock(mutex_);
    return std::move(cloud_);
  }
  const std::string& domain() const { return domain_; }

 private:
  static ParticipantOptions listener(const std::string& domain) {
    ParticipantOptions options = loopback_participant("capture_test", std::stoi(domain));
    options.rig = "swivel";
    return options;
  }

  const ScratchFolder& scratch_;
  const std::string domain_ = std::to_string(domain_of_this_test());
  ChildProcess bench_;
  std::mutex mutex_;
  OrganisedCloud cloud_;
  Participant participant_{listener(domain_)};
  Roll roll_{participant_};
  std::unique_ptr<ChildProcess> up_;
};

// How many of a line's beams see the same, wherever the axis stood.
std::size_t equal_beams(const OrganisedCloud& a, std::size_t line_a, const OrganisedCloud& b,
                        std::size_t line_b) {
  std::size_t equal = 0;
  for (std::size_t beam = 0; beam < a.beams; ++beam) {
    const CloudPoint& p = a.line(line_a)[beam];
    const CloudPoint& q = b.line(line_b)[beam];
    const bool same = p.valid() && q.valid()
                          ? std::abs(std::hypot(p.x_m, p.y_m) - std::hypot(q.x_m, q.y_m)) < 1e-5F &&
                                p.z_m == q.z_m && p.intensity == q.intensity
                          : p.valid() == q.valid();
    equal += same ? 1 : 0;
  }
  return equal;
}

// Line k of the original is line k + shift of the other: found by a line in the original's midst.
std::optional<int> shift_between(const OrganisedCloud& original, const OrganisedCloud& again) {
  const std::size_t middle = original.lines / 2;
  for (std::size_t line = 0; line < again.lines; ++line) {
    if (equal_beams(original, middle, again, line) == original.beams) {
      return static_cast<int>(line) - static_cast<int>(middle);
    }
  }
  return std::nullopt;
}

// The stream follows the motor as closely as the computers had time to read it, in the capture and
// now, so that the window may hold some lines more at one end and as many less at the other. All
// those that both have whole are the same.
void expect_same_lines(const OrganisedCloud& original, const OrganisedCloud& again) {
  const std::optional<int> shift = shift_between(original, again);
  ASSERT_TRUE(shift) << "the line in the midst of the original is nowhere in the other";
  const auto lines = static_cast<int>(original.lines);
  for (int line = std::max(1, 1 - *shift); line + 1 < std::min(lines, lines - *shift); ++line) {
    EXPECT_EQ(equal_beams(original, static_cast<std::size_t>(line), again,
                          static_cast<std::size_t>(line + *shift)),
              original.beams)
        << "line " << line << ", shift " << *shift;
  }
}

TEST(Capture, ServedAgainGivesTheSameSweep) {
  const ScratchFolder scratch;
  const std::string capture = scratch.file("capture.mcap");
  OrganisedCloud original;
  {
    LiveRig rig(scratch, {"--seed", "3", "--home-time-s", "0.2", "--log-level", "error"});
    ChildProcess recorder("swivel", {"capture", "-o", capture, "--domain", rig.domain()});
    original = rig.scan();
    EXPECT_EQ(
        run_swivel(scratch, "map live -o " + scratch.file("map") + " --domain " + rig.domain()), 0);
    EXPECT_GT(std::filesystem::file_size(scratch.file("map/top_view_00.png")), 10000U);
    recorder.ask_to_stop();
    ASSERT_TRUE(recorder.wait_or_kill(std::chrono::seconds(20)));
    EXPECT_EQ(recorder.exit_code(), 0);
  }
  ASSERT_EQ(original.lines, 40U);
  EXPECT_EQ(run_swivel(scratch, "check " + capture), 0) << content_of(scratch.file("out"));

  LiveRig rig(scratch, {"--replay-capture", capture, "--log-level", "error"});
  const OrganisedCloud again = rig.scan();
  ASSERT_EQ(again.lines, 40U);
  expect_same_lines(original, again);
}

}  // namespace
}  // namespace swivel
