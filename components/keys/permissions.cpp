#include "components/keys/permissions.hpp"

#include <time.h>

#include <algorithm>
#include <array>

#include "components/common/strict_yaml.hpp"
#include "components/dds/any_topic.hpp"

namespace swivel {
namespace {

// The name becomes that of a folder and of a certificate.
void check_name(const YamlSection& file, const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
  if (name.empty() || !plain) file.refuse(name, "is no participant: a name has a-z, 0-9 and _");
}

std::vector<std::string> read_topics(YamlSection& section, const std::string& key) {
  std::vector<std::string> names = section.texts(key);
  for (const std::string& name : names) {
    const auto& topics = all_topics();
    const bool known = std::any_of(topics.begin(), topics.end(),
                                   [&](const AnyTopic& topic) { return name == topic.name; });
    if (!known) section.refuse(key, "names '" + name + "', which is no topic");
  }
  return names;
}

std::string date_and_time(std::int64_t since_1970_s) {
  const time_t seconds = since_1970_s;
  tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &utc);
  return text.data();
}

std::string topics_element(const std::string& element, const std::vector<std::string>& names,
                           const std::string& rig) {
  if (names.empty()) return {};
  std::string text = "        <" + element + "><topics>\n";
  for (const AnyTopic& topic : all_topics()) {
    if (std::find(names.begin(), names.end(), topic.name) == names.end()) continue;
    text += "          <topic>" + topic.full_name(rig) + "</topic>\n";
  }
  return text + "        </topics></" + element + ">\n";
}

}  // namespace

std::vector<Grant> load_grants(const std::string& path) {
  YamlSection file = YamlSection::load(path);
  std::vector<Grant> grants;
  for (const std::string& name : file.keys()) {
    check_name(file, name);
    YamlSection section = file.section(name);
    grants.push_back({name, read_topics(section, "writes"), read_topics(section, "reads")});
    section.finish();
  }
  return grants;
}

std::string permissions_document(const Grant& grant, const std::string& rig, ValidFor validity) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\"\n"
         "     xsi:noNamespaceSchemaLocation=\"http://www.omg.org/spec/DDS-SECURITY/20170901/"
         "omg_shared_ca_permissions.xsd\">\n"
         "  <permissions>\n"
         "    <grant name=\"" +
         grant.participant +
         "\">\n"
         "      <subject_name>CN=" +
         grant.participant +
         "</subject_name>\n"
         "      <validity>\n"
         "        <not_before>" +
         date_and_time(validity.from_s) +
         "</not_before>\n"
         "        <not_after>" +
         date_and_time(validity.to_s) +
         "</not_after>\n"
         "      </validity>\n"
         "      <allow_rule>\n"
         "        <domains><id_range><min>0</min><max>232</max></id_range></domains>\n" +
         topics_element("publish", grant.writes, rig) +
         topics_element("subscribe", grant.reads, rig) +
         "      </allow_rule>\n"
         "      <default>DENY</default>\n"
         "    </grant>\n"
         "  </permissions>\n"
         "</dds>\n";
}

}  // namespace swivel
