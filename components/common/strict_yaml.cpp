#include "components/common/strict_yaml.hpp"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "components/common/listed.hpp"

namespace swivel {
namespace {

constexpr std::size_t kLargestFile = 1 << 20;

std::string read_whole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw ConfigurationError(path + ": cannot be read; does it exist?");
  std::string text(kLargestFile + 1, '\0');  // no more, should it be a device without an end
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw ConfigurationError(path + ": cannot be read; is it a file?");
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kLargestFile) {
    throw ConfigurationError(path + ": larger than 1 MiB; is this the right file?");
  }
  return text;
}

// yaml-cpp reads some texts of unmatched brackets without end, and remembers each step. But there
// is no more in a text than its characters can begin and end.
class EventLimit : public YAML::EventHandler {
 public:
  explicit EventLimit(std::size_t characters) : left_(4 * characters + 100) {}

  void OnDocumentStart(const YAML::Mark& mark) override { count(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnMapEnd() override {}

 private:
  void count(const YAML::Mark& mark) {
    if (left_-- == 0)
      throw YAML::ParserException(mark, "cannot be read; are all brackets and braces matched?");
  }

  std::size_t left_;
};

void require_an_end(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  EventLimit limit(text.size());
  while (parser.HandleNextDocument(limit)) {
  }
}

// "xyz_m" for "xyz_mm": the same quantity in another unit.
std::string without_unit(const std::string& key) {
  return key.substr(0, key.rfind('_'));
}

bool looks_octal(const std::string& number) {
  const std::size_t first = number.find_first_not_of("-+");
  return first != std::string::npos && first + 1 < number.size() && number[first] == '0' &&
         number[first + 1] >= '0' && number[first + 1] <= '9';
}

std::string shortest(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

YamlSection YamlSection::load(const std::string& path) {
  const std::string text = read_whole(path);
  try {
    require_an_end(text);
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty()) throw ConfigurationError(path + ":1: the file is empty");
    if (documents.size() > 1) {
      throw ConfigurationError(path + ":" + std::to_string(documents[1].Mark().line + 1) +
                               ": a second document begins; only one can be read");
    }
    return {documents[0], path, ""};
  } catch (const YAML::Exception& error) {
    throw ConfigurationError(path + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

YamlSection::YamlSection(const YAML::Node& node, std::string path, std::string name)
    : path_(std::move(path)), name_(std::move(name)), mark_(node.Mark()) {
  if (!node.IsMap()) {
    refuse_at(mark_, (name_.empty() ? "the file" : "'" + name_ + "'") +
                         " must be a mapping of keys to values");
  }
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) refuse_at(entry.first.Mark(), "a key must be a plain word");
    const std::string key = entry.first.Scalar();
    if (!entries_.emplace(key, entry.second).second) {
      refuse_at(entry.first.Mark(), "'" + key + "' stands twice");
    }
    order_.push_back(key);
  }
}

bool YamlSection::has(const std::string& key) const {
  return entries_.count(key) != 0;
}

std::vector<std::string> YamlSection::keys() const {
  return order_;
}

YamlSection YamlSection::section(const std::string& key) {
  known_.insert(key);
  if (!has(key)) refuse_at(mark_, "section '" + key + "' is missing");
  return {entries_.at(key), path_, name_.empty() ? key : name_ + "." + key};
}

std::optional<YamlSection> YamlSection::section_if_present(const std::string& key) {
  known_.insert(key);
  if (!has(key)) return std::nullopt;
  return section(key);
}

YAML::Node YamlSection::scalar(const std::string& key) {
  known_.insert(key);
  if (!has(key)) refuse_missing(key);
  const YAML::Node& node = entries_.at(key);
  if (!node.IsScalar()) refuse(key, "must be a single value");
  return node;
}

double YamlSection::parse_number(const std::string& key, const YAML::Node& node,
                                 Range range) const {
  const std::string& text = node.IsScalar() ? node.Scalar() : std::string();
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + (text[0] == '+' ? 1 : 0), end, value);
  const bool two_signs = text.substr(0, 2) == "+-";
  if (text.empty() || error != std::errc() || stop != end || two_signs || looks_octal(text) ||
      !std::isfinite(value)) {
    refuse(key, "must be a plain decimal number, not '" + text + "'");
  }
  if (value < range.lowest || value > range.highest) {
    refuse(key, "is " + text + ", outside [" + shortest(range.lowest) + ", " +
                    shortest(range.highest) + "]");
  }
  return value;
}

double YamlSection::number(const std::string& key, Range range) {
  return parse_number(key, scalar(key), range);
}

double YamlSection::number(const std::string& key, Range range, double when_absent) {
  known_.insert(key);
  return has(key) ? number(key, range) : when_absent;
}

int YamlSection::integer(const std::string& key, Range range) {
  const double value = number(key, range);
  if (value != std::floor(value)) refuse(key, "must be a whole number");
  return static_cast<int>(value);
}

int YamlSection::integer(const std::string& key, Range range, int when_absent) {
  known_.insert(key);
  return has(key) ? integer(key, range) : when_absent;
}

std::vector<double> YamlSection::numbers(const std::string& key, std::size_t count, Range range) {
  known_.insert(key);
  if (!has(key)) refuse_missing(key);
  const YAML::Node& node = entries_.at(key);
  if (!node.IsSequence() || node.size() != count) {
    refuse(key, "must be a list of " + std::to_string(count) + " numbers");
  }
  std::vector<double> values;
  for (const YAML::Node& item : node) values.push_back(parse_number(key, item, range));
  return values;
}

bool YamlSection::flag(const std::string& key, bool when_absent) {
  known_.insert(key);
  if (!has(key)) return when_absent;
  return one_of(key, {"true", "false"}) == "true";
}

std::string YamlSection::text(const std::string& key) {
  return scalar(key).Scalar();
}

std::string YamlSection::text(const std::string& key, const std::string& when_absent) {
  known_.insert(key);
  return has(key) ? text(key) : when_absent;
}

std::vector<std::string> YamlSection::texts(const std::string& key) {
  known_.insert(key);
  if (!has(key)) refuse_missing(key);
  const YAML::Node& node = entries_.at(key);
  if (!node.IsSequence()) refuse(key, "must be a list");
  std::vector<std::string> values;
  for (const YAML::Node& item : node) {
    if (!item.IsScalar()) refuse(key, "must be a list of single values");
    values.push_back(item.Scalar());
  }
  return values;
}

std::string YamlSection::one_of(const std::string& key, const std::vector<std::string>& words) {
  std::string word = text(key);
  if (std::find(words.begin(), words.end(), word) == words.end()) {
    refuse(key, "is '" + word + "', must be one of: " + listed(words));
  }
  return word;
}

void YamlSection::finish() const {
  for (const std::string& key : order_) {
    if (known_.count(key) != 0) continue;
    std::string hint;
    for (const std::string& known : known_) {
      if (without_unit(known) == without_unit(key)) hint = "; did you mean '" + known + "'?";
    }
    if (hint.empty()) {
      hint = "; known here: " + listed(known_);
    }
    refuse(key, "is not a known key" + hint);
  }
}

void YamlSection::refuse_missing(const std::string& key) const {
  for (const std::string& other : order_) {
    if (without_unit(other) == without_unit(key)) {
      refuse(other, "is not a known key; did you mean '" + key + "'?");
    }
  }
  refuse_at(mark_, "'" + key + "' is missing" + (name_.empty() ? "" : " in '" + name_ + "'"));
}

void YamlSection::refuse(const std::string& key, const std::string& what) const {
  const std::string full_name = name_.empty() ? key : name_ + "." + key;
  refuse_at(has(key) ? entries_.at(key).Mark() : mark_, "'" + full_name + "' " + what);
}

void YamlSection::refuse_at(const YAML::Mark& mark, const std::string& what) const {
  const std::string line = mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
  throw ConfigurationError(path_ + line + ": " + what);
}

}  // namespace swivel
