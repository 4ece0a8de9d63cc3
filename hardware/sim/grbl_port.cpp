#include "hardware/sim/grbl_port.hpp"

#include <fcntl.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <termios.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "hardware/sim/sim_time.hpp"

namespace swivel::sim {
namespace {

constexpr std::int64_t kHeldTick_ns = 2 * kMillisecond_ns;

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

// Raw, so that nothing is echoed.
void prepare(const std::string& path) {
  const FileDescriptor client_side(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  if (!client_side.open() || ::tcgetattr(client_side.get(), &settings) != 0) fail(path);
  ::cfmakeraw(&settings);
  if (::tcsetattr(client_side.get(), TCSANOW, &settings) != 0) fail(path);
}

}  // namespace

GrblPort::GrblPort(SerialDevice& peer, const std::string& link) : peer_(&peer), link_(link) {
  plug_in();
}

void GrblPort::plug_in() {
  pty_ = FileDescriptor(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  char path[128];
  if (!pty_.open() || ::grantpt(pty_.get()) != 0 || ::unlockpt(pty_.get()) != 0 ||
      ::ptsname_r(pty_.get(), path, sizeof path) != 0) {
    fail("cannot make a pty for the stepper");
  }
  path_ = path;
  prepare(path_);
  watch_openings();
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

// A pty does not tell its other side when it is opened, but the file system does.
void GrblPort::watch_openings() {
  openings_ = FileDescriptor(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  if (!openings_.open() ||
      ::inotify_add_watch(openings_.get(), path_.c_str(), IN_OPEN | IN_CLOSE) < 0) {
    fail("cannot watch the stepper's pty");
  }
}

// Opening raises DTR, which resets the controller, unless somebody has it open already.
void GrblPort::note_openings(std::int64_t now_ns) {
  alignas(inotify_event) char bytes[4096];
  const ssize_t count = ::read(openings_.get(), bytes, sizeof bytes);
  for (ssize_t at = 0; at < count;) {
    inotify_event event{};
    std::memcpy(&event, bytes + at, sizeof event);
    at += static_cast<ssize_t>(sizeof event + event.len);
    if ((event.mask & IN_CLOSE) != 0U) clients_ = std::max(0, clients_ - 1);
    if ((event.mask & IN_OPEN) == 0U || clients_++ > 0) continue;
    outgoing_.clear();
    peer_->power_up(now_ns);
  }
}

// A new pty takes its place in the end, as a USB device comes back under another number.
void GrblPort::unplug(double duration_s, std::int64_t now_ns) {
  pty_.close();
  openings_.close();
  if (!link_.empty()) ::unlink(link_.c_str());
  clients_ = 0;
  held_.clear();
  outgoing_.clear();
  plugged_in_at_ns_ = now_ns + ns_from_s(duration_s);
}

void GrblPort::silence(double duration_s, std::int64_t now_ns) {
  silent_until_ns_ = now_ns + ns_from_s(duration_s);
}

void GrblPort::delay_answers(double delay_s) {
  answer_delay_ns_ = ns_from_s(delay_s);
}

void GrblPort::add_to(std::vector<pollfd>& waits) const {
  if (!pty_.open()) return;
  waits.push_back({openings_.get(), POLLIN, 0});
  if (clients_ == 0) return;  // hung up: poll would return at once, again and again
  const bool sends = !outgoing_.empty();
  waits.push_back({pty_.get(), static_cast<short>(sends ? POLLIN | POLLOUT : POLLIN), 0});
}

std::int64_t GrblPort::next_event_ns(std::int64_t now_ns) const {
  const std::int64_t by_itself_ns = pty_.open() ? peer_->next_event_ns(now_ns) : plugged_in_at_ns_;
  return held_.empty() ? by_itself_ns : std::min(by_itself_ns, now_ns + kHeldTick_ns);
}

void GrblPort::serve(std::int64_t now_ns) {
  if (!pty_.open() && now_ns >= plugged_in_at_ns_) plug_in();
  if (pty_.open()) note_openings(now_ns);
  if (pty_.open()) read_client(now_ns);
  peer_->advance(now_ns);
  take_answers(now_ns);
  if (clients_ == 0) outgoing_.clear();
  write_client();
}

void GrblPort::take_answers(std::int64_t now_ns) {
  std::string text = peer_->take_output();
  if (!text.empty() && now_ns >= silent_until_ns_) {
    held_.push_back({std::move(text), now_ns + answer_delay_ns_});
  }
  while (!held_.empty() && now_ns >= held_.front().due_ns) {
    outgoing_ += held_.front().text;
    held_.pop_front();
  }
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
