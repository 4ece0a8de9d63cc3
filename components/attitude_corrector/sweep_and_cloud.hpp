// A sweep and its raw cloud come on two topics, in either order; their stamp joins them.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "calibration/organised_cloud.hpp"
#include "swivel/idl/point_cloud2.h"
#include "swivel/idl/swivel.h"

namespace swivel {

class SweepAndCloud {
 public:
  // Both return with complete() true once the two belong together; then clear() is next.
  bool add(const msg::Sweep& assembled);
  // Says what is wrong with a cloud that is refused, or nothing.
  [[nodiscard]] std::string add(const sensor_msgs::msg::dds_::PointCloud2_& message);

  bool complete() const { return sweep_.has_value() && cloud_stamp_ns_.has_value(); }
  const msg::Sweep& sweep() const { return *sweep_; }
  OrganisedCloud& cloud() { return cloud_; }
  void clear();

  std::uint64_t clouds_refused() const { return clouds_refused_; }
  std::uint64_t sweeps_without_cloud() const { return sweeps_without_cloud_; }

 private:
  void take_back(const msg::Sweep& assembled);
  void match();

  std::deque<msg::Sweep> waiting_;   // sweeps whose cloud has not come
  std::optional<msg::Sweep> sweep_;  // the one that belongs to cloud_
  std::optional<std::int64_t> cloud_stamp_ns_;
  OrganisedCloud cloud_;  // kept from sweep to sweep for its memory
  std::uint64_t clouds_refused_ = 0;
  std::uint64_t sweeps_without_cloud_ = 0;
};

}  // namespace swivel
