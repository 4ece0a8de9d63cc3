#include "tests/components/gateway/browser.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <vector>

namespace swivel {
namespace {

using nlohmann::json;

// Chromium reads commands from descriptor 3 and writes answers to 4, each ended by a zero byte.
[[noreturn]] void become_chromium(int commands, int answers, const std::string& profile) {
  // Both out of the way of 3 and 4 first.
  commands = fcntl(commands, F_DUPFD, 10);
  answers = fcntl(answers, F_DUPFD, 10);
  dup2(commands, 3);
  dup2(answers, 4);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDERR_FILENO);
  execlp("chromium", "chromium", "--headless=new", "--no-sandbox", "--disable-gpu",
         "--disable-dev-shm-usage", "--remote-debugging-pipe", "--window-size=1280,860",
         ("--user-data-dir=" + profile).c_str(), "about:blank", nullptr);
  _exit(127);
}

std::string from_base64(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    const std::size_t value = letters.find(letter);
    if (value == std::string::npos) break;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFFU);
  }
  return bytes;
}

}  // namespace

Browser::Browser(const std::string& profile) {
  std::array<int, 2> to{}, from{};
  if (pipe2(to.data(), O_CLOEXEC) != 0 || pipe2(from.data(), O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe");
  process_ = fork();
  if (process_ == 0) become_chromium(to[0], from[1], profile);
  close(to[0]);
  close(from[1]);
  commands_ = to[1];
  answers_ = from[0];
  signal(SIGPIPE, SIG_IGN);
  const json page = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget",
                  {{"targetId", page["targetId"]}, {"flatten", true}})["sessionId"];
}

// Asked to close, it waits for its helpers, which write to the profile.
Browser::~Browser() {
  const std::string close_it = R"({"id":0,"method":"Browser.close"})" + std::string(1, '\0');
  if (write(commands_, close_it.data(), close_it.size()) < 0) kill(process_, SIGTERM);
  waitpid(process_, nullptr, 0);
  close(commands_);
  close(answers_);
}

std::string Browser::read_message() {
  std::size_t end = unread_.find('\0');
  while (end == std::string::npos) {
    std::array<char, 65536> bytes{};
    const ssize_t count = read(answers_, bytes.data(), bytes.size());
    if (count <= 0) throw std::runtime_error("Chromium ended; is the package chromium installed?");
    end = unread_.size();
    unread_.append(bytes.data(), static_cast<std::size_t>(count));
    end = unread_.find('\0', end);
  }
  std::string message = unread_.substr(0, end);
  unread_.erase(0, end + 1);
  return message;
}

json Browser::call(const std::string& method, const json& parameters) {
  json command{{"id", ++last_id_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) command["sessionId"] = session_;
  const std::string text = command.dump() + '\0';
  if (write(commands_, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    throw std::runtime_error("Chromium ended; is the package chromium installed?");
  while (true) {
    json answer = json::parse(read_message());
    if (!answer.contains("id") || answer["id"] != last_id_) continue;  // an event
    if (answer.contains("error")) throw PageError(answer["error"].dump());
    return answer["result"];
  }
}

void Browser::open(const std::string& address) {
  call("Page.navigate", {{"url", address}});
}

json Browser::evaluate(const std::string& javascript) {
  const json result =
      call("Runtime.evaluate",
           {{"expression", javascript}, {"returnByValue", true}, {"awaitPromise", true}});
  if (result.contains("exceptionDetails")) throw PageError(result["exceptionDetails"].dump());
  return result["result"].value("value", json());
}

bool Browser::await(const std::string& javascript, std::chrono::seconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (std::chrono::steady_clock::now() < deadline) {
    try {
      if (evaluate("Boolean(" + javascript + ")").get<bool>()) return true;
    } catch (const PageError&) {
      // The page is still on its way.
    }
    usleep(5000);
  }
  return false;
}

void Browser::mouse(const std::string& type, double x, double y, int buttons) {
  call("Input.dispatchMouseEvent", {{"type", type},
                                    {"x", x},
                                    {"y", y},
                                    {"button", "left"},
                                    {"buttons", buttons},
                                    {"clickCount", 1}});
}

void Browser::click(const std::string& selector) {
  const json place = evaluate("(() => { const box = document.querySelector(\"" + selector +
                              "\").getBoundingClientRect(); return [box.x + box.width / 2, "
                              "box.y + box.height / 2]; })()");
  mouse("mousePressed", place[0], place[1], 1);
  mouse("mouseReleased", place[0], place[1], 0);
}

void Browser::drag(double from_x, double from_y, double to_x, double to_y, int steps) {
  mouse("mousePressed", from_x, from_y, 1);
  for (int step = 1; step <= steps; ++step) {
    const double part = static_cast<double>(step) / steps;
    mouse("mouseMoved", from_x + part * (to_x - from_x), from_y + part * (to_y - from_y), 1);
  }
  mouse("mouseReleased", to_x, to_y, 0);
}

std::string Browser::screenshot() {
  return from_base64(call("Page.captureScreenshot", {{"format", "png"}})["data"]);
}

}  // namespace swivel
