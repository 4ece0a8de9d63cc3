#include "components/gateway/page_messages.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "components/common/sweep_requester.hpp"

namespace swivel {
namespace {

RigFile yuan() {
  RigFile rig;
  rig.rig = "swivel";
  rig.plate = PlateGeometry();
  rig.modes.lines = {{1, 40}, {7, 640}};
  return rig;
}

TEST(PageMessages, ScanAndCancelAreAllThatAPageMayAskFor) {
  EXPECT_EQ(page_command_in(R"({"do":"scan","mode":7})", yuan())->mode, 7);
  EXPECT_TRUE(page_command_in(R"({"do":"cancel"})", yuan())->cancel);
  for (const char* text : {"", "{}", "[]", "null", "\"scan\"", R"({"do":"scan"})", R"({"do":7})",
                           R"({"do":"scan","mode":2})", R"({"do":"scan","mode":"7"})",
                           R"({"do":"scan","mode":-1})", R"({"do":"scan","mode":1.0})",
                           R"({"do":"scan","mode":4294967303})", R"({"do":"fly"})", "\xff"})
    EXPECT_FALSE(page_command_in(text, yuan())) << text;
}

TEST(PageMessages, TheStateIsJsonWhateverParticipantsSay) {
  const LiveView view(yuan(), [](const Frame&) {});
  RollEntry entry;
  entry.last.doing("no utf-8: \xff\xc3(\n\"</script>");
  entry.last.started_time_ns(std::numeric_limits<std::int64_t>::min());
  const auto state =
      nlohmann::json::parse(state_message(yuan(), view, {{"a \xff", entry}}, "answer"));
  EXPECT_EQ(state["trust"]["level"], "nothing");
  EXPECT_EQ(state["modes"][1]["seconds"], 16.0);
  EXPECT_EQ(state["participants"].size(), 1U);
  EXPECT_FALSE(state["motor"]["known"]);
}

// The gateway lives long: nobody expects a click of an hour ago to turn the motor.
TEST(SweepRequests, AreNotRepeatedOnceForgotten) {
  int sent = 0;
  SweepRequester requester([&](const msg::SweepRequest&) { ++sent; });
  requester.request(5, 1, 1);
  const std::chrono::steady_clock::time_point start(std::chrono::hours(1));
  EXPECT_TRUE(requester.check(start));
  EXPECT_FALSE(requester.check(start + std::chrono::seconds(11)));
  EXPECT_EQ(sent, 3);
  requester.forget();
  EXPECT_TRUE(requester.check(start + std::chrono::hours(1)));
  EXPECT_EQ(sent, 3);
}

}  // namespace
}  // namespace swivel
