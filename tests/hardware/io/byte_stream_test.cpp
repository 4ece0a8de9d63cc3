#include "hardware/io/byte_stream.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <future>
#include <thread>

#include "tests/hardware/io/peers.hpp"

namespace swivel {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

constexpr milliseconds kLong{5000};
constexpr milliseconds kShort{20};

std::string all_bytes() {
  std::string bytes;
  for (int byte = 0; byte < 256; ++byte) bytes.push_back(static_cast<char>(byte));
  return bytes;
}

// As many bytes as were sent, by however many reads.
std::string receive(ByteStream& stream, std::size_t count) {
  std::string bytes;
  while (bytes.size() < count) {
    const Received received = stream.read_some(kLong);
    if (received.kind != Received::Kind::kData) break;
    bytes += received.bytes;
  }
  return bytes;
}

std::string receive(int descriptor, std::size_t count) {
  std::string bytes(count, '\0');
  std::size_t filled = 0;
  while (filled < count) {
    const ssize_t more = ::read(descriptor, &bytes[filled], count - filled);
    if (more <= 0) break;
    filled += static_cast<std::size_t>(more);
  }
  return bytes;
}

std::string reason_of(const std::string& address) {
  const auto stream = ByteStream::open(address, milliseconds(300));
  return stream ? "it opened" : stream.reason();
}

struct TcpPair {
  TcpPair() : stream(ByteStream::open(listener.address(), kLong)), peer(listener.accept()) {}
  Listener listener;
  Result<ByteStream> stream;
  Descriptor peer;
};

TEST(ByteStream, TcpCarriesEveryByteBothWays) {
  TcpPair pair;
  ASSERT_TRUE(pair.stream) << pair.stream.reason();
  ASSERT_TRUE(pair.stream->write_all(all_bytes(), kLong));
  EXPECT_EQ(receive(pair.peer.number(), 256), all_bytes());
  ASSERT_EQ(::write(pair.peer.number(), all_bytes().data(), 256), 256);
  EXPECT_EQ(receive(*pair.stream, 256), all_bytes());
}

TEST(ByteStream, PtyCarriesEveryByteBothWays) {
  const Pty pty;
  auto stream = ByteStream::open(pty.address() + "@115200", kLong);
  ASSERT_TRUE(stream) << stream.reason();
  ASSERT_TRUE(stream->write_all(all_bytes(), kLong));
  EXPECT_EQ(receive(pty.number(), 256), all_bytes());
  ASSERT_EQ(::write(pty.number(), all_bytes().data(), 256), 256);
  EXPECT_EQ(receive(*stream, 256), all_bytes());
}

TEST(ByteStream, SilenceIsATimeoutAndTakesThatLong) {
  TcpPair pair;
  const auto start = steady_clock::now();
  EXPECT_EQ(pair.stream->read_some(kShort).kind, Received::Kind::kTimeout);
  EXPECT_GE(steady_clock::now() - start, kShort);
}

TEST(ByteStream, WakeUpEndsABlockedReadUntilCleared) {
  TcpPair pair;
  const WakeUp wake_up;
  auto blocked =
      std::async(std::launch::async, [&] { return pair.stream->read_some(kLong, &wake_up).kind; });
  wake_up.notify();
  EXPECT_EQ(blocked.get(), Received::Kind::kInterrupted);
  EXPECT_EQ(pair.stream->read_some(kLong, &wake_up).kind, Received::Kind::kInterrupted);
  EXPECT_TRUE(pair.stream->write_all("the motor must still hear this", kLong));
  wake_up.clear();
  EXPECT_EQ(pair.stream->read_some(kShort, &wake_up).kind, Received::Kind::kTimeout);
}

TEST(ByteStream, APeerThatGoesIsClosedAndNoSignal) {
  TcpPair pair;
  pair.peer.close();
  EXPECT_EQ(pair.stream->read_some(kLong).kind, Received::Kind::kClosed);
  Outcome written = Done{};
  for (int time = 0; time < 100 && written; ++time) written = pair.stream->write_all("?", kLong);
  EXPECT_THAT(written.reason(), HasSubstr("closed"));
}

TEST(ByteStream, APtyThatIsUnpluggedIsClosed) {
  Pty pty;
  auto stream = ByteStream::open(pty.address(), kLong);
  ASSERT_TRUE(stream) << stream.reason();
  pty.close();
  EXPECT_EQ(stream->read_some(kLong).kind, Received::Kind::kClosed);
}

TEST(ByteStream, BytesFromBeforeTheEndAreStillRead) {
  TcpPair pair;
  ASSERT_EQ(::write(pair.peer.number(), "last", 4), 4);
  pair.peer.close();
  EXPECT_EQ(receive(*pair.stream, 4), "last");
}

TEST(ByteStream, APeerThatReadsNothingEndsAWriteInWords) {
  TcpPair pair;
  std::string too_much;
  too_much.resize(64'000'000);
  EXPECT_THAT(pair.stream->write_all(too_much, milliseconds(50)).reason(),
              HasSubstr("takes no more bytes"));
}

TEST(ByteStream, FailuresToOpenSayWhatToDo) {
  std::string deaf;
  {
    const Listener listener;  // nobody listens on this port any more
    deaf = listener.address();
  }
  EXPECT_THAT(reason_of(deaf), HasSubstr("connection refused"));
  EXPECT_THAT(reason_of("tcp://127.0.0.1:70000"), HasSubstr("from 1 to 65535"));
  EXPECT_THAT(reason_of("tcp://127.0.0.1:0"), HasSubstr("from 1 to 65535"));
  EXPECT_THAT(reason_of("tcp://127.0.0.1:"), HasSubstr("from 1 to 65535"));
  EXPECT_THAT(reason_of("tcp://127.0.0.1:80x"), HasSubstr("from 1 to 65535"));
  EXPECT_THAT(reason_of("tcp://127.0.0.1"), HasSubstr("tcp://HOST:PORT"));
  EXPECT_THAT(reason_of("192.168.0.10"), HasSubstr("an address is"));
  EXPECT_THAT(reason_of("/dev/ttyNONE0"), HasSubstr("plugged in"));
  EXPECT_THAT(reason_of("/dev/null"), HasSubstr("not a serial device"));
  EXPECT_THAT(reason_of("/dev/ttyACM0@1234"), HasSubstr("baud rate"));
}

TEST(ByteStream, AnUnknownNameFailsInTimeEvenWithoutANameServer) {
  const auto start = steady_clock::now();
  EXPECT_THAT(reason_of("tcp://no-such-sensor.invalid:10940"), HasSubstr("number instead"));
  EXPECT_LT(steady_clock::now() - start, std::chrono::seconds(2));
}

// 192.0.2.0/24 belongs to nobody (RFC 5737): without a route at once, else at the deadline.
TEST(ByteStream, AHostThatIsNotThereFailsInTime) {
  const auto start = steady_clock::now();
  EXPECT_THAT(reason_of("tcp://192.0.2.1:10940"), HasSubstr("check"));
  EXPECT_LT(steady_clock::now() - start, std::chrono::seconds(2));
}

TEST(ByteStream, ADeviceIsOpenedByOneProgramAtATime) {
  const Pty pty;
  {
    const auto first = ByteStream::open(pty.address(), kLong);
    ASSERT_TRUE(first) << first.reason();
    EXPECT_THAT(reason_of(pty.address()), HasSubstr("in use"));
  }
  EXPECT_TRUE(ByteStream::open(pty.address(), kLong));
}

// The banner of a controller's last life was taken for that of its present one, and the true one
// for a reset.
TEST(ByteStream, WhatWasSaidBeforeItWasOpenedIsNotHeard) {
  const Pty pty;
  { ASSERT_TRUE(ByteStream::open(pty.address(), kLong)); }
  ASSERT_EQ(::write(pty.number(), "old\n", 4), 4);
  auto stream = ByteStream::open(pty.address(), kLong);
  ASSERT_TRUE(stream) << stream.reason();
  ASSERT_EQ(::write(pty.number(), "new\n", 4), 4);
  EXPECT_EQ(stream->read_some(kLong).bytes, "new\n");
}

// In a process of its own that gives up being root, whom nothing is denied.
TEST(ByteStream, PermissionDeniedNamesTheGroup) {
  constexpr uid_t kNobody = 65534;
  const Pty pty;
  ASSERT_EQ(::chmod(pty.address().c_str(), 0), 0);
  EXPECT_EXIT(
      {
        if (::geteuid() == 0 && ::setuid(kNobody) != 0) ::_exit(2);
        ::_exit(reason_of(pty.address()).find("dialout") == std::string::npos ? 1 : 0);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST(ByteStream, MovedFromAndMovedToCloseOnce) {
  TcpPair pair;
  ByteStream moved = std::move(*pair.stream);
  pair.stream = std::move(moved);
  ASSERT_TRUE(pair.stream->write_all("x", kLong));
  EXPECT_EQ(receive(pair.peer.number(), 1), "x");
}

}  // namespace
}  // namespace swivel
