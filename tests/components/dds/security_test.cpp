// Intruders: each joins before those who belong together, is there while they talk, and gets and
// gives nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <fastdds/dds/log/Log.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include "components/dds/security.hpp"
#include "components/keys/key_folder.hpp"
#include "tests/components/dds/test_participant.hpp"
#include "tests/components/swivel/scratch_folder.hpp"

namespace swivel {
namespace {

using ::testing::SizeIs;

constexpr std::int64_t kDay_s = 86400;
constexpr const char* kStranger = "a stranger was refused";

KeyFolderOptions keys_of_the_test() {
  const std::int64_t now_s = std::time(nullptr);
  return {"test_rig",
          content_of(SWIVEL_CONFIG "/security/governance.xml"),
          {{std::string(kVictim), {"scan_line"}, {}},
           {"viewer", {}, {"scan_line"}},
           {"late_viewer", {}, {"scan_line"}},
           {std::string(kIntruder), {"health"}, {"health"}}},
          {now_s - kDay_s, now_s + kDay_s},
          {}};
}

KeyFolderOptions generous(KeyFolderOptions options) {
  options.grants.back() = {std::string(kIntruder), {"scan_line"}, {"scan_line"}};
  return options;
}

void use_permissions(const SecurityFiles& from, const std::string& intruders_folder) {
  std::filesystem::copy_file(from.permissions,
                             security_files(intruders_folder, std::string(kIntruder)).permissions,
                             std::filesystem::copy_options::overwrite_existing);
}

// Another's program, in a process of its own.
class Intruder {
 public:
  Intruder(int domain, const std::string& keys) {
    std::array<int, 2> input{};
    std::array<int, 2> output{};
    if (pipe(input.data()) != 0 || pipe(output.data()) != 0) throw std::runtime_error("no pipe");
    child_ = fork();
    if (child_ == 0) {
      dup2(input[0], STDIN_FILENO);
      for (const int end : {input[0], input[1], output[0]}) close(end);
      execl(INTRUDER, "intruder", std::to_string(domain).c_str(), kProfiles.c_str(),
            std::to_string(output[1]).c_str(), keys.empty() ? nullptr : keys.c_str(), nullptr);
      _exit(127);
    }
    close(input[0]);
    close(output[1]);
    input_ = input[1];
    output_ = fdopen(output[0], "r");
  }
  ~Intruder() {
    ask_to_end();
    fclose(output_);
    waitpid(child_, nullptr, 0);
  }

  std::string says() {
    std::array<char, 80> line{};
    return fgets(line.data(), line.size(), output_) == nullptr ? "nothing" : line.data();
  }
  void ask_to_end() {
    if (input_ >= 0) close(std::exchange(input_, -1));
  }

 private:
  pid_t child_ = 0;
  int input_ = -1;
  FILE* output_ = nullptr;
};

// What Fast DDS says of it: of some refusals it tells nobody else.
class FastDdsLog : public eprosima::fastdds::dds::LogConsumer {
 public:
  explicit FastDdsLog(Seen<std::string>& said) : said_(said) {}
  void Consume(const eprosima::fastdds::dds::Log::Entry& entry) override {
    said_.add(entry.message);
  }

 private:
  Seen<std::string>& said_;
};

// Those who belong together: a lidar that writes, viewers that read.
class Security : public ::testing::Test {
 protected:
  Security() : domain_(domain_of_this_test()), keys_(scratch_.file("keys")) {
    eprosima::fastdds::dds::Log::RegisterConsumer(std::make_unique<FastDdsLog>(refusals_));
  }
  ~Security() override { eprosima::fastdds::dds::Log::Reset(); }

  std::unique_ptr<Participant> member(const std::string& name) {
    ParticipantOptions options = loopback_participant(name, domain_);
    options.security_folder = keys_;
    auto participant = std::make_unique<Participant>(options);
    participant->on_problem([this](const std::string& problem) { refusals_.add(problem); });
    return participant;
  }
  std::unique_ptr<Participant> viewer(const std::string& name, Seen<std::uint32_t>& stamps) {
    auto participant = member(name);
    participant->subscribe<msg::ScanLine>(
        kScanLineTopic, [&stamps](const auto& line) { stamps.add(line.device_stamp_ms()); });
    participant->start();
    return participant;
  }
  std::ptrdiff_t refusals(const std::string& words) const {
    const auto said = refusals_.values();
    return std::count_if(said.begin(), said.end(), [&](const std::string& problem) {
      return problem.find(words) != std::string::npos;
    });
  }

