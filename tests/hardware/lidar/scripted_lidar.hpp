// A lidar on a TCP port of the loopback that behaves, or misbehaves as its script says.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "hardware/io/wake_up.hpp"
#include "tests/hardware/io/peers.hpp"

namespace swivel {

struct LidarScript {
  int beams_sent = 1081;  // PP always says 1081
  int scan_period_ms = 5;
  bool paced = true;
  std::size_t chunk_bytes = 0;  // 0: whole replies
  bool glues = false;           // the acknowledgement with the first scan, then scans by twos
  int ignored_quits = 0;
  bool acknowledges = true;
  bool answers_clock = true;
  std::string echo = "ME0000108001000";  // of acknowledgement and scans
  std::string scan_status = "00";        // of the acknowledgement
  bool wants_laser_on = false;           // status 10 until BM
  int stamp_characters = 4;
  int bad_sum_every = 0;         // one scan of so many
  int status_0m_after = -1;      // a reply of status 0M after so many scans
  int stall_after = -1;          // first connection only: so many scans, then silence
  int close_after = -1;          // first connection only
  bool garbage_instead = false;  // bytes without end in place of scans
};

class ScriptedLidar {
 public:
  explicit ScriptedLidar(LidarScript script);
  ~ScriptedLidar();

  std::string address() const { return listener_.address(); }
  int connections() const { return connections_; }
  std::vector<std::string> requests() const;

  // What beam k of every scan says.
  static std::uint16_t range_mm(int beam) { return static_cast<std::uint16_t>(500 + 20 * beam); }
  static std::uint16_t intensity(int beam) { return static_cast<std::uint16_t>(3000 - beam); }

 private:
  using Instant = std::chrono::steady_clock::time_point;

  void serve();
  void serve_one(const Descriptor& peer);
  bool wait_and_read(const Descriptor& peer, std::string& unread);
  void answer(const std::string& request, const Descriptor& peer);
  void answer_scan_request(const Descriptor& peer);
  void send_scans_due(const Descriptor& peer);
  std::string scan(double stamp_ms);
  std::uint32_t clock_ms() const;
  void send(const Descriptor& peer, const std::string& bytes);

  const LidarScript script_;
  Listener listener_;
  WakeUp wake_up_;
  const Instant start_ = std::chrono::steady_clock::now();
  std::atomic<int> connections_{0};
  mutable std::mutex mutex_;
  std::vector<std::string> requests_;

  bool is_streaming_ = false;
  bool laser_is_on_ = false;
  bool is_broken_ = false;  // the connection has failed, or was closed by the script
  int quits_ = 0;
  int reboots_ = 0;
  int scans_ = 0;  // of this connection
  Instant next_scan_;
  std::string held_back_;  // to be glued to what comes next
  std::thread thread_;
};

}  // namespace swivel
