// What the tests of DDS share: participants on the loopback alone, in a domain of the test's
// own, and clouds that can be told from each other.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "components/dds/participant.hpp"

namespace swivel {

// Tests run side by side, each process of them in a domain that it has locked until it ends.
// Process ids alone did not keep them apart: a pipeline once took the sweeps of another test's.
inline int domain_of_this_test() {
  constexpr int kFirst = 100;
  constexpr int kDomains = 130;
  static const int domain = [] {
    for (int attempt = 0; attempt < kDomains; ++attempt) {
      const int candidate = kFirst + (getpid() + attempt) % kDomains;
      const std::string lock = "/tmp/swivel_test_domain_" + std::to_string(candidate);
      const int file = open(lock.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
      if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0) return candidate;
      if (file >= 0) close(file);
    }
    throw std::runtime_error("all DDS domains of tests are taken: see /tmp/swivel_test_domain_*");
  }();
  return domain;
}

inline const std::string kProfiles = SWIVEL_CONFIG "/dds_profiles.xml";

inline ParticipantOptions loopback_participant(const std::string& name, int domain,
                                               const std::string& profiles = kProfiles) {
  return {name, "test_rig", domain, "loopback", profiles};
}

// Of security_test: names of one length.
inline constexpr std::string_view kIntruder = "intruder";
inline constexpr std::string_view kVictim = "thelidar";

// What tells an intruder's scan line from those of the test's lidar.
inline constexpr std::uint32_t kIntrudersStamp_ms = 666666;

// As large as a sweep of mode 7. Its bytes follow from its number.
inline PointCloud2 numbered_cloud(int number) {
  PointCloud2 cloud;
  cloud.height(640);
  cloud.width(1081);
  cloud.point_step(16);
  cloud.row_step(16 * cloud.width());
  cloud.data().resize(std::size_t{cloud.row_step()} * cloud.height());
  std::uint32_t state = static_cast<std::uint32_t>(number);
  for (std::uint8_t& byte : cloud.data()) {
    state = state * 1664525U + 1013904223U;
    byte = static_cast<std::uint8_t>(state >> 24);
  }
  cloud.header().stamp().sec(number);
  return cloud;
}

// What a callback on the participant's thread saw, read from the test's.
template <class Value>
class Seen {
 public:
  void add(Value value) {
    const std::lock_guard lock(mutex_);
    values_.push_back(std::move(value));
  }
  std::vector<Value> values() const {
    const std::lock_guard lock(mutex_);
    return values_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Value> values_;
};

// Until the condition holds; false when the time is over.
inline bool wait_until(const std::function<bool()>& condition,
                       std::chrono::seconds limit = std::chrono::seconds(20)) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    usleep(1000);
  }
  return true;
}

}  // namespace swivel
