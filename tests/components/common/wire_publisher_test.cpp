#include "components/common/wire_publisher.hpp"

#include <gtest/gtest.h>

#include <map>
#include <mutex>

#include "tests/components/dds/test_participant.hpp"

namespace swivel {
namespace {

// What a listener puts together, a connection's bytes of one direction, by their offsets.
class Listener {
 public:
  explicit Listener(int domain) : participant_(loopback_participant("listener", domain)) {
    participant_.subscribe<msg::WireBytes>(kWireTopic, [this](const msg::WireBytes& wire) {
      const std::lock_guard lock(mutex_);
      if (wire.kind() != msg::WIRE_FROM_DEVICE) return;
      std::string& heard = heard_[wire.opened_time_ns()];
      heard.resize(std::max<std::size_t>(heard.size(), wire.offset() + wire.bytes().size()), '?');
      std::copy(wire.bytes().begin(), wire.bytes().end(),
                heard.begin() + static_cast<std::ptrdiff_t>(wire.offset()));
    });
    participant_.start();
  }
  ~Listener() { participant_.stop(); }

  bool hears(std::int64_t connection, const std::string& bytes) {
    return wait_until([&] {
      const std::lock_guard lock(mutex_);
      return heard_[connection] == bytes;
    });
  }

 private:
  std::mutex mutex_;
  std::map<std::int64_t, std::string> heard_;
  Participant participant_;
};

TEST(WirePublisher, WhoeverBeginsToListenHearsHowTheConnectionBegan) {
  const int domain = domain_of_this_test();
  Participant participant(loopback_participant("reader", domain));
  WirePublisher publisher(participant, msg::WIRE_OF_LIDAR);
  participant.start();
  const WireTap tap = publisher.tap();
  tap({WireEvent::Kind::kOpened, 1, {}});
  tap({WireEvent::Kind::kReceived, 2, "of the first connection"});
  tap({WireEvent::Kind::kOpened, 10, {}});
  tap({WireEvent::Kind::kSent, 11, "VV\n"});
  tap({WireEvent::Kind::kReceived, 12, "the beg"});
  Listener early(domain);
  EXPECT_TRUE(early.hears(10, "the beg"));
  tap({WireEvent::Kind::kReceived, 13, "inning, "});
  Listener late(domain);
  EXPECT_TRUE(late.hears(10, "the beginning, "));
  tap({WireEvent::Kind::kReceived, 14, "and the rest"});
  for (Listener* listener : {&early, &late}) {
    EXPECT_TRUE(listener->hears(10, "the beginning, and the rest"));
    EXPECT_TRUE(listener->hears(1, ""));
  }
  EXPECT_EQ(publisher.not_sent(), 0U);
  participant.stop();
}

TEST(WirePublisher, OfALongConnectionTheBeginningIsKeptAndTheRestIsAHole) {
  const int domain = domain_of_this_test();
  Participant participant(loopback_participant("reader", domain));
  WirePublisher publisher(participant, msg::WIRE_OF_LIDAR);
  participant.start();
  const WireTap tap = publisher.tap();
  tap({WireEvent::Kind::kOpened, 1, {}});
  std::string all;
  for (int scan = 0; scan < 1000; ++scan) {
    const std::string bytes(6709, static_cast<char>('a' + scan % 26));
    tap({WireEvent::Kind::kReceived, scan + 2, bytes});
    all += bytes;
  }
  Listener listener(domain);
  const std::size_t kept = 38 * 6709;  // of 256 kB
  EXPECT_TRUE(listener.hears(1, all.substr(0, kept)));
  tap({WireEvent::Kind::kReceived, 2000, "now"});
  EXPECT_TRUE(listener.hears(1, all.substr(0, kept) + std::string(all.size() - kept, '?') + "now"));
  participant.stop();
}

}  // namespace
}  // namespace swivel
