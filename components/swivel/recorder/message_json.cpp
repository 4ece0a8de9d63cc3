#include "components/swivel/recorder/message_json.hpp"

#include <string>

#include "components/common/phase_word.hpp"

namespace swivel {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const msg::ScanLine& line) {
  return {{"rig", line.rig().to_string()},
          {"sequence_number", line.sequence_number()},
          {"beam0_time_ns", line.beam0_time_ns()},
          {"arrival_time_ns", line.arrival_time_ns()},
          {"device_stamp_ms", line.device_stamp_ms()},
          {"first_beam_angle_deg", line.first_beam_angle_deg()},
          {"beam_step_deg", line.beam_step_deg()},
          {"beam_period_ns", line.beam_period_ns()},
          {"scan_period_ns", line.scan_period_ns()},
          {"range_min_mm", line.range_min_mm()},
          {"range_max_mm", line.range_max_mm()},
          {"ranges_mm", line.ranges_mm()},
          {"intensities", line.intensities()}};
}

Json to_json(const msg::Axis& axis) {
  Json samples = Json::array();
  for (const msg::AxisSample& sample : axis.samples()) {
    samples.push_back({{"time_ns", sample.time_ns()}, {"angle_deg", sample.angle_deg()}});
  }
  return {{"rig", axis.rig().to_string()},
          {"sequence_number", axis.sequence_number()},
          {"source", axis.source() == msg::AXIS_MEASURED ? "measured" : "commanded"},
          {"samples", samples}};
}

Json to_json(const msg::Sweep& sweep) {
  return {{"rig", sweep.rig().to_string()},
          {"sequence_number", sweep.sequence_number()},
          {"time_ns", sweep.time_ns()},
          {"request_id", sweep.request_id()},
          {"sweep_id", sweep.sweep_id()},
          {"phase", phase_word(sweep.phase())},
          {"mode", sweep.mode()},
          {"action_sequence", static_cast<int>(sweep.action_sequence())},
          {"speed_deg_s", sweep.speed_deg_s()},
          {"lines_expected", sweep.lines_expected()},
          {"window_start_ns", sweep.window_start_ns()},
          {"window_end_ns", sweep.window_end_ns()},
          {"window_first_line", sweep.window_first_line()},
          {"window_lines", sweep.window_lines()},
          {"sweeps_left", sweep.sweeps_left()},
          {"first_beam_time_ns", sweep.first_beam_time_ns()},
          {"first_device_stamp_ms", sweep.first_device_stamp_ms()},
          {"lines_used", sweep.lines_used()},
          {"lines_missing", sweep.lines_missing()},
          {"complete", sweep.complete()},
          {"reason", sweep.reason()}};
}

Json to_json(const msg::SweepRequest& request) {
  return {{"rig", request.rig().to_string()},
          {"sequence_number", request.sequence_number()},
          {"request_id", request.request_id()},
          {"mode", request.mode()},
          {"count", request.count()},
          {"action_sequence", static_cast<int>(request.action_sequence())},
          {"cancel", request.cancel()}};
}

Json to_json(const msg::Attitude& attitude) {
  return {{"rig", attitude.rig().to_string()},
          {"sequence_number", attitude.sequence_number()},
          {"sweep_id", attitude.sweep_id()},
          {"first_beam_time_ns", attitude.first_beam_time_ns()},
          {"first_device_stamp_ms", attitude.first_device_stamp_ms()},
          {"mode", attitude.mode()},
          {"estimator", attitude.estimator().to_string()},
          {"verdict", static_cast<int>(attitude.verdict())},
          {"reason", attitude.reason()},
          {"beta_deg", attitude.beta_deg()},
          {"beta_sigma_deg", attitude.beta_sigma_deg()},
          {"alpha_deg", attitude.alpha_deg()},
          {"phi_offset_deg", attitude.phi_offset_deg()},
          {"phi_offset_sigma_deg", attitude.phi_offset_sigma_deg()},
          {"points_used", attitude.points_used()},
          {"edges_used", attitude.edges_used()},
          {"residual_mm", attitude.residual_mm()},
          {"seam_deg", attitude.seam_deg()},
          {"seam_sigma_deg", attitude.seam_sigma_deg()},
          {"lines_expected", attitude.lines_expected()},
          {"lines_missing", attitude.lines_missing()},
          {"calibrated", attitude.calibrated()},
          {"warning", attitude.warning()}};
}

