#include "hardware/sim/grbl_port.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <termios.h>

#include <cerrno>
#include <cstdlib>
#include <limits>
#include <system_error>
#include <utility>

namespace swivel::sim {
namespace {

constexpr std::int64_t kBusyTick_ns = 2'000'000;
constexpr std::int64_t kClosedTick_ns = 5'000'000;  // a pty does not tell that it was opened

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

// Raw, so that nothing is echoed. Opened and closed once, it also reports from then on
// whether a client has it open: a hang-up means that none has.
void prepare(const std::string& path) {
  const FileDescriptor client_side(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  if (!client_side.open() || ::tcgetattr(client_side.get(), &settings) != 0) fail(path);
  ::cfmakeraw(&settings);
  if (::tcsetattr(client_side.get(), TCSANOW, &settings) != 0) fail(path);
}

}  // namespace

GrblPort::GrblPort(GrblPeer& peer, const std::string& link)
    : peer_(&peer), link_(link), pty_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  char path[128];
  if (!pty_.open() || ::grantpt(pty_.get()) != 0 || ::unlockpt(pty_.get()) != 0 ||
      ::ptsname_r(pty_.get(), path, sizeof path) != 0) {
    fail("cannot make a pty for the stepper");
  }
  path_ = path;
  prepare(path_);
  make_link();
}

// Replaces a link that an earlier run left behind, but nothing else.
void GrblPort::make_link() {
  if (link_.empty()) return;
  struct stat status {};
  if (::lstat(link_.c_str(), &status) == 0 && S_ISLNK(status.st_mode)) ::unlink(link_.c_str());
  if (::symlink(path_.c_str(), link_.c_str()) != 0) {
    const std::string link = std::exchange(link_, {});
    fail("cannot make the link " + link + " to the stepper's pty");
  }
}

GrblPort::~GrblPort() {
  if (!link_.empty()) ::unlink(link_.c_str());
}

// A client has it open, or has left something behind that is still to be read.
bool GrblPort::open_or_unread() const {
  pollfd state{pty_.get(), POLLIN, 0};
  ::poll(&state, 1, 0);
  return (state.revents & POLLHUP) == 0 || (state.revents & POLLIN) != 0;
}

void GrblPort::add_to(std::vector<pollfd>& waits) const {
  if (!opened_) return;  // poll would return at once, again and again
  const bool sends = !outgoing_.empty();
  waits.push_back({pty_.get(), static_cast<short>(sends ? POLLIN | POLLOUT : POLLIN), 0});
}

std::int64_t GrblPort::next_event_ns(std::int64_t now_ns) const {
  if (!opened_) return now_ns + kClosedTick_ns;
  if (peer_->busy(now_ns)) return now_ns + kBusyTick_ns;
  return std::numeric_limits<std::int64_t>::max();
}

void GrblPort::serve(std::int64_t now_ns) {
  const bool was_open = opened_;
  opened_ = open_or_unread();
  if (opened_ && !was_open) {
    outgoing_.clear();
    peer_->power_up(now_ns);
  }
  if (opened_) read_client(now_ns);
  peer_->advance(now_ns);
  outgoing_ += peer_->take_output();
  if (!opened_) outgoing_.clear();
  write_client();
}

void GrblPort::read_client(std::int64_t now_ns) {
  char bytes[512];
  const ssize_t count = ::read(pty_.get(), bytes, sizeof bytes);
  if (count > 0) peer_->receive({bytes, static_cast<std::size_t>(count)}, now_ns);
}

// What a client does not read is lost once the pty is full, as on a real serial line.
void GrblPort::write_client() {
  if (outgoing_.empty()) return;
  const ssize_t count = ::write(pty_.get(), outgoing_.data(), outgoing_.size());
  if (count > 0) outgoing_.erase(0, static_cast<std::size_t>(count));
  constexpr std::size_t kMostUnread = 65536;
  if (outgoing_.size() > kMostUnread) outgoing_.clear();
}

}  // namespace swivel::sim
