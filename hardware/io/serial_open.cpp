#include "hardware/io/serial_open.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace swivel {
namespace {

constexpr char kDefaultBaud[] = "115200";

struct PathAndSpeed {
  std::string path;
  speed_t speed = B115200;
};

// POSIX knows rates by name only.
Result<speed_t> speed_of(const std::string& baud) {
  struct Rate {
    const char* text;
    speed_t speed;
  };
  constexpr Rate kRates[] = {{"9600", B9600},      {"19200", B19200},       {"38400", B38400},
                             {"57600", B57600},    {kDefaultBaud, B115200}, {"230400", B230400},
                             {"460800", B460800},  {"500000", B500000},     {"921600", B921600},
                             {"1000000", B1000000}};
  for (const Rate& rate : kRates)
    if (baud == rate.text) return rate.speed;
  return Failure{"the baud rate '" + baud + "' is not supported: 9600 to 1000000, mostly 115200"};
}

Result<PathAndSpeed> split_speed(const std::string& path_and_baud) {
  const auto at = path_and_baud.rfind('@');
  const bool given = at != std::string::npos;
  const Result<speed_t> speed = speed_of(given ? path_and_baud.substr(at + 1) : kDefaultBaud);
  if (!speed) return Failure{speed.reason()};
  return PathAndSpeed{path_and_baud.substr(0, at), *speed};
}

std::string open_reason(int error) {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return "no such device: check that it is plugged in and powered, and its name (ls /dev/tty*)";
    case EACCES:
    case EPERM:
      return "permission denied: add yourself to the group dialout (sudo usermod -aG dialout "
             "$USER) and log in again";
    case EBUSY:
    case EWOULDBLOCK:
      return "in use by another program: stop that one first";
    default:
      return std::string(std::strerror(error));
  }
}

// 0, or an errno.
int make_raw(int descriptor, speed_t speed) {
  termios settings{};
  if (::tcgetattr(descriptor, &settings) != 0) return errno;
  ::cfmakeraw(&settings);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cc[VMIN] = 1;  // so that "nothing yet" and "unplugged" read differently
  settings.c_cc[VTIME] = 0;
  ::cfsetispeed(&settings, speed);
  ::cfsetospeed(&settings, speed);
  return ::tcsetattr(descriptor, TCSANOW, &settings) == 0 ? 0 : errno;
}

Outcome set_up(int descriptor, speed_t speed) {
  if (::isatty(descriptor) == 0) return Failure{"not a serial device: check the name"};
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) return Failure{open_reason(errno)};
  const int error = make_raw(descriptor, speed);
  if (error != 0) return Failure{"the line cannot be set up: " + open_reason(error)};
  ::tcflush(descriptor, TCIFLUSH);  // what was said to whoever had it open before
  return Done{};
}

}  // namespace

Result<int> serial_open(const std::string& path_and_baud) {
  const Result<PathAndSpeed> wanted = split_speed(path_and_baud);
  if (!wanted) return Failure{wanted.reason()};
  const int descriptor = ::open(wanted->path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return Failure{open_reason(errno)};
  const Outcome ready = set_up(descriptor, wanted->speed);
  if (ready) return descriptor;
  ::close(descriptor);
  return Failure{ready.reason()};
}

}  // namespace swivel
