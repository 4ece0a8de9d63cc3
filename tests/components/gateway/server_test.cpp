// The server as clients find it, good ones and hostile ones, through raw sockets.
#include "components/gateway/server.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "components/gateway/channels.hpp"
#include "tests/components/gateway/raw_client.hpp"

namespace swivel {
namespace {

using testing::HasSubstr;

constexpr const char* kPageProtocol = "swivel.view.v1";

struct TestServer {
  std::mutex mutex;
  std::vector<std::string> commands;
  std::atomic<bool> healthy{true};
  std::atomic<int> tellings{0};  // of all that is known
  Server server;

  explicit TestServer(const AccessPolicy& access = {})
      : server({"127.0.0.1", 0, access}, content()) {}
  ServerContent content() {
    return {"<html>the page</html>",
            "test",
            foxglove_channels("swivel"),
            [] { return std::string("swivel_up 1\n"); },
            [this] { return healthy.load(); },
            [this] {
              ++tellings;
              return std::vector<Frame>{text_frame("all so far")};
            },
            [this](const std::string& text) {
              const std::lock_guard lock(mutex);
              commands.push_back(text);
            }};
  }
  std::uint16_t port() const { return server.port(); }
  bool await(const std::function<bool(const ServerCounters&)>& condition) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!condition(server.counters())) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::yield();
    }
    return true;
  }
};

TEST(Server, AnswersOverHttp) {
  TestServer test;
  EXPECT_THAT(get(test.port(), "/"), HasSubstr("the page"));
  EXPECT_THAT(get(test.port(), "/?x=y"), HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(get(test.port(), "/metrics"), HasSubstr("swivel_up 1"));
  EXPECT_THAT(get(test.port(), "/healthz"), HasSubstr("\r\n\r\nok\n"));
  test.healthy = false;
  EXPECT_EQ(status_of(get(test.port(), "/healthz")), 503);
  EXPECT_EQ(status_of(get(test.port(), "/etc/passwd")), 404);
}

TEST(Server, RefusesForeignPages) {
  TestServer test;
  EXPECT_EQ(status_of(get(test.port(), "/", "Origin: http://evil.example\r\n")), 403);
  EXPECT_EQ(status_of(get(test.port(), "/", "", "evil.example")), 403);
  RawClient client(test.port());
  EXPECT_EQ(status_of(client.open_web_socket(kPageProtocol, "localhost",
                                             "Origin: http://evil.example\r\n")),
            403);
  RawClient own(test.port());
  EXPECT_EQ(
      status_of(own.open_web_socket(kPageProtocol, "localhost", "Origin: http://localhost\r\n")),
      101);
  EXPECT_EQ(test.server.counters().requests_refused, 3U);
}

TEST(Server, RefusesWhoHasNotTheToken) {
  TestServer test({"0123456789abcdef", {}});
  for (const char* target : {"/", "/metrics", "/healthz", "/?token=0123456789abcdeF"})
    EXPECT_EQ(status_of(get(test.port(), target, "", "robot")), 401) << target;
  EXPECT_EQ(status_of(get(test.port(), "/?token=0123456789abcdef", "", "robot")), 200);
  EXPECT_EQ(status_of(get(test.port(), "/metrics", "Authorization: Bearer 0123456789abcdef\r\n",
                          "robot")),
            200);
  RawClient without(test.port());
  EXPECT_EQ(status_of(without.open_web_socket(kPageProtocol, "robot")), 401);
  RawClient with(test.port());
  EXPECT_EQ(
      status_of(with.open_web_socket(kPageProtocol, "robot", "", "/live?token=0123456789abcdef")),
      101);
}

TEST(Server, APageIsToldAllAndThenWhatIsNew) {
  TestServer test;
  RawClient page(test.port());
  EXPECT_THAT(page.open_web_socket(kPageProtocol, "localhost"),
              HasSubstr("Sec-WebSocket-Protocol: swivel.view.v1"));
  EXPECT_EQ(page.read_message()->payload, "all so far");
  const std::string cloud(5'500'000, 'c');
  test.server.publish(binary_frame(cloud));
  const auto message = page.read_message();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->opcode, 2);
  EXPECT_EQ(message->payload, cloud);
  page.send_frame(1, "scan");
  ASSERT_TRUE(test.await([&](const auto&) {
    const std::lock_guard lock(test.mutex);
    return !test.commands.empty();
  }));
  EXPECT_EQ(test.commands[0], "scan");
}

