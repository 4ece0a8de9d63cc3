#include "components/gateway/page_messages.hpp"

#include <nlohmann/json.hpp>

#include "calibration/plate_beams.hpp"
#include "components/common/health_json.hpp"
#include "components/common/json_text.hpp"
#include "components/common/phase_word.hpp"

namespace swivel {
namespace {

using nlohmann::ordered_json;

ordered_json modes_json(const RigFile& rig) {
  ordered_json modes = ordered_json::array();
  for (const auto& [mode, lines] : rig.modes.lines)
    modes.push_back(
        {{"mode", mode}, {"lines", lines}, {"seconds", rig.modes.line_period_s * lines}});
  return modes;
}

ordered_json plate_json(const RigFile& rig) {
  if (!rig.plate) return nullptr;
  const PlateGeometry& plate = *rig.plate;
  return {{"alpha_deg", deg_from_rad(plate.alpha_rad)},
          {"base_distance_mm", mm_from_m(plate.base_distance_m)},
          {"hypotenuse_mm", mm_from_m(plate.hypotenuse_m)},
          {"height_mm", mm_from_m(plate_height_m(plate, rig.geometry))},
          {"ring_inner_mm", mm_from_m(plate.ring_inner_m)},
          {"ring_outer_mm", mm_from_m(plate.ring_outer_m)},
          {"ring_thickness_mm", mm_from_m(plate.ring_thickness_m)}};
}

ordered_json picture_json(const Picture& picture) {
  return {{"kind", word_for(picture.kind)}, {"number", picture.number},
          {"sweep_id", picture.sweep_id},   {"mode", picture.mode},
          {"lines", picture.lines},         {"lines_in", picture.lines_in},
          {"in_base", picture.in_base}};
}

ordered_json trust_json(const Picture& picture) {
  const Trust trust = trust_in(picture);
  return {{"level", word_for(trust.level)}, {"headline", trust.headline}, {"reason", trust.reason}};
}

// What is not a number becomes null.
ordered_json attitude_json(const Picture& picture) {
  if (!picture.attitude) return nullptr;
  const msg::Attitude& attitude = *picture.attitude;
  return {{"estimator", attitude.estimator().to_string()},
          {"sigma_deg", attitude.phi_offset_sigma_deg()},
          {"phi_offset_deg", attitude.phi_offset_deg()},
          {"alpha_deg", attitude.alpha_deg()},
          {"beta_deg", attitude.beta_deg()},
          {"seam_deg", attitude.seam_deg()},
          {"seam_sigma_deg", attitude.seam_sigma_deg()},
          {"points_used", attitude.points_used()},
          {"residual_mm", attitude.residual_mm()},
          {"calibrated", attitude.calibrated()},
          {"warning", attitude.warning()}};
}

ordered_json participants_json(const std::map<std::string, RollEntry>& participants) {
  ordered_json list = ordered_json::object();
  for (const auto& [name, entry] : participants) list[name] = to_json(entry);
  return list;
}

}  // namespace

std::string state_message(const RigFile& rig, const LiveView& view,
                          const std::map<std::string, RollEntry>& participants,
                          const std::string& answer) {
  const msg::Sweep& motor = view.motor();
  const ordered_json state{{"rig", rig.rig},
                           {"modes", modes_json(rig)},
                           {"plate", plate_json(rig)},
                           {"picture", picture_json(view.picture())},
                           {"trust", trust_json(view.picture())},
                           {"attitude", attitude_json(view.picture())},
                           {"motor",
                            {{"known", motor.sequence_number() != 0},
                             {"phase", phase_word(motor.phase())},
                             {"idle", motor.phase() == msg::PHASE_IDLE},
                             {"reason", motor.reason()}}},
                           {"answer", answer},
                           {"participants", participants_json(participants)}};
  return json_text(state);
}

Result<PageCommand> page_command_in(const std::string& text, const RigFile& rig) {
  const auto command = nlohmann::json::parse(text, nullptr, false);
  const auto what = command.is_object() ? command.find("do") : command.end();
  if (what == command.end() || !what->is_string()) return Failure{"no command of the page's"};
  if (*what == "cancel") return PageCommand{true, 0};
  if (*what != "scan") return Failure{"the page may ask for scan or cancel"};
  const auto mode = command.find("mode");
  const bool whole = mode != command.end() && mode->is_number_unsigned();
  const std::uint64_t number = whole ? mode->get<std::uint64_t>() : 0;
  if (number > 255 || rig.modes.lines.count(static_cast<int>(number)) == 0) {
    return Failure{"the rig has no such mode"};
  }
  return PageCommand{false, static_cast<int>(number)};
}

}  // namespace swivel
