#include "tests/hardware/lidar/scripted_lidar.hpp"

#include <poll.h>

#include <algorithm>
#include <array>

#include "hardware/lidar/scip.hpp"

namespace swivel {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using Keys = std::vector<std::pair<std::string, std::string>>;

std::string reply(const std::string& echo, const std::string& status,
                  const std::string& texts = {}) {
  std::string bytes = echo + "\n";
  scip::append_text(bytes, status);
  return bytes + texts + "\n";
}

std::string key_reply(const std::string& echo, const Keys& keys) {
  std::string texts;
  for (const auto& [key, value] : keys) scip::append_key(texts, key, value);
  return reply(echo, "00", texts);
}

}  // namespace

ScriptedLidar::ScriptedLidar(LidarScript script)
    : script_(std::move(script)), thread_([this] { serve(); }) {}

ScriptedLidar::~ScriptedLidar() {
  wake_up_.notify();
  thread_.join();
}

std::vector<std::string> ScriptedLidar::requests() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return requests_;
}

void ScriptedLidar::serve() {
  for (;;) {
    std::array<pollfd, 2> waited{pollfd{listener_.number(), POLLIN, 0},
                                 pollfd{wake_up_.descriptor(), POLLIN, 0}};
    ::poll(waited.data(), waited.size(), -1);
    if (waited[1].revents != 0) return;
    const Descriptor peer = listener_.accept();
    ++connections_;
    is_streaming_ = is_broken_ = false;
    scans_ = 0;
    held_back_.clear();
    serve_one(peer);
  }
}

void ScriptedLidar::serve_one(const Descriptor& peer) {
  std::string unread;
  while (!is_broken_ && wait_and_read(peer, unread)) {
    for (std::size_t end = unread.find('\n'); end != std::string::npos; end = unread.find('\n')) {
      answer(unread.substr(0, end), peer);
      unread.erase(0, end + 1);
    }
    if (is_streaming_) send_scans_due(peer);
  }
}

// False at the end of the connection, or of the test.
bool ScriptedLidar::wait_and_read(const Descriptor& peer, std::string& unread) {
  const Instant due = script_.paced ? next_scan_ : Instant::min();
  const auto wait = due < steady_clock::now()
                        ? 0
                        : std::chrono::ceil<milliseconds>(due - steady_clock::now()).count();
  std::array<pollfd, 2> waited{pollfd{peer.number(), POLLIN, 0},
                               pollfd{wake_up_.descriptor(), POLLIN, 0}};
  ::poll(waited.data(), waited.size(), is_streaming_ ? static_cast<int>(wait) : -1);
  if (waited[1].revents != 0) return false;
  if (waited[0].revents == 0) return true;
  std::array<char, 4096> bytes{};
  const ssize_t count = ::read(peer.number(), bytes.data(), bytes.size());
  if (count > 0) unread.append(bytes.data(), static_cast<std::size_t>(count));
  return count > 0;
}

void ScriptedLidar::answer(const std::string& request, const Descriptor& peer) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    requests_.push_back(request);
  }
  if (request == "QT") {
    if (quits_++ < script_.ignored_quits) return;
    is_streaming_ = false;
    send(peer, reply("QT", "00"));
  } else if (request == "VV") {
    send(peer, key_reply("VV", {{"VEND", "Nobody"},
                                {"PROD", "Scripted"},
                                {"FIRM", "1.0"},
                                {"PROT", "SCIP 2.2"},
                                {"SERI", "S123"}}));
  } else if (request == "PP") {
    send(peer, key_reply("PP", {{"DMIN", "20"},
                                {"DMAX", "30000"},
                                {"ARES", "1440"},
                                {"AMIN", "0"},
                                {"AMAX", "1080"},
                                {"AFRT", "540"},
                                {"SCAN", std::to_string(60000 / script_.scan_period_ms)}}));
  } else if (request == "II") {
    send(peer, key_reply("II", {{"STAT", "sensor is working normally"}}));
  } else if (request == "RS") {
    send(peer, reply("RS", "00"));
  } else if (request == "RB") {
    send(peer, reply("RB", reboots_++ % 2 == 0 ? "01" : "00"));
  } else if (request == "BM") {
    laser_is_on_ = true;
    send(peer, reply("BM", "00"));
  } else if (request.rfind("TM", 0) == 0) {
    std::string stamp;
    scip::append_text(stamp, scip::encode_value(clock_ms(), 4));
    if (script_.answers_clock) send(peer, reply(request, "00", request == "TM1" ? stamp : ""));
  } else if (request.rfind("ME", 0) == 0) {
    answer_scan_request(peer);
  } else {
    send(peer, reply(request, "0F"));
  }
}

void ScriptedLidar::answer_scan_request(const Descriptor& peer) {
  if (script_.wants_laser_on && !laser_is_on_) return send(peer, reply(script_.echo, "10"));
  const std::string acknowledgement = reply(script_.echo, script_.scan_status);
  if (script_.glues) held_back_ = acknowledgement;
  if (script_.acknowledges && !script_.glues) send(peer, acknowledgement);
  is_streaming_ = script_.scan_status == "00";
  next_scan_ = steady_clock::now() + milliseconds(script_.scan_period_ms);
}

void ScriptedLidar::send_scans_due(const Descriptor& peer) {
  const bool misbehaves = connections_ == 1;
  if (script_.garbage_instead) return send(peer, std::string(1000, '0'));
  while (steady_clock::now() >= next_scan_ || !script_.paced) {
    if (misbehaves && scans_ == script_.stall_after) is_streaming_ = false;
    if (misbehaves && scans_ == script_.close_after) is_broken_ = true;
    if (!is_streaming_ || is_broken_) return;
    const std::chrono::duration<double, std::milli> due = next_scan_ - start_;
    std::string bytes = scan(due.count() - script_.scan_period_ms);
    next_scan_ += milliseconds(script_.scan_period_ms);
    if (scans_ == script_.status_0m_after) bytes += reply(script_.echo, "0M");
    ++scans_;
    const bool holds_back = script_.glues && held_back_.size() < bytes.size();
    held_back_ += bytes;
    if (!holds_back) send(peer, std::exchange(held_back_, {}));
    if (!script_.paced) return;
  }
}

std::string ScriptedLidar::scan(double stamp_ms) {
  const auto stamp = static_cast<std::uint32_t>(stamp_ms) + 1000;
  std::string texts;
  scip::append_text(texts, scip::encode_value(stamp & 0x3FFFF, script_.stamp_characters));
  std::string data;
  for (int beam = 0; beam < script_.beams_sent; ++beam) {
    scip::append_value(data, range_mm(beam), 3);
    scip::append_value(data, intensity(beam), 3);
  }
  scip::append_data(texts, data);
  if (script_.bad_sum_every > 0 && scans_ % script_.bad_sum_every == 1)
    texts[100] = texts[100] == '0' ? '1' : '0';
  return reply(script_.echo, "99", texts);
}

std::uint32_t ScriptedLidar::clock_ms() const {
  const std::chrono::duration<double, std::milli> running = steady_clock::now() - start_;
  return static_cast<std::uint32_t>(running.count()) + 1000;
}

void ScriptedLidar::send(const Descriptor& peer, const std::string& bytes) {
  const std::size_t step = script_.chunk_bytes == 0 ? bytes.size() : script_.chunk_bytes;
  for (std::size_t start = 0; start < bytes.size() && !is_broken_; start += step) {
    const std::size_t count = std::min(step, bytes.size() - start);
    is_broken_ = ::send(peer.number(), bytes.data() + start, count, MSG_NOSIGNAL) < 0;
  }
}

}  // namespace swivel
