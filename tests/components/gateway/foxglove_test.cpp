#include "components/gateway/foxglove.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "components/dds/any_topic.hpp"
#include "components/gateway/channels.hpp"
#include "components/gateway/metrics.hpp"

namespace swivel {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Foxglove, AdvertisesEveryChannelWithASchemaThatHasItsType) {
  const auto channels = foxglove_channels("rig7");
  ASSERT_EQ(channels.size(), static_cast<std::size_t>(kChannelCount));
  const auto greeting = foxglove_greeting("swivel rig7", channels);
  ASSERT_EQ(greeting.size(), 2U);
  EXPECT_EQ(json::parse(greeting[0])["op"], "serverInfo");
  const json advertise = json::parse(greeting[1]);
  EXPECT_EQ(advertise["op"], "advertise");
  for (std::size_t id = 0; id < channels.size(); ++id) {
    const json& channel = advertise["channels"][id];
    EXPECT_EQ(channel["id"], id);
    EXPECT_EQ(channel["encoding"], "cdr");
    const std::string type = channel["schemaName"];
    const std::string name = type.substr(type.find_last_of(":/") + 1);
    EXPECT_THAT(channel["schema"].get<std::string>(),
                HasSubstr(channel["schemaEncoding"] == "omgidl" ? "struct " + name + " {"
                                                                : "std_msgs/Header header"));
  }
  EXPECT_EQ(advertise["channels"][kSweepChannel]["topic"], "rig7/sweep");
  EXPECT_EQ(advertise["channels"][kCloudChannel]["topic"], "rt/rig7/cloud");
}

TEST(Foxglove, SubscribesAndUnsubscribes) {
  FoxgloveSubscriptions subscriptions(3);
  EXPECT_EQ(subscriptions.take(
                R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":2},{"id":8,"channelId":2},
                    {"id":9,"channelId":0}]})"),
            "");
  EXPECT_THAT(subscriptions.to(2), ElementsAre(7, 8));
  EXPECT_THAT(subscriptions.to(0), ElementsAre(9));
  EXPECT_EQ(subscriptions.take(R"({"op":"unsubscribe","subscriptionIds":[7,99]})"), "");
  EXPECT_THAT(subscriptions.to(2), ElementsAre(8));
  EXPECT_THAT(subscriptions.to(1), IsEmpty());
}

TEST(Foxglove, TellsWhatItDoesNotUnderstand) {
  FoxgloveSubscriptions subscriptions(3);
  for (const char* text :
       {"", "{", "[]", "7", "null", "\xff\xfe", R"({"op":7})", R"({"op":"advertise"})",
        R"({"op":"subscribe","subscriptions":[7]})",
        R"({"op":"subscribe","subscriptions":[{"id":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":3}]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})",
        R"({"op":"unsubscribe","subscriptionIds":[{}]})"}) {
    const std::string answer = subscriptions.take(text);
    ASSERT_FALSE(answer.empty()) << text;
    EXPECT_EQ(json::parse(answer)["op"], "status") << text;
  }
  EXPECT_EQ(subscriptions.take(R"({"op":"subscribe","subscriptions":{}})"), "");
  for (std::uint32_t channel = 0; channel < 3; ++channel)
    EXPECT_THAT(subscriptions.to(channel), IsEmpty());
  EXPECT_NE(subscriptions.take(std::string(100000, '[')), "") << "deep, and no crash";
}

TEST(Foxglove, SubscriptionsAreBounded) {
  FoxgloveSubscriptions subscriptions(1);
  for (int id = 0; id < 1000; ++id) {
    const json wish{{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", 0}}}}};
    EXPECT_EQ(subscriptions.take(wish.dump()).empty(), id < 64);
  }
  EXPECT_EQ(subscriptions.to(0).size(), 64U);
}

TEST(Foxglove, AMessagesHeadIsThirteenBytes) {
  EXPECT_EQ(foxglove_message_head(0x04030201, 0x0c0b0a0908070605),
            "\x01\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0a\x0b\x0c");
}

TEST(Foxglove, AMessageIsTheBytesThatDdsSends) {
  msg::Sweep sweep;
  sweep.rig("rig7");
  sweep.sweep_id(77);
  sweep.reason("because");
  const std::string bytes = encode_cdr(sweep);
  EXPECT_EQ(bytes.substr(0, 4), std::string("\0\1\0\0", 4)) << "CDR, little endian";
  eprosima::fastrtps::rtps::SerializedPayload_t payload(static_cast<std::uint32_t>(bytes.size()));
  payload.length = payload.max_size;
  std::memcpy(payload.data, bytes.data(), bytes.size());
  msg::Sweep back;
  ASSERT_TRUE(msg::SweepPubSubType().deserialize(&payload, &back));
  EXPECT_EQ(back, sweep);
}

TEST(Metrics, AreWhatPrometheusReads) {
  RollEntry entry;
  msg::Counter counter;
  counter.name("lines received\n");
  counter.value(12);
  entry.last.counters({counter});
  entry.last.state(msg::HEALTH_DEGRADED);
  entry.last_seen = std::chrono::steady_clock::time_point(std::chrono::seconds(1));
  const std::string text = metrics_text({{"hokuyo_reader", entry}, {"a\"b\\\n", entry}},
                                        entry.last_seen + std::chrono::milliseconds(1500));
  EXPECT_THAT(text, HasSubstr("# TYPE swivel_lines_received_ untyped\n"
                              "swivel_lines_received_{participant=\"a\\\"b\\\\ \"} 12\n"
                              "swivel_lines_received_{participant=\"hokuyo_reader\"} 12\n"));
  EXPECT_THAT(text, HasSubstr("swivel_health_state{participant=\"hokuyo_reader\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("swivel_health_age_seconds{participant=\"hokuyo_reader\"} 1.500\n"));
}

}  // namespace
}  // namespace swivel