TEST(Server, SpeaksFoxglove) {
  for (const char* protocol : {"foxglove.websocket.v1", "foxglove.sdk.v1", "x, foxglove.sdk.v1"}) {
    TestServer test;
    auto open = std::make_unique<RawClient>(test.port());
    RawClient& client = *open;
    ASSERT_EQ(status_of(client.open_web_socket(protocol, "localhost")), 101);
    EXPECT_EQ(nlohmann::json::parse(client.read_message()->payload)["op"], "serverInfo");
    EXPECT_EQ(nlohmann::json::parse(client.read_message()->payload)["op"], "advertise");
    EXPECT_FALSE(test.server.wanted(kSweepChannel));
    client.send_frame(1, R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":2}]})");
    ASSERT_TRUE(test.await([&](const auto&) { return test.server.wanted(kSweepChannel); }));
    test.server.publish(binary_frame("for pages alone"));
    test.server.publish(kHealthChannel, 1, "not subscribed to");
    test.server.publish(kSweepChannel, 0x0102030405060708, "the sweep");
    const auto message = client.read_message();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->opcode, 2);
    EXPECT_EQ(message->payload,
              std::string("\x01\x05\0\0\0\x08\x07\x06\x05\x04\x03\x02\x01", 13) + "the sweep");
    open.reset();
    ASSERT_TRUE(test.await([](const auto& counters) { return counters.clients == 0; }));
    EXPECT_FALSE(test.server.wanted(kSweepChannel));
  }
}

TEST(Server, AnUnknownSubProtocolIsRefused) {
  TestServer test;
  RawClient client(test.port());
  EXPECT_EQ(status_of(client.open_web_socket("mqtt", "localhost")), 400);
}

