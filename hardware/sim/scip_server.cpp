#include "hardware/sim/scip_server.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "hardware/lidar/scip.hpp"
#include "hardware/sim/loopback_listener.hpp"
#include "hardware/sim/sim_time.hpp"

namespace swivel::sim {
namespace {

constexpr std::size_t kSlowClient = 1U << 20U;  // bytes that a client may leave unread

bool every(int count, std::uint64_t frame) {
  return count > 0 && frame % static_cast<std::uint64_t>(count) == 0;
}

}  // namespace

ScipServer::ScipServer(const ScipServerOptions& options, ScipSensor& sensor,
                       const LidarTiming& timing, CastScan cast_scan)
    : options_(options),
      sensor_(&sensor),
      timing_(&timing),
      cast_scan_(std::move(cast_scan)),
      port_(options.port) {
  listen();
}

void ScipServer::listen() {
  LoopbackListener listener = listen_on_loopback(port_);
  if (port_ == 0) port_ = listener.port;  // once: others may ask for it from then on
  listener_ = std::move(listener.descriptor);
}

void ScipServer::add_to(std::vector<pollfd>& waits, std::int64_t now_ns) const {
  if (client_.open()) {
    const bool sends = !outgoing_.empty() && now_ns >= stalled_until_ns_;
    waits.push_back({client_.get(), static_cast<short>(sends ? POLLIN | POLLOUT : POLLIN), 0});
  } else if (listener_.open()) {
    waits.push_back({listener_.get(), POLLIN, 0});
  }
}

std::int64_t ScipServer::next_event_ns() const {
  if (back_at_ns_ != 0) return back_at_ns_;
  if (!client_.open()) return kNever_ns;
  const auto scan = sensor_->wanted_scan();
  const std::int64_t scan_ns = scan ? timing_->send_time_ns(*scan) : kNever_ns;
  return outgoing_.empty() ? scan_ns
                           : std::min(scan_ns, std::max<std::int64_t>(1, stalled_until_ns_));
}

void ScipServer::serve(std::int64_t now_ns) {
  if (back_at_ns_ != 0 && now_ns >= back_at_ns_) {
    listen();
    back_at_ns_ = 0;
  }
  if (client_.open()) read_client(now_ns);
  if (!client_.open()) accept_client();
  if (client_.open()) send_due_scans(now_ns);
  if (client_.open()) transmit(now_ns);
  if (sensor_->reboot_requested() && outgoing_.empty()) lose_power(options_.reboot_s, now_ns);
}

void ScipServer::accept_client() {
  if (!listener_.open()) return;
  client_ = accept_next(listener_);
  if (client_.open()) sensor_->connect();
}

void ScipServer::disconnect() {
  client_.close();
  outgoing_.clear();
  glued_.clear();
  close_when_sent_ = false;
  stalled_until_ns_ = 0;
  sensor_->connect();
}

void ScipServer::lose_power(double duration_s, std::int64_t now_ns) {
  disconnect();
  listener_.close();
  back_at_ns_ = now_ns + ns_from_s(duration_s);
}

void ScipServer::reset_connection() {
  const linger at_once{1, 0};
  ::setsockopt(client_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  disconnect();
}

void ScipServer::stall(double duration_s, std::int64_t now_ns) {
  stalled_until_ns_ = now_ns + ns_from_s(duration_s);
}

void ScipServer::read_client(std::int64_t now_ns) {
  char bytes[4096];
  const ssize_t count = ::recv(client_.get(), bytes, sizeof bytes, 0);
  if (count > 0) {
    outgoing_ += sensor_->receive({bytes, static_cast<std::size_t>(count)}, now_ns);
  } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
    disconnect();
  }
}

void ScipServer::send_due_scans(std::int64_t now_ns) {
  for (auto scan = sensor_->wanted_scan(); scan && timing_->send_time_ns(*scan) <= now_ns;
       scan = sensor_->wanted_scan()) {
    const bool slow = outgoing_.size() > kSlowClient;
    const auto frames = sensor_->deliver(slow ? LineReading{} : cast_scan_(*scan));
    if (slow) {
      ++scans_dropped_;
      continue;
    }
    for (const std::string& frame : frames) send_frame(frame, now_ns);
  }
}

void ScipServer::send_frame(std::string frame, std::int64_t now_ns) {
  if (close_when_sent_) return;
  spoil(frame);
  if (frame.empty()) return;
  const Misbehaviour& wrong = options_.misbehaviour;
  ++frames_;
  if (every(wrong.bad_sum_every, frames_)) frame[frame.size() / 2] ^= 1;
  if (every(wrong.close_every, frames_)) {
    frame.resize(frame.size() / 2);
    close_when_sent_ = true;
  }
  glued_ += frame;
  if (wrong.glue_frames > 1 && !every(wrong.glue_frames, frames_) && !close_when_sent_) return;
  outgoing_ += std::exchange(glued_, {});
  if (every(wrong.stall_every, frames_)) stalled_until_ns_ = now_ns + ns_from_s(wrong.stall_s);
}

// One kind after the other, each frame once.
void ScipServer::spoil(std::string& frame) {
  const auto due = [](int& count) { return count > 0 && count-- > 0; };
  if (due(next_frames_.dropped)) {
    frame.clear();
  } else if (due(next_frames_.halved)) {
    frame.resize(frame.size() / 2);
  } else if (due(next_frames_.bad_sums)) {
    frame[frame.size() / 2] ^= 1;
  } else if (due(next_frames_.wrong_echoes)) {
    frame[1] = frame[1] == 'D' ? 'E' : 'D';
  } else if (due(next_frames_.refused)) {
    frame.resize(frame.find('\n') + 1);
    scip::append_text(frame, next_frames_.status);
    frame += '\n';
  }
}

void ScipServer::transmit(std::int64_t now_ns) {
  if (now_ns < stalled_until_ns_) return;
  std::size_t sent = 0;
  while (sent < outgoing_.size()) {
    const std::size_t length = options_.misbehaviour.chop ? 1 : outgoing_.size() - sent;
    const ssize_t count = ::send(client_.get(), outgoing_.data() + sent, length, MSG_NOSIGNAL);
    if (count < 0 && errno != EAGAIN && errno != EINTR) return disconnect();
    if (count <= 0) break;
    sent += static_cast<std::size_t>(count);
  }
  outgoing_.erase(0, sent);
  if (outgoing_.empty() && close_when_sent_) disconnect();
}

}  // namespace swivel::sim
