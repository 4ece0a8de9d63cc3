#include "components/swivel/recorder/topics_named.hpp"

#include <algorithm>
#include <iterator>

#include "components/common/program.hpp"

namespace swivel {

std::vector<AnyTopic> topics_named(const std::vector<std::string>& names, const std::string& rig) {
  std::vector<AnyTopic> named;
  if (names.empty()) {
    // To listen to the wires doubles what the reader sends.
    std::copy_if(all_topics().begin(), all_topics().end(), std::back_inserter(named),
                 [](const AnyTopic& topic) { return !topic.is(kWireTopic); });
  }
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
