#include "components/swivel/recorder/topics_named.hpp"

#include "components/common/program.hpp"

namespace swivel {

std::vector<AnyTopic> topics_named(const std::vector<std::string>& names, const std::string& rig) {
  if (names.empty()) return all_topics();
  std::vector<AnyTopic> named;
  for (const std::string& name : names) {
    const std::size_t before = named.size();
    std::string known;
    for (const AnyTopic& topic : all_topics()) {
      if (name == topic.name || name == topic.full_name(rig)) named.push_back(topic);
      known += std::string(known.empty() ? "" : ", ") + topic.name;
    }
    if (named.size() == before) {
      throw ExitError(kExitUsage, "rig '" + rig + "' has no topic " + name + "; it has " + known);
    }
  }
  return named;
}

}  // namespace swivel
