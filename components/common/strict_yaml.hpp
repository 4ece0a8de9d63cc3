// YAML read strictly. yaml-cpp alone takes the first of two equal keys, reads 010 as 8 and
// lets unknown keys pass; here each of these is an error that names file and line.
#pragma once

#include <yaml-cpp/yaml.h>

#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace swivel {

// What cannot start because of its configuration: main prints it and exits with 78.
struct ConfigurationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Range {
  double lowest;
  double highest;
};

inline constexpr Range kAnyAngle_deg{-360.0, 360.0};

// A mapping of a YAML file. Every key asked for is remembered; finish() refuses the others.
class YamlSection {
 public:
  // Throws ConfigurationError if the file cannot be read or is not one YAML mapping.
  static YamlSection load(const std::string& path);

  bool has(const std::string& key) const;
  YamlSection section(const std::string& key);
  std::optional<YamlSection> section_if_present(const std::string& key);

  double number(const std::string& key, Range range);
  double number(const std::string& key, Range range, double when_absent);
  int integer(const std::string& key, Range range);
  int integer(const std::string& key, Range range, int when_absent);
  std::vector<double> numbers(const std::string& key, std::size_t count, Range range);
  bool flag(const std::string& key, bool when_absent);
  std::string text(const std::string& key);
  std::string text(const std::string& key, const std::string& when_absent);
  std::vector<std::string> texts(const std::string& key);  // a list
  std::string one_of(const std::string& key, const std::vector<std::string>& words);
  // For mappings whose keys are data: every key, in the order of the file.
  std::vector<std::string> keys() const;

  void finish() const;
  // An error at a key of this section, or at the section itself: "file:line: what".
  [[noreturn]] void refuse(const std::string& key, const std::string& what) const;

 private:
  YamlSection(const YAML::Node& node, std::string path, std::string name);
  YAML::Node scalar(const std::string& key);
  double parse_number(const std::string& key, const YAML::Node& node, Range range) const;
  [[noreturn]] void refuse_missing(const std::string& key) const;
  [[noreturn]] void refuse_at(const YAML::Mark& mark, const std::string& what) const;

  std::map<std::string, YAML::Node> entries_;
  std::vector<std::string> order_;
  std::set<std::string> known_;
  std::string path_;
  std::string name_;
  YAML::Mark mark_;
};

}  // namespace swivel
