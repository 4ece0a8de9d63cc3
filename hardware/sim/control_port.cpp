#include "hardware/sim/control_port.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cerrno>
#include <charconv>
#include <sstream>
#include <system_error>

namespace swivel::sim {
namespace {

constexpr std::size_t kLongestCommand = 256;

}  // namespace

Command Command::parse(const std::string& line) {
  std::istringstream words(line);
  Command command;
  words >> command.target >> command.verb;
  for (std::string word; words >> word;) command.arguments.push_back(word);
  return command;
}

std::optional<double> Command::number(std::size_t argument, double lowest, double highest) const {
  if (argument >= arguments.size()) return std::nullopt;
  const std::string& text = arguments[argument];
  double value = 0.0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
  if (!whole || !(value >= lowest && value <= highest)) return std::nullopt;
  return value;
}

ControlPort::ControlPort(const std::string& path) : path_(path) {
  if (path_.empty()) return;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const bool fits = path_.size() < sizeof address.sun_path;
  if (fits) path_.copy(address.sun_path, path_.size());
  struct stat status {};
  const bool left_behind = ::lstat(path_.c_str(), &status) == 0 && S_ISSOCK(status.st_mode);
  if (left_behind) ::unlink(path_.c_str());
  listener_ = FileDescriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const mode_t mask = ::umask(0177);
  const bool bound =
      fits && ::bind(listener_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  ::umask(mask);
  if (!bound || ::listen(listener_.get(), 4) != 0) {
    throw std::system_error(fits ? errno : ENAMETOOLONG, std::generic_category(),
                            "cannot take commands at " + path_);
  }
}

ControlPort::~ControlPort() {
  if (listener_.open()) ::unlink(path_.c_str());
}

void ControlPort::add_to(std::vector<pollfd>& waits) const {
  if (listener_.open()) {
    waits.push_back({client_.open() ? client_.get() : listener_.get(), POLLIN, 0});
  }
}

void ControlPort::serve(const Obey& obey) {
  if (!listener_.open()) return;
  if (!client_.open()) {
    received_.clear();
    client_ =
        FileDescriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!client_.open()) return;
  }
  char bytes[512];
  const ssize_t count = ::recv(client_.get(), bytes, sizeof bytes, 0);
  if (count > 0) received_.append(bytes, static_cast<std::size_t>(count));
  if (count > 0) take_lines(obey);
  const bool gone = count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
  if (gone || received_.size() > kLongestCommand) client_.close();
}

void ControlPort::take_lines(const Obey& obey) {
  for (std::size_t end = received_.find('\n'); end != std::string::npos;
       end = received_.find('\n')) {
    const std::string answer = obey(received_.substr(0, end)) + "\n";
    received_.erase(0, end + 1);
    ::send(client_.get(), answer.data(), answer.size(), MSG_NOSIGNAL);
  }
}

}  // namespace swivel::sim
