// What a viewer sees of a rig: the running sweep line by line, made by the assembler's own code,
// then the cloud as attitude_corrector sent it, with what was said of it. Knows no sockets.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "components/cloud_assembler/assembler.hpp"
#include "components/common/cloud_message.hpp"
#include "components/gateway/frame.hpp"
#include "components/gateway/packed_points.hpp"
#include "components/gateway/picture.hpp"

namespace swivel {

class LiveView {
 public:
  // publish gets each frame of points for those who are there already.
  LiveView(const RigFile& rig, std::function<void(Frame)> publish);

  void take(const msg::ScanLine& line) { assembler_.add(line); }
  void take(const msg::Axis& axis) { assembler_.add(axis); }
  void take(const msg::Sweep& sweep);
  void take(const msg::Attitude& attitude);
  // Empty, or why the cloud was refused.
  [[nodiscard]] std::string take(const PointCloud2Message& cloud);
  // To be called now and then: a sweep whose lines do not come is closed.
  void check(std::chrono::steady_clock::time_point now) { assembler_.check(now); }

  // The picture so far, for who comes late; none before the first.
  std::optional<Frame> whole_picture() const;

  const Picture& picture() const { return picture_; }
  const msg::Sweep& motor() const { return motor_; }  // what the sequencer said last

 private:
  void show_row(const msg::Sweep& announced, const OrganisedCloud& cloud, std::size_t row);
  void begin_picture(Picture::Kind kind, std::size_t lines, std::size_t beams);
  void begin_running(const msg::Sweep& announced, const OrganisedCloud& cloud);
  void close_running(const msg::Sweep& summary);
  void take_back(const msg::Sweep& assembled);
  void attach_attitude();

  std::string base_frame_;
  std::function<void(Frame)> publish_;
  Assembler assembler_;
  Picture picture_;
  std::int64_t window_start_ns_ = 0;  // of the running sweep
  std::string running_frame_;         // all lines of it, empty where none is in
  std::size_t rows_so_far_ = 0;       // up to the last one that is in
  std::shared_ptr<const std::string> cloud_frame_;
  msg::Attitude attitude_;  // the last
  msg::Sweep taken_back_;   // the last sweep that must not be used
  msg::Sweep motor_;
};

}  // namespace swivel
