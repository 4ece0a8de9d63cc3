// The pipeline on two computers: lidar, stepper and the test on the robot, the rest on the
// workstation.
#include <gmock/gmock.h>
#include <signal.h>

#include <atomic>
#include <ctime>
#include <memory>
#include <set>

#include "components/keys/key_folder.hpp"
#include "tests/components/dds/test_participant.hpp"
#include "tests/components/faults/fault_rig.hpp"
#include "tests/components/faults/two_networks.hpp"

namespace swivel::test {
namespace {

const Link kBadLink{0.05, 0.005, 100e6 / 8};
constexpr std::uint64_t kLinesIn1_s = 40;

Machine machine_of(const std::string& program) {
  static const std::set<std::string> workstation{"cloud_assembler", "attitude_corrector"};
  return workstation.count(program) != 0 ? Machine::kWorkstation : Machine::kRobot;
}

// A rig on two computers, for a whole suite.
class TwoComputers {
 public:
  enum class Discovery { kMulticast, kServer, kPeersWithKeys };

  explicit TwoComputers(Discovery discovery) {
    if (!networks_.refused().empty()) return;
    FaultRigPlace place;
    place.network = "lan";
    place.go_to = [this](const std::string& program) { networks_.enter(machine_of(program)); };
    if (discovery != Discovery::kMulticast) networks_.forbid_multicast();
    if (discovery == Discovery::kServer) {
      place.discovery_server = TwoNetworks::address(Machine::kRobot);
      start_discovery_server(place.discovery_server);
    } else if (discovery == Discovery::kPeersWithKeys) {
      place.peers = {TwoNetworks::address(Machine::kRobot),
                     TwoNetworks::address(Machine::kWorkstation)};
      place.security_folder = scratch_.file("keys");
      make_keys(place.security_folder);
    }
    rig_ = std::make_unique<FaultRig>(
        std::vector<std::string>{"stepper_sequencer", "hokuyo_reader", "cloud_assembler",
                                 "attitude_corrector"},
        FaultRigOptions{place, {}, {}});
  }

  TwoNetworks& networks() { return networks_; }
  FaultRig& rig() { return *rig_; }

 private:
  void start_discovery_server(const std::string& address) {
    networks_.enter(Machine::kRobot);
    ParticipantOptions options = loopback_participant("discovery_server", domain_of_this_test());
    options.network = "lan";
    options.discovery_server = address;
    options.serves_discovery = true;
    server_ = std::make_unique<Participant>(options);
    server_->start();
  }

  // As shipped, and for the test itself.
  static void make_keys(const std::string& folder) {
    const std::int64_t now_s = std::time(nullptr);
    const std::string security = SWIVEL_CONFIG "/security";
    KeyFolderOptions keys{"swivel",
                          read_document(security + "/governance.xml"),
                          load_grants(security + "/permissions.yaml"),
                          {now_s - 60, now_s + 3600},
                          {}};
    keys.grants.push_back({"fault_test", {"sweep_request"}, {"sweep", "attitude", "health"}});
    make_key_folder(folder, keys);
  }

  ScratchFolder scratch_;
  TwoNetworks networks_;
  std::unique_ptr<Participant> server_;
  std::unique_ptr<FaultRig> rig_;
};

class TwoComputersSuite : public ::testing::Test {
 public:
  static void TearDownTestSuite() { computers_.reset(); }

 protected:
  using Discovery = TwoComputers::Discovery;
  static void meet_by(Discovery discovery) {
    computers_ = std::make_unique<TwoComputers>(discovery);
  }

  void SetUp() override {
    const std::string& refused = computers_->networks().refused();
    if (!refused.empty()) GTEST_SKIP() << refused;
    ASSERT_TRUE(rig().ready());
    rig().mark();
    lost_before_ = samples_lost();
  }
  void TearDown() override { networks().set_link({}); }

  static TwoNetworks& networks() { return computers_->networks(); }
  static FaultRig& rig() { return computers_->rig(); }
  static std::uint64_t lines_written() { return rig().counter("hokuyo_reader", "lines_written"); }

  static std::uint64_t samples_lost() { return rig().counter("cloud_assembler", "samples_lost"); }
  // In this test.
  std::uint64_t lines_lost() const { return samples_lost() - lost_before_; }

  // What lasts so long. The reader writes on: held up, it would not write a line a second.
  static void let_the_reader_write(int seconds) {
    const std::uint64_t before = lines_written();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    wait_until([&] { return std::chrono::steady_clock::now() > end; },
               std::chrono::seconds(seconds + 1));
    EXPECT_GT(lines_written(), before + kLinesIn1_s * static_cast<std::uint64_t>(seconds) / 2);
  }

