// The bench and the real participants, in a domain of their own, with what they say and what
// the bench knows.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "components/common/sweep_requester.hpp"
#include "components/dds/participant.hpp"
#include "components/swivel/live/child_process.hpp"
#include "tests/components/swivel/scratch_folder.hpp"

namespace swivel::test {

// The true shaft.
struct Shaft {
  std::int64_t time_ns = 0;
  double angle_deg = 0.0;
  double lowest_deg = 0.0;
  double highest_deg = 0.0;
};

// Where the rig runs; by itself, on this computer alone.
struct FaultRigPlace {
  std::string network = "loopback";
  std::string discovery_server;
  std::vector<std::string> peers;
  std::string security_folder;  // with "fault_test" in it
  // Called before a program is started, and before the test itself joins, as "fault_test".
  std::function<void(const std::string& program)> go_to = [](const std::string&) {};
};

// What a test may want otherwise than the others.
struct FaultRigOptions {
  FaultRigPlace place;
  std::vector<std::string> bench;  // arguments
  std::string preload;             // a library that the dynamic linker puts before all others
};

class FaultRig {
 public:
  explicit FaultRig(const std::vector<std::string>& participants, FaultRigOptions options = {});
  ~FaultRig();

  // What the bench answers, without its "ok". A command that it refuses fails the test.
  std::string bench(const std::string& command);
  Shaft shaft();

  void start(const std::string& participant);
  void signal(const std::string& participant, int number);  // 9 waits for its end
  pid_t process(const std::string& participant) const { return children_.at(participant)->id(); }

  bool ready();  // every participant has said so, in this life
  void ask(int mode = 1, int count = 1);
  // Asks for a sweep in mode 1, waits until this part of its window is over, and marks.
  bool go_into_a_sweep(double part = 0.3);
  void mark();   // what was said before does not count any more
  void leave();  // nobody but the participants is there any more

  using Sweeps = std::function<bool(const msg::Sweep&)>;
  std::optional<msg::Sweep> await(const Sweeps& wanted, double limit_s = 10.0);
  std::optional<msg::Sweep> await(msg::SweepPhase phase, double limit_s = 10.0);
  std::optional<msg::Attitude> await_attitude(std::uint64_t sweep_id, double limit_s = 5.0);
  using Healths = std::function<bool(const msg::Health&)>;
  std::optional<msg::Health> await_health(const std::string& participant, const Healths& wanted,
                                          double limit_s = 10.0);
  std::optional<msg::Health> await_error(const std::string& participant, const std::string& words,
                                         double limit_s = 10.0);
  std::int64_t marked_ns() const { return marked_ns_; }
  // The last that was said, before the mark too.
  std::optional<msg::Health> health(const std::string& participant);
  std::uint64_t counter(const std::string& participant, const std::string& name);

  std::optional<double> true_phi_deg(const msg::Attitude& attitude) const;

 private:
  void start_bench(const std::vector<std::string>& more);
  void join_domain();

  FaultRigPlace place_;
  ScratchFolder scratch_;
  std::string rig_file_;
  std::string domain_;
  std::vector<std::string> names_;
  std::string preload_;
  std::unique_ptr<ChildProcess> bench_;
  std::map<std::string, std::string> addresses_;
  std::map<std::string, std::unique_ptr<ChildProcess>> children_;
  int control_ = -1;

  std::mutex mutex_;  // of what follows
  std::vector<msg::Sweep> sweeps_;
  std::vector<msg::Attitude> attitudes_;
  std::vector<msg::Health> healths_;
  std::int64_t marked_ns_ = 0;

  std::unique_ptr<Participant> participant_;
  std::unique_ptr<Writer<msg::SweepRequest>> requests_;
  std::unique_ptr<SweepRequester> requester_;
};

// The attitude that was found, against the truth; fails where there is none.
void expect_true(FaultRig& rig, const msg::Attitude& attitude);

// Asks for a sweep, and holds it against the truth: every line in, the attitude right.
void expect_a_right_sweep(FaultRig& rig);

// Silences the lidar, so that the books can be closed: what the reader wrote, the assembler has.
void expect_balanced_books(FaultRig& rig);

// Starts one that was killed.
void expect_role_back_within_3_s(FaultRig& rig, const std::string& participant);

// Until the shaft stands: when it last moved.
std::int64_t time_of_standstill_ns(FaultRig& rig);

// The bench and its participants of a whole suite: to start them takes longer than a fault.
class FaultSuite : public ::testing::Test {
 public:
  static void SetUpTestSuite() {
    rig_ = std::make_unique<FaultRig>(std::vector<std::string>{
        "stepper_sequencer", "hokuyo_reader", "cloud_assembler", "attitude_corrector"});
  }
  static void TearDownTestSuite() { rig_.reset(); }

 protected:
  void SetUp() override {
    ASSERT_TRUE(rig().ready());
    rig().mark();
  }
  static FaultRig& rig() { return *rig_; }

 private:
  static inline std::unique_ptr<FaultRig> rig_;
};

}  // namespace swivel::test