Json to_json(const msg::Calibration& calibration) {
  return {{"rig", calibration.rig().to_string()},
          {"sequence_number", calibration.sequence_number()},
          {"time_ns", calibration.time_ns()},
          {"alpha_deg", calibration.alpha_deg()},
          {"bias_deg", calibration.bias_deg()},
          {"mounting_xyz_mm", calibration.mounting_xyz_mm()},
          {"mounting_rpy_deg", calibration.mounting_rpy_deg()},
          {"hysteresis_deg", calibration.hysteresis_deg()},
          {"hysteresis_sigma_deg", calibration.hysteresis_sigma_deg()},
          {"covariance", calibration.covariance()},
          {"residual_deg", calibration.residual_deg()},
          {"chi_square", calibration.chi_square()},
          {"degrees_of_freedom", calibration.degrees_of_freedom()},
          {"plate_shape", calibration.plate_shape()},
          {"plate_shape_sigma", calibration.plate_shape_sigma()},
          {"plate_residual_mm", calibration.plate_residual_mm()},
          {"sweeps_used", calibration.sweeps_used()},
          {"mode", calibration.mode()},
          {"serial_number", calibration.serial_number()},
          {"firmware", calibration.firmware()},
          {"provenance", calibration.provenance()}};
}

Json to_json(const msg::CalibrationRequest& request) {
  return {
      {"rig", request.rig().to_string()},         {"sequence_number", request.sequence_number()},
      {"request_id", request.request_id()},       {"mode", request.mode()},
      {"kind", static_cast<int>(request.kind())}, {"count", request.count()},
      {"room_yaw_deg", request.room_yaw_deg()}};
}

Json to_json(const msg::CalibrationProgress& progress) {
  return {
      {"rig", progress.rig().to_string()},         {"sequence_number", progress.sequence_number()},
      {"request_id", progress.request_id()},       {"state", static_cast<int>(progress.state())},
      {"sweeps_used", progress.sweeps_used()},     {"sweeps_left_out", progress.sweeps_left_out()},
      {"sweeps_wanted", progress.sweeps_wanted()}, {"words", progress.words()}};
}

Json to_json(const msg::Health& health) {
  Json counters = Json::object();
  for (const auto& counter : health.counters()) {
    counters[counter.name().to_string()] = counter.value();
  }
  Json facts = Json::object();
  for (const auto& fact : health.facts()) facts[fact.name().to_string()] = fact.value();
  return {{"rig", health.rig().to_string()},
          {"participant", health.participant().to_string()},
          {"sequence_number", health.sequence_number()},
          {"time_ns", health.time_ns()},
          {"started_time_ns", health.started_time_ns()},
          {"process_id", health.process_id()},
          {"host", health.host()},
          {"state", static_cast<int>(health.state())},
          {"doing", health.doing()},
          {"last_error", health.last_error()},
          {"last_error_time_ns", health.last_error_time_ns()},
          {"counters", counters},
          {"facts", facts}};
}

Json to_json(const PointCloud2& cloud) {
  Json fields = Json::array();
  for (const PointField& field : cloud.fields()) fields.push_back(field.name());
  return {{"sec", cloud.header().stamp().sec()},
          {"nanosec", cloud.header().stamp().nanosec()},
          {"frame_id", cloud.header().frame_id()},
          {"height", cloud.height()},
          {"width", cloud.width()},
          {"fields", fields},
          {"point_step", cloud.point_step()},
          {"data_bytes", cloud.data().size()}};
}

const char* word_for(msg::WireKind kind) {
  switch (kind) {
    case msg::WIRE_OPENED:
      return "opened";
    case msg::WIRE_TO_DEVICE:
      return "to_device";
    case msg::WIRE_FROM_DEVICE:
      return "from_device";
    case msg::WIRE_HUNG_UP:
      return "hung_up";
    case msg::WIRE_CLOSED:
      return "closed";
  }
  return "unknown";
}

// Both languages are text, but for a few bytes.
Json to_json(const msg::WireBytes& wire) {
  return {{"rig", wire.rig().to_string()},
          {"sequence_number", wire.sequence_number()},
          {"device", wire.device() == msg::WIRE_OF_LIDAR ? "lidar" : "stepper"},
          {"kind", word_for(wire.kind())},
          {"time_ns", wire.time_ns()},
          {"opened_time_ns", wire.opened_time_ns()},
          {"offset", wire.offset()},
          {"bytes", std::string(wire.bytes().begin(), wire.bytes().end())}};
}

template <class Message>
bool put(const AnyTopic& topic, const Topic<Message>& wanted, std::string_view cdr,
         std::optional<Json>& json) {
  if (!topic.is(wanted)) return false;
  if (const auto message = decode_cdr<Message>(cdr)) json = to_json(*message);
  return true;
}

template <class... Topics>
std::optional<Json> first_of(const AnyTopic& topic, std::string_view cdr, const Topics&... topics) {
  std::optional<Json> json;
  (put(topic, topics, cdr, json) || ...);
  return json;
}

}  // namespace

std::optional<nlohmann::ordered_json> message_json(const AnyTopic& topic, std::string_view cdr) {
  return first_of(topic, cdr, kScanLineTopic, kAxisTopic, kSweepTopic, kSweepRequestTopic,
                  kRawCloudTopic, kCloudTopic, kAttitudeTopic, kCalibrationTopic,
                  kCalibrationRequestTopic, kCalibrationProgressTopic, kHealthTopic, kWireTopic);
}

}  // namespace swivel
