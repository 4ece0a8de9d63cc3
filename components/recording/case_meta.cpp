#include "components/recording/case_meta.hpp"

#include <limits>
#include <map>
#include <utility>

#include "components/recording/gzip_lines.hpp"
#include "components/recording/recording_plan.hpp"
#include "components/recording/text.hpp"

namespace swivel {
namespace {

constexpr double kMostBeamsOfACase = 20000;
constexpr double kMostSweeps = 10000;
constexpr double kMostLinesOfACase = 1e6;

// The keys and values of the file. The first thing found wrong is kept; what is read after it
// is of no use and is thrown away with it.
class MetaTable {
 public:
  explicit MetaTable(std::string path) : path_(std::move(path)) {}

  Outcome load();
  bool has(const std::string& key) const { return values_.count(key) != 0; }
  std::string text(const std::string& key);
  double number(const std::string& key, double least, double most);
  // As many numbers as there are sweeps, separated by spaces.
  std::vector<double> numbers(const std::string& key, std::size_t count, double least, double most);

  void refuse(const std::string& key, const std::string& reason) {
    if (reason_.empty()) reason_ = path_ + ": " + key + ": " + reason;
  }
  const std::string& reason() const { return reason_; }

 private:
  std::string path_;
  std::map<std::string, std::string> values_;
  std::string reason_;
};

Outcome MetaTable::load() {
  auto lines = GzipLines::open(path_);
  if (!lines) return Failure{lines.reason()};
  while (true) {
    const auto line = lines->next();
    if (!line) return Failure{line.reason()};
    if (!line->has_value()) return Done{};
    if ((*line)->empty()) continue;
    const auto comma = (*line)->find(',');
    if (comma == std::string_view::npos) return lines->failure("expected `key,value`");
    const std::string key((*line)->substr(0, comma));
    if (!values_.emplace(key, (*line)->substr(comma + 1)).second)
      return lines->failure("the key " + key + " stands here a second time");
  }
}

std::string MetaTable::text(const std::string& key) {
  const auto found = values_.find(key);
  if (found != values_.end()) return found->second;
  refuse(key, "the key is missing");
  return {};
}

double MetaTable::number(const std::string& key, double least, double most) {
  const auto number = parse_number<double>(text(key), least, most);
  if (!number)
    refuse(key, "must be a number from " + std::to_string(least) + " to " + std::to_string(most));
  return number.value_or(least);
}

std::vector<double> MetaTable::numbers(const std::string& key, std::size_t count, double least,
                                       double most) {
  const std::string words = text(key);
  std::vector<double> numbers;
  for (const std::string_view word : split(words, ' ')) {
    const auto number = parse_number<double>(word, least, most);
    if (!number) {
      refuse(key, "every value must be a number from " + std::to_string(least) + " to " +
                      std::to_string(most));
    }
    numbers.push_back(number.value_or(least));
  }
  if (numbers.size() != count)
    refuse(key, "must have a value for each of the " + std::to_string(count) + " sweeps");
  numbers.resize(count, least);
  return numbers;
}

void read_lidar(MetaTable& table, CaseMeta& meta) {
  meta.beams = static_cast<std::size_t>(table.number("n_beams", 2, kMostBeamsOfACase));
  meta.first_beam_angle_deg = table.number("first_deg", -360.0, 360.0);
  meta.beam_step_deg = table.number("step_deg", -10.0, 10.0);
  meta.nominal_period_s = table.number("period_s", 1e-3, 10.0);
  meta.steps_per_turn = table.number("steps_per_rev", static_cast<double>(meta.beams), 1e6);
  meta.range_min_m = table.number("range_min_m", 0.0, 65.0);
  meta.range_max_m = table.number("range_max_m", meta.range_min_m, 65.0);
}

RecordingFacts::Plate read_plate(MetaTable& table) {
  RecordingFacts::Plate plate;
  plate.lever_arm_m = table.number("axis_offset_m", -1.0, 1.0);
  plate.base_distance_m = table.number("plate_base_m", 1e-3, 1.0);
  plate.hypotenuse_m = table.number("plate_hypotenuse_m", 1e-3, 1.0);
  plate.depth_m = table.number("plate_depth_nominal_m", 1e-3, 1.0);
  plate.alpha_deg = table.number("alpha_nominal_deg", -360.0, 360.0);
  plate.room_yaw_deg = table.number("room_yaw_nominal_deg", -360.0, 360.0);
  return plate;
}

void read_sweeps(MetaTable& table, CaseMeta& meta) {
  const auto count = static_cast<std::size_t>(table.number("sweeps", 1, kMostSweeps));
  const auto lines = table.numbers("lines_per_sweep", count, 1, kMostLinesOfACase);
  meta.sweeps.resize(count);
  for (std::size_t sweep = 0; sweep < count; ++sweep) {
    meta.sweeps[sweep].lines = static_cast<std::uint32_t>(lines[sweep]);
    if (!fits_in_memory(meta.sweeps[sweep].lines, meta.beams))
      table.refuse("lines_per_sweep", "so many points to a sweep are too many");
  }
}

void read_plate_sweeps(MetaTable& table, CaseMeta& meta) {
  const auto modes = table.numbers("modes", meta.sweeps.size(), 0, 255);
  const auto speeds = table.numbers("motor_speed_deg_s", meta.sweeps.size(), -1e4, 1e4);
  for (std::size_t sweep = 0; sweep < meta.sweeps.size(); ++sweep) {
    meta.sweeps[sweep].mode = static_cast<std::uint8_t>(modes[sweep]);
    meta.sweeps[sweep].speed_deg_s = speeds[sweep];
  }
  const std::string sequence = table.text("sequence");
  meta.naive = sequence == "naive";
  if (!meta.naive && sequence != "improved") table.refuse("sequence", "must be improved or naive");
}

void read_pan_sweeps(MetaTable& table, CaseMeta& meta) {
  const auto turns = table.numbers("turn_deg", meta.sweeps.size(), -36000.0, 36000.0);
  for (std::size_t sweep = 0; sweep < meta.sweeps.size(); ++sweep) {
    const double lines = static_cast<double>(meta.sweeps[sweep].lines);
    meta.sweeps[sweep].speed_deg_s = turns[sweep] / (lines * meta.nominal_period_s);
  }
}

}  // namespace

Result<CaseMeta> read_case_meta(const std::string& path) {
  MetaTable table(path);
  if (const Outcome loaded = table.load(); !loaded) return Failure{loaded.reason()};
  CaseMeta meta;
  read_lidar(table, meta);
  read_sweeps(table, meta);
  const std::string rig = table.text("rig");
  if (rig == "plate") {
    meta.plate = read_plate(table);
    read_plate_sweeps(table, meta);
  } else if (rig == "pan") {
    read_pan_sweeps(table, meta);
  } else {
    table.refuse("rig", "must be plate or pan");
  }
  if (!table.reason().empty()) return Failure{table.reason()};
  return meta;
}

}  // namespace swivel
