// swivel export: a cloud of a recording as a file that other programs open.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "components/common/cloud_message.hpp"
#include "components/common/program.hpp"
#include "components/mcap/reader.hpp"
#include "components/recording/mcap_recording.hpp"
#include "components/swivel/offline/cloud_files.hpp"
#include "components/swivel/offline/text_file.hpp"
#include "components/swivel/recorder/timed_cloud_files.hpp"
#include "components/swivel/recorder/topics_named.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

struct ExportOptions {
  std::string recording;
  std::string output;
  std::string topic = "cloud";
  int number = 0;  // counted from 1; 0: the last
};

struct RecordedCloud {
  OrganisedCloud cloud;
  std::int64_t stamp_ns = 0;
  int number = 0;
};

// The messages of one topic, as long as `take` wants more.
template <class Message, class Take>
void read_topic(const ExportOptions& options, const std::string& topic, Take take) {
  auto reader = McapReader::open(options.recording);
  if (!reader) throw ExitError(kExitBadData, reader.reason());
  while (const auto raw = reader->next()) {
    if (reader->channel(raw->channel_id).topic != topic) continue;
    const auto message = decode_cdr<Message>(raw->data);
    if (!message) throw ExitError(kExitBadData, "a message of " + topic + " cannot be decoded");
    if (!take(*message)) return;
  }
}

RecordedCloud find_cloud(const ExportOptions& options, const std::string& topic) {
  RecordedCloud found;
  int number = 0;
  read_topic<PointCloud2>(options, topic, [&](const PointCloud2& message) {
    if (++number < options.number) return true;
    const std::string wrong = from_message(message, found.cloud);
    if (!wrong.empty())
      throw ExitError(kExitBadData, "cloud " + std::to_string(number) + ": " + wrong);
    found.stamp_ns = stamp_ns(message);
    found.number = number;
    return options.number == 0;
  });
  if (found.number > 0) return found;
  throw ExitError(kExitBadData, options.recording + " has " + std::to_string(number) +
                                    " messages of " + topic + ", and not the one asked for");
}

// The line that the cloud begins with tells the periods.
PointTimes times_of(const ExportOptions& options, const std::string& topic,
                    const RecordedCloud& cloud) {
  PointTimes times{cloud.stamp_ns, 0.0, 0.0};
  read_topic<msg::ScanLine>(options, topic, [&](const msg::ScanLine& line) {
    if (line.beam0_time_ns() != cloud.stamp_ns) return true;
    times.line_period_ns = line.scan_period_ns();
    times.beam_period_ns = line.beam_period_ns();
    return false;
  });
  if (!(times.line_period_ns > 0.0 && times.line_period_ns < 1e9 && times.beam_period_ns > 0.0 &&
        times.beam_period_ns < 1e9)) {
    std::cerr << "the cloud's scan lines are not in the recording: its points get its stamp\n";
    times.line_period_ns = times.beam_period_ns = 0.0;
  }
  return times;
}

int export_cloud(const ExportOptions& options) {
  const auto rig = rig_in_mcap(options.recording);
  if (!rig) throw ExitError(kExitBadData, rig.reason());
  const AnyTopic topic = topics_named({options.topic}, *rig).front();
  if (!topic.for_ros) throw ExitError(kExitUsage, options.topic + " has no clouds");
  const RecordedCloud found = find_cloud(options, topic.full_name(*rig));
  const std::string kind = std::filesystem::path(options.output).extension();
  if (kind == ".pcd") {
    require_written(write_pcd(options.output, found.cloud));
  } else if (kind == ".ply") {
    const auto written = write_ply(options.output, found.cloud);
    if (!written) throw ExitError(kExitInputOutput, written.reason());
  } else {
    const PointTimes times = times_of(options, kScanLineTopic.full_name(*rig), found);
    write_text_file(options.output,
                    kind == ".las" ? las_bytes(found.cloud, times) : csv_text(found.cloud, times));
  }
  std::cout << "cloud " << found.number << ", " << found.cloud.lines << " lines of "
            << found.cloud.beams << " beams, is in " << options.output << '\n';
  return kExitOk;
}

std::string check_ending(const std::string& path) {
  const std::string kind = std::filesystem::path(path).extension();
  for (const char* known : {".pcd", ".ply", ".las", ".csv"}) {
    if (kind == known) return "";
  }
  return "the name must end in .pcd, .ply, .las or .csv";
}

}  // namespace

void add_export(CLI::App& app, Verb& chosen) {
  CLI::App* const verb =
      app.add_subcommand("export", "A recorded cloud as PCD, PLY, LAS 1.2 or CSV");
  const auto options = std::make_shared<ExportOptions>();
  verb->add_option("recording", options->recording, "An .mcap file")->required();
  verb->add_option("-o,--output", options->output, "FILE.pcd, .ply, .las or .csv")
      ->required()
      ->check(CLI::Validator(check_ending, "", ""));
  verb->add_option("--topic", options->topic, "cloud or raw_cloud")->capture_default_str();
  verb->add_option("--number", options->number, "Which of its clouds, from 1; else the last")
      ->check(CLI::Range(1, 1000000));
  verb->callback([=, &chosen] { chosen = [=] { return export_cloud(*options); }; });
}

}  // namespace swivel