TEST(Server, BrokenRequestsAreCountedAndOthersServed) {
  TestServer test;
  std::vector<std::string> broken{
      "\r\n\r\n\r\n",
      "GET\r\n\r\n",
      "GET / HTTP/9.9\r\n\r\n",
      "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n\r\nabc",
      "DELETE / HTTP/1.1\r\nHost: localhost\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: " + std::string(100'000, 'x') + "\r\n\r\n",
      std::string(100'000, 'x'),
      std::string(1000, '\0'),
      "\x16\x03\x01\x02\r\n\r\n"};
  for (const std::string& request : broken) {
    RawClient client(test.port());
    client.send(request);
    EXPECT_TRUE(client.closed()) << request.substr(0, 40);
  }
  EXPECT_TRUE(test.await([&](const auto& counters) {
    return counters.requests_broken == broken.size();
  })) << test.server.counters().requests_broken;
  EXPECT_EQ(status_of(get(test.port(), "/")), 200);
}

TEST(Server, NoiseOnTheWireDoesNotBreakIt) {
  TestServer test;
  std::mt19937 random(4);
  for (int round = 0; round < 60; ++round) {
    RawClient client(test.port());
    if (round % 2 == 0)
      client.open_web_socket(round % 4 == 0 ? kPageProtocol : "foxglove.sdk.v1", "localhost");
    std::string noise(random() % 3000, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    client.send(noise);
  }
  EXPECT_EQ(status_of(get(test.port(), "/")), 200);
}

TEST(Server, AHugeMessageEndsItsClientAlone) {
  TestServer test;
  RawClient good(test.port());
  good.open_web_socket(kPageProtocol, "localhost");
  RawClient bad(test.port());
  bad.open_web_socket(kPageProtocol, "localhost");
  bad.send_frame(1, std::string(1 << 20, 'x'));
  EXPECT_TRUE(bad.closed());
  EXPECT_TRUE(test.await([](const auto& counters) { return counters.clients == 1; }));
  EXPECT_EQ(test.server.counters().messages_refused, 1U);
  EXPECT_EQ(good.read_message()->payload, "all so far");
}

TEST(Server, HalfRequestsHoldNoMoreThanTheirPlaces) {
  TestServer test;
  std::vector<std::unique_ptr<RawClient>> crowd;
  for (int client = 0; client < 100; ++client) {
    crowd.push_back(std::make_unique<RawClient>(test.port()));
    crowd.back()->send("GET / HTTP/1.1\r\n");
  }
  EXPECT_TRUE(test.await([](const auto& counters) { return counters.connections_refused == 36; }));
  crowd.clear();
  EXPECT_TRUE(test.await([](const auto& counters) { return counters.requests_broken == 64; }));
  EXPECT_EQ(status_of(get(test.port(), "/")), 200);
}

TEST(Server, ClientsAreBounded) {
  TestServer test;
  std::vector<std::unique_ptr<RawClient>> crowd;
  int welcome = 0;
  for (int client = 0; client < 20; ++client) {
    crowd.push_back(std::make_unique<RawClient>(test.port()));
    welcome += status_of(crowd.back()->open_web_socket(kPageProtocol, "localhost")) == 101 ? 1 : 0;
    crowd.back()->read_message();  // it is in
  }
  EXPECT_EQ(welcome, 16);
  EXPECT_EQ(test.server.counters().connections_refused, 4U);
}

TEST(Server, ASlowClientLosesFramesWithACountAndIsToldAllAnew) {
  TestServer test;
  RawClient slow(test.port());
  slow.open_web_socket(kPageProtocol, "localhost");
  EXPECT_EQ(slow.read_message()->payload, "all so far");
  const std::string cloud(5'000'000, 'c');
  for (int frame = 0; frame < 12; ++frame) test.server.publish(binary_frame(cloud));
  test.server.publish(text_frame("the last"));
  ASSERT_TRUE(test.await([](const auto& counters) { return counters.frames_dropped > 0; }));
  std::size_t got = 0;
  auto message = slow.read_message();
  for (; message && message->payload != "the last"; message = slow.read_message()) ++got;
  ASSERT_TRUE(message);
  EXPECT_EQ(got + test.server.counters().frames_dropped, 12U);
  EXPECT_EQ(slow.read_message()->payload, "all so far");
  EXPECT_EQ(test.tellings, 2);
}

TEST(Server, APortInUseIsSaidInOneLine) {
  TestServer test;
  try {
    Server second({"127.0.0.1", test.port(), {}}, test.content());
    FAIL() << "two servers on one port";
  } catch (const ServerError& error) {
    const std::string words = error.what();
    const std::size_t advice = words.find("--port ");
    ASSERT_NE(advice, std::string::npos) << words;
    const auto free = static_cast<std::uint16_t>(std::stoi(words.substr(advice + 7)));
    EXPECT_NE(free, test.port());
    const Server third({"127.0.0.1", free, {}}, test.content());  // as advised
    EXPECT_EQ(third.port(), free);
  }
}

TEST(Server, KnowsWhatOnlyThisComputerCanReach) {
  for (const char* address : {"127.0.0.1", "127.0.0.9", "::1"})
    EXPECT_EQ(is_loopback(address), true) << address;
  for (const char* address : {"0.0.0.0", "::", "192.168.0.7"})
    EXPECT_EQ(is_loopback(address), false) << address;
  for (const char* address : {"robot.local", "", "127.0.0", "localhost"})
    EXPECT_EQ(is_loopback(address), std::nullopt) << address;
}

}  // namespace
}  // namespace swivel
