#include "tests/calibration/plate_case.hpp"

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "calibration/line_assembly.hpp"

namespace swivel {
namespace {

using Values = std::map<std::string, std::string>;

Values read_values(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  Values values;
  for (std::string line; std::getline(file, line);) {
    const auto comma = line.find(',');
    if (comma != std::string::npos) values[line.substr(0, comma)] = line.substr(comma + 1);
  }
  return values;
}

double number(const Values& values, const std::string& key) {
  return std::stod(values.at(key));
}

std::vector<double> numbers(const Values& values, const std::string& key) {
  std::istringstream text(values.at(key));
  std::vector<double> list;
  for (double value = 0.0; text >> value;) list.push_back(value);
  return list;
}

ForwardModel model_of(const Values& meta) {
  RigGeometry rig;
  rig.T_axis_lidar.translation().x() = number(meta, "axis_offset_m");
  return {rig, rad_from_deg(number(meta, "first_deg")), rad_from_deg(number(meta, "step_deg")),
          static_cast<std::size_t>(number(meta, "n_beams"))};
}

std::vector<std::uint16_t> read_line(std::ifstream& file, std::size_t beams) {
  std::vector<unsigned char> bytes(2 * beams);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw std::runtime_error("ranges.u16 is too short");
  std::vector<std::uint16_t> line(beams);
  for (std::size_t beam = 0; beam < beams; ++beam) {
    line[beam] = static_cast<std::uint16_t>(bytes[2 * beam] + 256 * bytes[2 * beam + 1]);
  }
  return line;
}

OrganisedCloud read_cloud(std::ifstream& file, const Values& meta, std::size_t lines,
                          double speed_rad_s, double period_s) {
  LineAssembler assembler(model_of(meta));
  OrganisedCloud cloud(lines, assembler.model().beam_count());
  const double angle_per_line_rad = speed_rad_s * period_s;
  const double angle_per_beam_rad = angle_per_line_rad / number(meta, "steps_per_rev");
  const auto min_mm = static_cast<std::uint16_t>(mm_from_m(number(meta, "range_min_m")));
  const auto max_mm = static_cast<std::uint16_t>(mm_from_m(number(meta, "range_max_m")));
  for (std::size_t line = 0; line < lines; ++line) {
    const auto ranges_mm = read_line(file, cloud.beams);
    assembler.assemble({ranges_mm, {}, min_mm, max_mm},
                       static_cast<double>(line) * angle_per_line_rad, angle_per_beam_rad,
                       cloud.line(line));
  }
  return cloud;
}

}  // namespace

PlateCase load_plate_case(const std::string& folder) {
  const Values meta = read_values(folder + "/meta.csv");
  const Values truth = read_values(folder + "/truth.csv");
  std::ifstream ranges(folder + "/ranges.u16", std::ios::binary);
  const auto modes = numbers(meta, "modes");
  const auto lines = numbers(meta, "lines_per_sweep");
  const auto speeds_deg_s = numbers(meta, "motor_speed_deg_s");
  PlateCase result{rad_from_deg(number(truth, "alpha_deg")), {}};
  for (std::size_t sweep = 0; sweep < modes.size(); ++sweep) {
    const std::string prefix = "sweep" + std::to_string(sweep);
    result.sweeps.push_back(
        {static_cast<int>(modes[sweep]),
         read_cloud(ranges, meta, static_cast<std::size_t>(lines[sweep]),
                    rad_from_deg(speeds_deg_s[sweep]), number(truth, prefix + "_period_s")),
         rad_from_deg(number(truth, prefix + "_phi_start_deg"))});
  }
  return result;
}

}  // namespace swivel
