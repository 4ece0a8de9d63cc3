#include "components/gateway/live_view.hpp"

#include <algorithm>
#include <cstring>

namespace swivel {
namespace {

AssemblyOptions assembly_options(const RigFile& rig) {
  return {rig.geometry, rig.axis_measured, rig.timing, rad_from_deg(rig.modes.sweep_angle_deg)};
}

std::uint32_t count(std::size_t value) {
  return static_cast<std::uint32_t>(value);
}

}  // namespace

LiveView::LiveView(const RigFile& rig, std::function<void(Frame)> publish)
    : base_frame_(base_frame(rig.rig)),
      publish_(std::move(publish)),
      assembler_(assembly_options(rig),
                 [this](AssembledSweep&& assembled) { close_running(assembled.sweep); }) {
  assembler_.on_row([this](const msg::Sweep& announced, const OrganisedCloud& cloud,
                           std::size_t row) { show_row(announced, cloud, row); });
}

void LiveView::take(const msg::Sweep& sweep) {
  if (sweep.phase() == msg::PHASE_ASSEMBLED) return take_back(sweep);
  if (sweep.phase() == msg::PHASE_REFUSED) return;
  motor_ = sweep;
  assembler_.add(sweep);
}

void LiveView::begin_picture(Picture::Kind kind, std::size_t lines, std::size_t beams) {
  const std::uint32_t number = picture_.number + 1;
  picture_ = {};
  picture_.kind = kind;
  picture_.number = number;
  picture_.lines = lines;
  picture_.beams = beams;
}

void LiveView::begin_running(const msg::Sweep& announced, const OrganisedCloud& cloud) {
  begin_picture(Picture::Kind::kRunning, cloud.lines, cloud.beams);
  picture_.sweep_id = announced.sweep_id();
  picture_.mode = announced.mode();
  window_start_ns_ = announced.window_start_ns();
  cloud_frame_.reset();
  running_frame_.assign(sizeof(FrameHead) + cloud.points.size() * sizeof(PackedPoint), '\0');
  rows_so_far_ = 0;
}

void LiveView::show_row(const msg::Sweep& announced, const OrganisedCloud& cloud, std::size_t row) {
  const bool same = picture_.kind == Picture::Kind::kRunning &&
                    picture_.sweep_id == announced.sweep_id() &&
                    window_start_ns_ == announced.window_start_ns();
  if (!same) begin_running(announced, cloud);
  std::string frame = packed_frame(
      {FrameKind::kLines, picture_.number, count(cloud.lines), count(cloud.beams), count(row), 1},
      cloud.line(row));
  const std::size_t row_bytes = cloud.beams * sizeof(PackedPoint);
  std::memcpy(running_frame_.data() + sizeof(FrameHead) + row * row_bytes,
              frame.data() + sizeof(FrameHead), row_bytes);
  rows_so_far_ = std::max(rows_so_far_, row + 1);
  ++picture_.lines_in;
  publish_(binary_frame(std::move(frame)));
}

// The preview's own word on the running sweep; cloud_assembler's comes as PHASE_ASSEMBLED.
void LiveView::close_running(const msg::Sweep& summary) {
  if (picture_.kind != Picture::Kind::kRunning || picture_.sweep_id != summary.sweep_id()) return;
  const bool of_use = summary.lines_used() > 0;
  picture_.kind = of_use ? Picture::Kind::kAssembled : Picture::Kind::kStopped;
  picture_.stopped = of_use ? "" : summary.reason();
}

// A sweep may turn out bad after its cloud went out.
void LiveView::take_back(const msg::Sweep& assembled) {
  if (assembled.lines_used() > 0) return;
  taken_back_ = assembled;
  const bool same_cloud =
      picture_.kind == Picture::Kind::kCloud && picture_.stamp_ns == assembled.first_beam_time_ns();
  if (same_cloud) picture_.stopped = assembled.reason();
}

void LiveView::take(const msg::Attitude& attitude) {
  attitude_ = attitude;
  attach_attitude();
}

void LiveView::attach_attitude() {
  if (picture_.kind != Picture::Kind::kCloud) return;
  if (attitude_.first_beam_time_ns() != picture_.stamp_ns) return;
  picture_.attitude = attitude_;
  picture_.sweep_id = attitude_.sweep_id();
  picture_.mode = attitude_.mode();
}

std::string LiveView::take(const PointCloud2Message& cloud) {
  if (std::string wrong = wrong_with(cloud); !wrong.empty()) return wrong;
  const std::int64_t time_ns = stamp_ns(cloud);
  const bool of_earlier_sweep =
      picture_.kind == Picture::Kind::kRunning && time_ns < window_start_ns_;
  if (of_earlier_sweep) return {};
  begin_picture(Picture::Kind::kCloud, cloud.height(), cloud.width());
  picture_.lines_in = cloud.height();
  picture_.stamp_ns = time_ns;
  picture_.in_base = cloud.header().frame_id() == base_frame_;
  if (taken_back_.first_beam_time_ns() == time_ns) picture_.stopped = taken_back_.reason();
  attach_attitude();
  running_frame_ = {};
  cloud_frame_ = std::make_shared<const std::string>(packed_frame(
      {FrameKind::kCloud, picture_.number, cloud.height(), cloud.width(), 0, cloud.height()},
      cloud.data().data()));
  publish_({false, {}, cloud_frame_});
  return {};
}

std::optional<Frame> LiveView::whole_picture() const {
  if (cloud_frame_) return Frame{false, {}, cloud_frame_};
  if (running_frame_.empty()) return std::nullopt;
  const FrameHead head{
      FrameKind::kLines,  picture_.number, count(picture_.lines), count(picture_.beams), 0,
      count(rows_so_far_)};
  std::string frame = running_frame_.substr(0, sizeof head + head.points() * sizeof(PackedPoint));
  std::memcpy(frame.data(), &head, sizeof head);
  return binary_frame(std::move(frame));
}

}  // namespace swivel
