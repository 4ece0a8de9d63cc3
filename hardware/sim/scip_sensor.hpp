// A Hokuyo's side of SCIP: requests in, replies out, and which scans were asked for. No
// sockets, and time is an argument. The grammar stands in hardware/lidar/scip.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hardware/sim/lidar.hpp"
#include "hardware/sim/lidar_timing.hpp"

namespace swivel::sim {

class ScipSensor {
 public:
  // `timing` must outlive the sensor.
  ScipSensor(SensorModel model, LidarTiming& timing, std::int64_t start_latency_ns);

  void connect();  // a new client: quiet, whatever went before
  std::string receive(std::string_view bytes, std::int64_t now_ns);

  // The scan that is to be delivered next, if any was asked for.
  std::optional<std::uint64_t> wanted_scan() const;
  // The frames of that scan, one for each request that wanted it.
  std::vector<std::string> deliver(const LineReading& line);

  bool reboot_requested() const { return reboot_requested_; }

 private:
  struct Order {
    std::string request;  // without its number of scans and its string
    std::string string;   // ";..." of the request
    bool continuous = false;
    bool intensities = false;
    int first_step = 0;
    int last_step = 0;
    int cluster = 1;
    int interval = 0;
    std::optional<int> remaining;  // nothing: endless
    std::uint64_t scan = 0;
  };

  std::string reply_to(const std::string& request, std::int64_t now_ns);
  std::string reply_to_state_request(const std::string& request, std::int64_t now_ns);
  std::string identity(const std::string& request) const;
  std::string parameters(const std::string& request) const;
  std::string state(const std::string& request, std::int64_t now_ns) const;
  std::string operating_state(const std::string& request) const;
  std::string switch_laser_on(const std::string& request);
  std::string clock_mode(const std::string& request, std::int64_t now_ns);
  std::string initialise(const std::string& request, std::int64_t now_ns);
  std::string reboot(const std::string& request, std::int64_t now_ns);
  std::string take_order(const std::string& request, std::int64_t now_ns);
  const char* parse_order(const std::string& parameters, Order& order) const;
  bool allowed(const Order& order) const;
  void accept(const Order& order);
  std::string frame(const Order& order, const LineReading& line) const;
  void stop();

  SensorModel model_;
  LidarTiming* timing_;
  std::int64_t start_latency_ns_;
  std::string unfinished_;
  std::vector<Order> orders_;
  bool laser_on_ = false;
  bool clock_mode_ = false;
  bool asleep_ = false;
  bool reboot_requested_ = false;
  std::int64_t reboot_armed_until_ns_ = 0;
};

}  // namespace swivel::sim
