// The subscribers of examples/, built outside of the tree from what the packages install: they get
// every scan line and every cloud of 11 MB as it was sent, from the first on though they come late.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <sstream>

#include "tests/components/dds/test_participant.hpp"

namespace swivel {
namespace {

using ::testing::ElementsAreArray;

constexpr int kLines = 400;
constexpr int kClouds = 3;

// FNV-1a, as published: http://www.isthe.com/chongo/tech/comp/fnv
class Checksum {
 public:
  void add(std::uint8_t byte) {
    sum_ ^= byte;
    sum_ *= 0x01000193U;
  }
  void add(const std::vector<std::uint16_t>& numbers) {
    for (const std::uint16_t number : numbers) {
      add(static_cast<std::uint8_t>(number & 0xFFU));
      add(static_cast<std::uint8_t>(number >> 8U));
    }
  }
  std::string in_words() const {
    std::array<char, 9> words{};
    std::snprintf(words.data(), words.size(), "%08x", sum_);
    return words.data();
  }

 private:
  std::uint32_t sum_ = 0x811c9dc5U;
};

msg::ScanLine numbered_line(int number) {
  msg::ScanLine line;
  line.beam0_time_ns(1700000000000000000 + number * 25040001);
  for (int beam = 0; beam < 1081; ++beam) {
    line.ranges_mm().push_back(static_cast<std::uint16_t>(number * 7919 + beam * 31));
    line.intensities().push_back(static_cast<std::uint16_t>(number * 101 + beam * beam));
  }
  return line;
}

std::string line_in_words(int number) {
  const msg::ScanLine line = numbered_line(number);
  Checksum sum;
  sum.add(line.ranges_mm());
  sum.add(line.intensities());
  return "scan_line " + std::to_string(number) + " at " + std::to_string(line.beam0_time_ns()) +
         ": 1081 ranges, 1081 intensities, " + sum.in_words();
}

PointCloud2 cloud_of_11_megabytes(int number) {
  PointCloud2 cloud = numbered_cloud(number);
  cloud.header().stamp().nanosec(5);
  cloud.header().frame_id("swivel/base");
  for (const char* name : {"x", "y", "z", "intensity"}) {
    PointField field;
    field.name(name);
    field.offset(static_cast<std::uint32_t>(4 * cloud.fields().size()));
    field.datatype(7);
    field.count(1);
    cloud.fields().push_back(field);
  }
  return cloud;
}

std::string cloud_in_words(int number) {
  Checksum sum;
  const PointCloud2 cloud = cloud_of_11_megabytes(number);
  for (const std::uint8_t byte : cloud.data()) sum.add(byte);
  return "cloud of " + std::to_string(number) +
         ".000000005 in swivel/base: 640 x 1081, 11069440 bytes, " + sum.in_words();
}

// A program and what it prints.
class Subscriber {
 public:
  explicit Subscriber(const std::string& command) : output_(popen(command.c_str(), "r")) {}
  ~Subscriber() {
    if (output_ != nullptr) pclose(output_);
  }
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  // Until it ends.
  std::vector<std::string> lines() {
    std::vector<std::string> lines;
    std::array<char, 256> text{};
    while (std::fgets(text.data(), text.size(), output_) != nullptr) {
      lines.emplace_back(text.data());
      lines.back().pop_back();
    }
    exit_status_ = pclose(std::exchange(output_, nullptr));
    return lines;
  }
  int exit_status() const { return exit_status_; }

 private:
  FILE* output_;
  int exit_status_ = -1;
};

std::vector<std::string> starting_with(const std::string& word,
                                       const std::vector<std::string>& lines) {
  std::vector<std::string> found;
  for (const std::string& line : lines)
    if (line.compare(0, word.size(), word) == 0) found.push_back(line);
  return found;
}

void expect_everything(Subscriber& subscriber) {
  const std::vector<std::string> lines = subscriber.lines();
  EXPECT_EQ(subscriber.exit_status(), 0);
  std::vector<std::string> scan_lines;
  for (int number = 1; number <= kLines; ++number) scan_lines.push_back(line_in_words(number));
  std::vector<std::string> clouds;
  for (int number = 1; number <= kClouds; ++number) clouds.push_back(cloud_in_words(number));
  EXPECT_THAT(starting_with("scan_line", lines), ElementsAreArray(scan_lines));
  EXPECT_THAT(starting_with("cloud", lines), ElementsAreArray(clouds));
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.back(), "400 scan lines, 0 missing; 3 clouds");
}

TEST(ForeignPrograms, GetEveryScanLineAndCloudAsSent) {
  const int domain = domain_of_this_test();
  ParticipantOptions options = loopback_participant("sender", domain);
  options.rig = "swivel";
  Participant participant(options);
  Writer<msg::ScanLine> scan_lines(participant, kScanLineTopic);
  Writer<PointCloud2> clouds(participant, kCloudTopic);
  participant.start();
  int number = 0;
  while (number < kLines / 2) ASSERT_TRUE(scan_lines.write(numbered_line(++number)));
  ASSERT_TRUE(clouds.write(cloud_of_11_megabytes(1)));

  const std::string arguments = std::to_string(kClouds) + " " + std::to_string(domain);
  const std::string limit = "timeout 40 ";
  Subscriber fast_dds(limit + FAST_DDS_SUBSCRIBER " " + arguments);
  Subscriber cyclone_dds("CYCLONEDDS_URI=file://" CYCLONE_DDS_SETTINGS " " + limit +
                         CYCLONE_DDS_SUBSCRIBER " " + arguments);
  ASSERT_TRUE(
      wait_until([&] { return scan_lines.reader_count() == 2 && clouds.reader_count() == 2; }));
  while (number < kLines) {
    ASSERT_TRUE(scan_lines.write(numbered_line(++number)));
    if (number % 50 == 0) {
      ASSERT_TRUE(scan_lines.wait_until_acknowledged(std::chrono::seconds(10)));
    }
  }
  for (int cloud = 2; cloud <= kClouds; ++cloud) {
    ASSERT_TRUE(clouds.write(cloud_of_11_megabytes(cloud)));
    ASSERT_TRUE(clouds.wait_until_acknowledged(std::chrono::seconds(20)));
  }
  expect_everything(fast_dds);
  expect_everything(cyclone_dds);
}

}  // namespace
}  // namespace swivel
