#include "hardware/io/wake_up.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace swivel {

WakeUp::WakeUp() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(),
                            "no pipe to be had: too many files are open");
  reading_end_ = ends[0];
  writing_end_ = ends[1];
}

WakeUp::~WakeUp() {
  ::close(reading_end_);
  ::close(writing_end_);
}

void WakeUp::notify() const {
  const int saved_errno = errno;  // a signal handler must leave it alone
  const char byte = 1;
  // A full pipe refuses the byte, and is readable all the same.
  [[maybe_unused]] const auto written = ::write(writing_end_, &byte, 1);
  errno = saved_errno;
}

void WakeUp::clear() const {
  std::array<char, 64> bytes{};
  while (::read(reading_end_, bytes.data(), bytes.size()) > 0) {
  }
}

}  // namespace swivel