  // Every line that was written comes to the assembler in the end.
  void expect_no_line_lost() const {
    const std::uint64_t written = lines_written();
    const auto received = [] { return rig().counter("cloud_assembler", "lines_received"); };
    EXPECT_TRUE(wait_until([&] { return received() >= written; }))
        << received() << " of " << written;
    EXPECT_EQ(lines_lost(), 0U);
    EXPECT_EQ(rig().counter("hokuyo_reader", "lines_not_written"), 0U);
  }

  static inline std::unique_ptr<TwoComputers> computers_;
  std::uint64_t lost_before_ = 0;
};

class TwoMachines : public TwoComputersSuite {
 public:
  static void SetUpTestSuite() { meet_by(Discovery::kMulticast); }
};

// One on the robot who looks at the clouds, which go back there.
class Viewer {
 public:
  Viewer() : participant_(options()) {
    participant_.subscribe<PointCloud2>(
        kCloudTopic, [this](const auto& cloud) { cloud_bytes_ = cloud.data().size(); });
    participant_.start();
  }
  bool await_cloud_of(std::size_t lines) {
    constexpr std::size_t kBytesPerLine = 1081 * 16;
    return wait_until([&] { return cloud_bytes_ == lines * kBytesPerLine; },
                      std::chrono::seconds(60));
  }

 private:
  static ParticipantOptions options() {
    ParticipantOptions options = loopback_participant("viewer", domain_of_this_test());
    options.rig = "swivel";
    options.network = "lan";
    return options;
  }
  Participant participant_;
  std::atomic<std::size_t> cloud_bytes_{0};
};

TEST_F(TwoMachines, OverABadLinkLinesAndCloudsComeWhole) {
  networks().set_link(kBadLink);
  networks().enter(Machine::kRobot);
  Viewer viewer;
  expect_a_right_sweep(rig());
  EXPECT_TRUE(viewer.await_cloud_of(40));
  expect_no_line_lost();
}

TEST_F(TwoMachines, ASlowWorkstationHoldsNobodyUp) {
  rig().signal("cloud_assembler", SIGSTOP);
  let_the_reader_write(3);
  rig().signal("cloud_assembler", SIGCONT);
  expect_no_line_lost();
}

// Of health, too: ten samples of it, one a second, were sometimes too few for ten seconds.
TEST_F(TwoMachines, TwelveSecondsWithoutALinkLoseNothing) {
  networks().set_cable(false);
  let_the_reader_write(12);
  networks().set_cable(true);
  expect_no_line_lost();
  expect_a_right_sweep(rig());
}

TEST_F(TwoMachines, AParticipantThatWasKilledIsBackWithin3Seconds) {
  rig().signal("attitude_corrector", SIGKILL);
  expect_role_back_within_3_s(rig(), "attitude_corrector");
}

class TwoMachinesForLong : public TwoMachines {};

TEST_F(TwoMachinesForLong, ACloudOf11MegabytesComesWholeOverABadLink) {
  networks().set_link(kBadLink);
  networks().enter(Machine::kRobot);
  Viewer viewer;
  rig().ask(7);
  const auto sweep = rig().await(msg::PHASE_ASSEMBLED, 60.0);
  ASSERT_TRUE(sweep);
  EXPECT_TRUE(sweep->complete()) << sweep->reason();
  EXPECT_TRUE(viewer.await_cloud_of(640));
  expect_no_line_lost();
}

// Longer than lines are kept: what is lost is counted, and nothing else is.
TEST_F(TwoMachinesForLong, AMinuteWithoutALinkLosesLinesThatAreCounted) {
  networks().set_cable(false);
  let_the_reader_write(60);
  networks().set_cable(true);
  const std::uint64_t written = lines_written();
  EXPECT_TRUE(wait_until([&] {
    return rig().counter("cloud_assembler", "lines_received") + samples_lost() >= written;
  }));
  EXPECT_GT(lines_lost(), 40 * kLinesIn1_s);
  EXPECT_LT(lines_lost(), 52 * kLinesIn1_s);
  expect_a_right_sweep(rig());
}

class NoMulticast : public TwoComputersSuite {
 public:
  static void SetUpTestSuite() { meet_by(Discovery::kServer); }
};

TEST_F(NoMulticast, ADiscoveryServerBringsBothTogether) {
  networks().set_link(kBadLink);
  expect_a_right_sweep(rig());
  expect_no_line_lost();
}

TEST_F(NoMulticast, AParticipantThatWasKilledIsBackWithin3Seconds) {
  rig().signal("attitude_corrector", SIGKILL);
  expect_role_back_within_3_s(rig(), "attitude_corrector");
}

class NoMulticastButKeys : public TwoComputersSuite {
 public:
  static void SetUpTestSuite() { meet_by(Discovery::kPeersWithKeys); }
};

TEST_F(NoMulticastButKeys, PeersThatAreNamedMeetAndAreEncrypted) {
  networks().set_link(kBadLink);
  expect_a_right_sweep(rig());
  expect_no_line_lost();
}

}  // namespace
}  // namespace swivel::test
