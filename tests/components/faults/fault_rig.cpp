#include "tests/components/faults/fault_rig.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "components/common/roll.hpp"
#include "components/swivel/live/truth_file.hpp"
#include "hardware/io/clock.hpp"
#include "tests/components/dds/test_participant.hpp"

namespace swivel::test {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr const char* kIdle = "waiting for a request";

// The paper's bound for mode 1 is 1.25 deg; the alpha that is drawn is true here.
constexpr double kAttitudeBoundDeg = 0.6;

// Yuan's rig, but faster: it returns at the speed of mode 1.
std::string fast_rig() {
  std::string text = content_of(SWIVEL_CONFIG "/rigs/yuan.yaml");
  const std::string slow = "return_speed_deg_s: 90";
  text.replace(text.find(slow), slow.size(), "return_speed_deg_s: 180");
  return text;
}

int connect_control(const std::string& path) {
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  EXPECT_EQ(::connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  return descriptor;
}

// The first that is wanted; waits for it.
template <class Message, class Wanted>
std::optional<Message> wait_for(std::mutex& mutex, const std::vector<Message>& said,
                                const Wanted& wanted, double limit_s) {
  const auto limit = std::chrono::milliseconds(std::llround(limit_s * 1e3));
  const auto deadline = std::chrono::steady_clock::now() + limit;
  for (;;) {
    {
      const std::lock_guard lock(mutex);
      const auto found = std::find_if(said.begin(), said.end(), wanted);
      if (found != said.end()) return *found;
    }
    if (std::chrono::steady_clock::now() > deadline) return std::nullopt;
    usleep(2000);
  }
}

}  // namespace

FaultRig::FaultRig(const std::vector<std::string>& participants, FaultRigOptions options)
    : place_(std::move(options.place)),
      rig_file_(scratch_.file("rig.yaml")),
      domain_(std::to_string(domain_of_this_test())),
      names_(participants),
      preload_(std::move(options.preload)) {
  std::ofstream(rig_file_) << fast_rig();
  start_bench(options.bench);
  join_domain();
  for (const std::string& name : names_) start(name);
}

void FaultRig::start_bench(const std::vector<std::string>& more) {
  place_.go_to("swivel-bench");
  std::vector<std::string> arguments{"--truth",        scratch_.file("truth.csv"),
                                     "--control",      scratch_.file("control"),
                                     "--stepper-link", scratch_.file("stepper"),
                                     "--alpha-deg",    "30",
                                     "--home-time-s",  "0.4",
                                     "--log-level",    "warning"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  bench_ = std::make_unique<ChildProcess>("swivel-bench", arguments, true);
  std::istringstream words(bench_->read_line(std::chrono::seconds(10)).value_or(""));
  words >> addresses_["-"] >> addresses_["--lidar"] >> addresses_["-"] >> addresses_["--stepper"];
  control_ = connect_control(scratch_.file("control"));
}

FaultRig::~FaultRig() {
  for (auto& [name, child] : children_) child->ask_to_stop();
  children_.clear();
  if (control_ >= 0) ::close(control_);
}

void FaultRig::join_domain() {
  place_.go_to("fault_test");
  ParticipantOptions options = loopback_participant("fault_test", std::stoi(domain_));
  options.rig = "swivel";
  options.network = place_.network;
  options.discovery_server = place_.discovery_server;
  options.peers = place_.peers;
  options.security_folder = place_.security_folder;
  participant_ = std::make_unique<Participant>(options);
  requests_ = std::make_unique<Writer<msg::SweepRequest>>(*participant_, kSweepRequestTopic);
  requester_ = std::make_unique<SweepRequester>(
      [this](const msg::SweepRequest& request) { requests_->write(msg::SweepRequest(request)); });
  participant_->subscribe<msg::Sweep>(kSweepTopic, [this](const msg::Sweep& sweep) {
    const std::lock_guard lock(mutex_);
    requester_->saw(sweep);
    sweeps_.push_back(sweep);
  });
  participant_->subscribe<msg::Attitude>(kAttitudeTopic, [this](const msg::Attitude& attitude) {
    const std::lock_guard lock(mutex_);
    attitudes_.push_back(attitude);
  });
  participant_->subscribe<msg::Health>(kHealthTopic, [this](const msg::Health& health) {
    const std::lock_guard lock(mutex_);
    healths_.push_back(health);
  });
  participant_->on_tick(std::chrono::milliseconds(300), [this] {
    const std::lock_guard lock(mutex_);
    requester_->check(std::chrono::steady_clock::now());
  });
  participant_->start();
}

void FaultRig::leave() {
  participant_->stop();
  requests_.reset();
  participant_.reset();
}

std::string FaultRig::bench(const std::string& command) {
  const std::string line = command + "\n";
  EXPECT_EQ(::send(control_, line.data(), line.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(line.size()));
  std::string answer;
  char c = 0;
  while (::recv(control_, &c, 1, 0) == 1 && c != '\n') answer += c;
  EXPECT_EQ(answer.substr(0, 2), "ok") << command << ": " << answer;
  return answer.size() > 3 ? answer.substr(3) : std::string();
}

Shaft FaultRig::shaft() {
  std::istringstream words(bench("truth shaft"));
  Shaft shaft;
  words >> shaft.time_ns >> shaft.angle_deg >> shaft.lowest_deg >> shaft.highest_deg;
  return shaft;
}

void FaultRig::start(const std::string& participant) {
  place_.go_to(participant);
  std::vector<std::string> arguments{"--rig",       rig_file_,      "--domain",   domain_,
                                     "--network",   place_.network, "--profiles", kProfiles,
                                     "--log-level", "error"};
  const auto add = [&](const std::string& option, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {option, value});
  };
  add("--discovery-server", place_.discovery_server);
  for (const std::string& peer : place_.peers) add("--peer", peer);
  add("--security", place_.security_folder);
  if (participant == "hokuyo_reader") add("--lidar", addresses_["--lidar"]);
  if (participant == "stepper_sequencer") add("--stepper", addresses_["--stepper"]);
  if (participant == "view_gateway") add("--port", "0");
  if (participant == "alpha_calibrator") add("--calibration", scratch_.file("calibration.yaml"));
  if (!preload_.empty()) setenv("LD_PRELOAD", preload_.c_str(), 1);
  children_[participant] = std::make_unique<ChildProcess>(participant, arguments);
  unsetenv("LD_PRELOAD");
}

void FaultRig::signal(const std::string& participant, int number) {
  ChildProcess& child = *children_.at(participant);
  ::kill(child.id(), number);
  if (number != SIGKILL) return;
  EXPECT_TRUE(child.wait_or_kill(std::chrono::seconds(2)));
}

bool FaultRig::ready() {
  return std::all_of(names_.begin(), names_.end(), [&](const std::string& name) {
    return wait_until([&] {
      const auto last = health(name);
      const bool idle = name != "stepper_sequencer" || (last && last->doing() == kIdle);
      return last && idle && last->state() == msg::HEALTH_OK &&
             last->process_id() == static_cast<std::uint32_t>(children_.at(name)->id());
    });
  });
}

void FaultRig::ask(int mode, int count) {
  const std::lock_guard lock(mutex_);
  requester_->request(new_request_id(), mode, count);
}

void FaultRig::mark() {
  const std::lock_guard lock(mutex_);
  requester_->forget();
  sweeps_.clear();
  attitudes_.clear();
  marked_ns_ = now_ns();
}

std::optional<msg::Sweep> FaultRig::await(const Sweeps& wanted, double limit_s) {
  return wait_for(mutex_, sweeps_, wanted, limit_s);
}

std::optional<msg::Sweep> FaultRig::await(msg::SweepPhase phase, double limit_s) {
  return await([phase](const msg::Sweep& sweep) { return sweep.phase() == phase; }, limit_s);
}

std::optional<msg::Attitude> FaultRig::await_attitude(std::uint64_t sweep_id, double limit_s) {
  return wait_for(
      mutex_, attitudes_,
      [=](const msg::Attitude& attitude) { return attitude.sweep_id() == sweep_id; }, limit_s);
}

std::optional<msg::Health> FaultRig::await_health(const std::string& participant,
                                                  const Healths& wanted, double limit_s) {
  return wait_for(
      mutex_, healths_,
      [&](const msg::Health& health) {
        return health.participant().to_string() == participant && health.time_ns() >= marked_ns_ &&
               wanted(health);
      },
      limit_s);
}

std::optional<msg::Health> FaultRig::await_error(const std::string& participant,
                                                 const std::string& words, double limit_s) {
  return await_health(
      participant,
      [&](const msg::Health& health) {
        return health.last_error_time_ns() >= marked_ns_ &&
               health.last_error().find(words) != std::string::npos;
      },
      limit_s);
}

std::optional<msg::Health> FaultRig::health(const std::string& participant) {
  const std::lock_guard lock(mutex_);
  const auto last = std::find_if(
      healths_.rbegin(), healths_.rend(),
      [&](const msg::Health& health) { return health.participant().to_string() == participant; });
  return last == healths_.rend() ? std::nullopt : std::optional(*last);
}

std::uint64_t FaultRig::counter(const std::string& participant, const std::string& name) {
  const auto last = health(participant);
  return last ? counter_of(*last, name).value_or(0) : 0;
}

std::optional<double> FaultRig::true_phi_deg(const msg::Attitude& attitude) const {
  return TruthFile(scratch_.file("truth.csv")).phi_deg(attitude.first_device_stamp_ms());
}

void expect_true(FaultRig& rig, const msg::Attitude& attitude) {
  const auto phi_deg = rig.true_phi_deg(attitude);
  ASSERT_TRUE(phi_deg);
  EXPECT_LT(std::abs(std::remainder(attitude.phi_offset_deg() - *phi_deg, 360.0)),
            kAttitudeBoundDeg);
}

void expect_a_right_sweep(FaultRig& rig) {
  ASSERT_TRUE(rig.ready());
  rig.mark();
  rig.ask();
  const auto assembled = rig.await(msg::PHASE_ASSEMBLED);
  ASSERT_TRUE(assembled);
  EXPECT_TRUE(assembled->complete()) << assembled->reason();
  EXPECT_EQ(assembled->lines_used(), 40U);
  const auto attitude = rig.await_attitude(assembled->sweep_id());
  ASSERT_TRUE(attitude);
  EXPECT_EQ(attitude->verdict(), msg::VERDICT_GOOD) << attitude->reason();
  EXPECT_EQ(attitude->lines_missing(), 0U);
  expect_true(rig, *attitude);
  EXPECT_TRUE(rig.await(msg::PHASE_IDLE));
}

void expect_balanced_books(FaultRig& rig) {
  rig.mark();
  rig.bench("lidar power-cycle 4");
  const auto balanced = rig.await_health(
      "cloud_assembler",
      [&](const msg::Health& health) {
        const auto value = [&](const char* name) { return counter_of(health, name).value_or(0); };
        return health.time_ns() > rig.marked_ns() + 2'000'000'000 &&
               value("lines_received") == value("lines_used") + value("lines_outside") +
                                              value("lines_rejected") + value("lines_late") +
                                              value("lines_waiting");
      },
      4.0);
  ASSERT_TRUE(balanced);
  EXPECT_GT(counter_of(*balanced, "lines_received"), 100U);
  const auto read = [&](const char* name) { return rig.counter("hokuyo_reader", name); };
  EXPECT_EQ(counter_of(*balanced, "lines_received"), read("lines_written"));
  EXPECT_EQ(counter_of(*balanced, "samples_lost"), 0U);
  EXPECT_EQ(read("lines_not_written"), 0U);
  EXPECT_EQ(read("scans"), read("lines_written"));
}

void expect_role_back_within_3_s(FaultRig& rig, const std::string& participant) {
  const std::int64_t started_ns = now_ns();
  rig.start(participant);
  const auto back = rig.await_health(participant, [&](const msg::Health& health) {
    return health.started_time_ns() >= started_ns && health.state() == msg::HEALTH_OK;
  });
  ASSERT_TRUE(back);
  EXPECT_LT(back->time_ns() - started_ns, 3'000'000'000);
}

bool FaultRig::go_into_a_sweep(double part) {
  ask();
  const auto cruising = await(msg::PHASE_CRUISING);
  if (!cruising) return false;
  const auto length_ns =
      static_cast<double>(cruising->window_end_ns() - cruising->window_start_ns());
  const std::int64_t there_ns = cruising->window_start_ns() + std::llround(part * length_ns);
  while (now_ns() < there_ns) usleep(1000);
  mark();
  return true;
}

std::int64_t time_of_standstill_ns(FaultRig& rig) {
  constexpr std::int64_t kLongEnough_ns = 200'000'000;
  Shaft moved = rig.shaft();
  const std::int64_t began_ns = moved.time_ns;
  Shaft now = moved;
  while (now.time_ns - moved.time_ns < kLongEnough_ns &&
         now.time_ns - began_ns < 20 * std::llround(kNsPerSecond)) {
    usleep(2000);
    now = rig.shaft();
    if (std::abs(now.angle_deg - moved.angle_deg) > 1e-6) moved = now;
  }
  return moved.time_ns;
}

}  // namespace swivel::test
