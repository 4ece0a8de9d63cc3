// The Foxglove protocol as Foxglove's own client speaks it.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "components/dds/any_topic.hpp"
#include "components/gateway/channels.hpp"
#include "components/gateway/server.hpp"
#include "tests/components/dds/test_participant.hpp"

namespace swivel {
namespace {

constexpr std::int64_t kTime_ns = 1'700'000'000'123'456'789;

// npm's client, on a process of its own.
class ForeignClient {
 public:
  ForeignClient(std::uint16_t port, const std::string& topics)
      : output_(popen(("cd " FOREIGN_READERS " && node read_live.mjs ws://127.0.0.1:" +
                       std::to_string(port) + " " + topics)
                          .c_str(),
                      "r")) {}
  ~ForeignClient() { pclose(output_); }
  ForeignClient(const ForeignClient&) = delete;
  ForeignClient& operator=(const ForeignClient&) = delete;

  nlohmann::json heard() {
    std::string text;
    std::array<char, 4096> part{};
    while (std::fgets(part.data(), part.size(), output_) != nullptr) text += part.data();
    return nlohmann::json::parse(text, nullptr, false);
  }

 private:
  std::FILE* output_;
};

TEST(Foxglove, ItsOwnClientDecodesWhatIsPublished) {
  Server server({"127.0.0.1", 0, {}}, {"", "test", foxglove_channels("rig7"), {}, {}, {}, {}});
  ForeignClient client(server.port(), "rig7/sweep rig7/scan_line rt/rig7/cloud");
  ASSERT_TRUE(wait_until([&] {
    return server.wanted(kSweepChannel) && server.wanted(kScanLineChannel) &&
           server.wanted(kCloudChannel);
  }));
  msg::Sweep sweep;
  sweep.rig("rig7");
  sweep.sweep_id(77);
  sweep.speed_deg_s(11.25);
  sweep.reason("because");
  server.publish(kSweepChannel, kTime_ns, encode_cdr(sweep));
  msg::ScanLine line;
  line.ranges_mm({1, 65533, 3});
  line.scan_period_ns(25.04e6);
  server.publish(kScanLineChannel, kTime_ns, encode_cdr(line));
  server.publish(kCloudChannel, kTime_ns, encode_cdr(numbered_cloud(5)));

  const nlohmann::json heard = client.heard();
  ASSERT_TRUE(heard.is_object());
  const auto& of_sweep = heard["rig7/sweep"]["message"];
  EXPECT_EQ(of_sweep["sweep_id"], 77);
  EXPECT_EQ(of_sweep["speed_deg_s"], 11.25);
  EXPECT_EQ(of_sweep["reason"], "because");
  EXPECT_EQ(heard["rig7/sweep"]["timestamp"], static_cast<double>(kTime_ns));
  const auto& of_line = heard["rig7/scan_line"]["message"];
  EXPECT_EQ(of_line["ranges_mm"], (nlohmann::json{1, 65533, 3}));
  EXPECT_EQ(of_line["scan_period_ns"], 25.04e6);
  const auto& of_cloud = heard["rt/rig7/cloud"]["message"];
  EXPECT_EQ(of_cloud["width"], 1081);
  EXPECT_EQ(of_cloud["header"]["stamp"]["sec"], 5);
  const auto data = numbered_cloud(5).data();
  EXPECT_EQ(of_cloud["data"], nlohmann::json(std::vector<int>(data.begin(), data.begin() + 16)));
}

}  // namespace
}  // namespace swivel