  // The intruder is there first, and meets the lidar and both viewers.
  void talk(Intruder& intruder, const std::function<bool()>& met) {
    ASSERT_EQ(intruder.says(), "ready\n");
    const auto lidar = member(std::string(kVictim));
    Writer<msg::ScanLine> lines(*lidar, kScanLineTopic);
    lidar->start();
    const auto early = viewer("viewer", early_);
    const auto late = viewer("late_viewer", late_);
    for (const std::uint32_t stamp_ms : {1, 2}) {
      msg::ScanLine line;
      line.device_stamp_ms(stamp_ms);
      ASSERT_TRUE(lines.write(line));
    }
    EXPECT_TRUE(wait_until(met));
    for (const auto* viewer : {&early_, &late_}) {
      EXPECT_TRUE(wait_until([&] {
        const auto stamps = viewer->values();
        return std::count(stamps.begin(), stamps.end(), 1) == 1 &&
               std::count(stamps.begin(), stamps.end(), 2) == 1;
      }));
    }
    intruder.ask_to_end();
  }

  // It is refused by each of the three, in these words.
  void expect_nothing_in_or_out(const std::string& intruders_keys, const std::string& words) {
    Intruder intruder(domain_, intruders_keys);
    talk(intruder, [&] { return refusals(words) >= 3; });
    EXPECT_EQ(intruder.says(), "over\n");
    for (const auto* viewer : {&early_, &late_}) EXPECT_THAT(viewer->values(), SizeIs(2));
  }

  Seen<std::string> refusals_;
  Seen<std::uint32_t> early_;
  Seen<std::uint32_t> late_;
  ScratchFolder scratch_;
  int domain_;
  std::string keys_;
};

// What the tests below rest upon: nothing but its keys keeps the intruder out.
TEST_F(Security, WithThePermissionTheIntruderReadsAndWrites) {
  make_key_folder(keys_, generous(keys_of_the_test()));
  Intruder intruder(domain_, keys_);
  talk(intruder, [&] {
    return early_.values().size() == 3 && late_.values().size() == 3 &&
           intruder.says() == "read\n" && intruder.says() == "read\n";
  });
}

TEST_F(Security, WithoutACertificateNothingIsReadOrWritten) {
  make_key_folder(keys_, keys_of_the_test());
  expect_nothing_in_or_out("", kStranger);
}

TEST_F(Security, WithACertificateOfAnotherAuthorityNothingIsReadOrWritten) {
  make_key_folder(keys_, keys_of_the_test());
  make_key_folder(scratch_.file("foreign"), generous(keys_of_the_test()));
  expect_nothing_in_or_out(scratch_.file("foreign"), kStranger);
}

// Of our own authority, and with the permission, but of last week.
TEST_F(Security, WithAnExpiredCertificateNothingIsReadOrWritten) {
  make_key_folder(keys_, keys_of_the_test());
  KeyFolderOptions valid = generous(keys_of_the_test());
  valid.authority = load_authority(keys_);
  KeyFolderOptions expired = valid;
  expired.validity = {std::time(nullptr) - 7 * kDay_s, std::time(nullptr) - kDay_s};
  const std::string folder = scratch_.file("expired");
  make_key_folder(folder, expired);
  make_key_folder(scratch_.file("valid"), valid);
  use_permissions(security_files(scratch_.file("valid"), std::string(kIntruder)), folder);
  expect_nothing_in_or_out(folder, kStranger);
}

TEST_F(Security, WithoutThePermissionForATopicItIsNeitherReadNorWritten) {
  make_key_folder(keys_, keys_of_the_test());
  expect_nothing_in_or_out(keys_, "topic not found in allow rule");
}

TEST_F(Security, WithPermissionsThatWereChangedNothingIsReadOrWritten) {
  make_key_folder(keys_, keys_of_the_test());
  const std::string tampered = scratch_.file("tampered");
  std::filesystem::copy(keys_, tampered, std::filesystem::copy_options::recursive);
  const std::string path = security_files(tampered, std::string(kIntruder)).permissions;
  std::string text = content_of(path);
  for (std::size_t at = 0; (at = text.find("/health<")) != std::string::npos;)
    text.replace(at, 8, "/scan_line<");
  std::ofstream(path) << text;
  expect_nothing_in_or_out(tampered, "Error validating remote permissions");
}

// Signed by our authority, but for another.
TEST_F(Security, WithThePermissionsOfAnotherNothingIsReadOrWritten) {
  make_key_folder(keys_, keys_of_the_test());
  use_permissions(security_files(keys_, std::string(kVictim)), keys_);
  expect_nothing_in_or_out(keys_, "Error validating remote permissions");
}

}  // namespace
}  // namespace swivel
