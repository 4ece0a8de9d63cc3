// swivel ls, hz, bw, delay, echo: of live topics and of recordings alike.
#include <fmt/core.h>
#include <unistd.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>

#include <iostream>
#include <memory>

#include "components/common/json_text.hpp"
#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/mcap/reader.hpp"
#include "components/recording/mcap_recording.hpp"
#include "components/swivel/recorder/channels.hpp"
#include "components/swivel/recorder/message_json.hpp"
#include "components/swivel/recorder/topic_statistics.hpp"
#include "components/swivel/recorder/topics_named.hpp"
#include "components/swivel/verbs.hpp"
#include "hardware/io/clock.hpp"

namespace swivel {
namespace {

struct TopicVerbOptions {
  CommonOptions common;
  std::vector<std::string> what;  // an .mcap file, then topics
  double for_s = 3.0;             // how long to listen
  bool json = false;
};

using OnHeard =
    std::function<void(const AnyTopic& topic, const Heard& heard, std::string_view cdr)>;

Heard heard_of(const McapChannel& channel, const McapMessage& message) {
  const auto participant = channel.metadata.find(kParticipantKey);
  return {channel.topic,
          channel.schema.name,
          participant == channel.metadata.end() ? "" : participant->second,
          message.log_time_ns,
          message.publish_time_ns,
          message.data.size()};
}

// What is no topic of ours is left out: nothing could be said of it but its size.
int listen_to_file(const TopicVerbOptions& options, StopSignal& stop, const OnHeard& on_heard) {
  const std::string& path = options.what.front();
  const std::vector<std::string> names(options.what.begin() + 1, options.what.end());
  const auto rig = rig_in_mcap(path);
  if (!rig) throw ExitError(kExitBadData, rig.reason());
  std::map<std::string, AnyTopic> topics;
  for (const AnyTopic& topic : topics_named(names, *rig)) {
    topics.emplace(topic.full_name(*rig), topic);
  }
  auto reader = McapReader::open(path);
  if (!reader) throw ExitError(kExitBadData, reader.reason());
  while (const auto message = reader->next()) {
    if (stop.received()) break;
    const McapChannel& channel = reader->channel(message->channel_id);
    const auto topic = topics.find(channel.topic);
    if (topic == topics.end()) continue;
    on_heard(topic->second, heard_of(channel, *message), message->data);
  }
  if (reader->damage().none() || stop.received()) return kExitOk;
  std::cerr << path << " is not whole; see: swivel check\n";
  return kExitBadData;
}

int listen_live(const TopicVerbOptions& options, StopSignal& stop, const OnHeard& on_heard) {
  const RigFile rig = load_rig_file(options.common.rig_file);
  const auto topics = topics_named(options.what, rig.rig);
  Participant participant(options.common.participant("swivel_listener", rig.rig));
  std::uint64_t count = 0;
  for (const AnyTopic& topic : topics) {
    const std::string type = topic.make_type()->getName();
    participant.subscribe_cdr(topic, [&, name = topic.full_name(rig.rig),
                                      type](CdrSample&& sample) {
      ++count;
      on_heard(topic,
               {name, type, sample.participant, now_ns(), sample.sent_time_ns, sample.cdr.size()},
               sample.cdr);
    });
  }
  participant.start();
  stop.wait_for(std::chrono::milliseconds(std::llround(options.for_s * 1e3)));
  participant.stop();
  if (count > 0) return kExitOk;
  throw ExitError(kExitUnavailable, "nothing was heard of rig '" + rig.rig + "' in domain " +
                                        std::to_string(options.common.domain) +
                                        "; is it up? listen longer with --for-s");
}

int listen(const TopicVerbOptions& options, StopSignal& stop, const OnHeard& on_heard) {
  start_log("swivel", "warning");
  const bool file = !options.what.empty() && is_mcap(options.what.front());
  return file ? listen_to_file(options, stop, on_heard) : listen_live(options, stop, on_heard);
}

using InWords = std::string (TopicStatistics::*)() const;

int statistics(const TopicVerbOptions& options, StopSignal& stop, InWords in_words) {
  StatisticsOfTopics topics;
  const int code =
      listen(options, stop, [&](const AnyTopic&, const Heard& heard, std::string_view) {
        topics[heard.topic].add(heard);
      });
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, topic] : topics) {
    if (options.json)
      json[name] = topic.json();
    else
      std::cout << fmt::format("{:<28} {}\n", name, (topic.*in_words)());
  }
  if (options.json) std::cout << json_text(json, 2) << '\n';
  return code;
}

// A message a line with --json, else spread out.
int echo(const TopicVerbOptions& options, StopSignal& stop) {
  std::uint64_t unreadable = 0;
  const int code =
      listen(options, stop, [&](const AnyTopic& topic, const Heard& heard, std::string_view cdr) {
        const auto message = message_json(topic, cdr);
        if (!message) ++unreadable;
        const nlohmann::ordered_json json{{"topic", heard.topic},
                                          {"time_ns", heard.time_ns},
                                          {"message", message ? *message : nullptr}};
        std::cout << json_text(json, options.json ? -1 : 2) << '\n';
      });
  if (unreadable == 0) return code;
  throw ExitError(kExitBadData, std::to_string(unreadable) + " messages could not be decoded");
}

void add_topic_verb(CLI::App& app, const char* name, const char* purpose, StopSignal& stop,
                    Verb& chosen, std::function<int(const TopicVerbOptions&, StopSignal&)> run) {
  CLI::App* const verb = app.add_subcommand(name, purpose);
  const auto options = std::make_shared<TopicVerbOptions>();
  verb->add_option("what", options->what, "An .mcap file, or nothing for the live rig; topics");
  verb->add_option("--for-s", options->for_s, "How long to listen to the live rig")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  verb->add_flag("--json", options->json, "As JSON");
  add_common_options(*verb, options->common);
  verb->callback([=, &stop, &chosen] { chosen = [=, &stop] { return run(*options, stop); }; });
}

}  // namespace

void add_topic_verbs(CLI::App& app, StopSignal& stop, Verb& chosen) {
  const auto add = [&](const char* name, const char* purpose, InWords in_words) {
    add_topic_verb(app, name, purpose, stop, chosen,
                   [in_words](const TopicVerbOptions& options, StopSignal& stop_signal) {
                     return statistics(options, stop_signal, in_words);
                   });
  };
  add("ls", "Which topics there are, live or in a file", &TopicStatistics::listed);
  add("hz", "How often messages come", &TopicStatistics::rate);
  add("bw", "How many bytes they are", &TopicStatistics::bandwidth);
  add("delay", "How long they take from their writer", &TopicStatistics::delay);
  add_topic_verb(app, "echo", "What the messages say", stop, chosen, echo);
}

}  // namespace swivel
