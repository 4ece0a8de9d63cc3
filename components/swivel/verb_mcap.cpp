// swivel info, check, recover, slice: of MCAP files.
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "components/common/json_text.hpp"
#include "components/common/program.hpp"
#include "components/mcap/whole_file.hpp"
#include "components/swivel/recorder/copy_recording.hpp"
#include "components/swivel/recorder/overview.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

struct McapOptions {
  std::string path;
  std::string output;
  bool json = false;
  TimeWindow window;
  std::vector<std::string> topics;
};

void require_file(const std::string& path) {
  if (!std::filesystem::exists(path)) {
    throw ExitError(kExitNoInput, path + ": there is no such file");
  }
}

Overview overview_of(const std::string& path) {
  require_file(path);
  auto overview = look_at(path);
  if (!overview) throw ExitError(kExitBadData, overview.reason());
  return std::move(*overview);
}

int info(const McapOptions& options) {
  const Overview overview = overview_of(options.path);
  if (options.json) {
    std::cout << json_text(overview_json(overview), 2) << '\n';
  } else {
    std::cout << overview_in_words(overview);
  }
  return kExitOk;
}

void print_damage(const McapDamage& damage) {
  for (const std::string& reason : damage.reasons) std::cout << reason << '\n';
  if (damage.damaged_chunks + damage.lost_messages + damage.skipped_bytes == 0) return;
  std::cout << damage.damaged_chunks << " chunks damaged, " << damage.lost_messages
            << " messages not readable, " << damage.skipped_bytes << " bytes skipped\n";
}

int check(const McapOptions& options) {
  const Overview overview = overview_of(options.path);
  std::cout << overview_in_words(overview);
  print_damage(overview.damage);
  const Outcome sums = check_file_sums(options.path);
  if (!sums) std::cout << sums.reason() << '\n';
  const bool good = sums && overview.damage.none() && overview.missing() == 0;
  std::cout << (good ? "all sums are right, and no sequence number is missing\n"
                     : "not all is there, or as it was written\n");
  return good ? kExitOk : kExitBadData;
}

Copied copy(const McapOptions& options) {
  require_file(options.path);
  const auto copied = copy_recording(options.path, options.output, options.window, options.topics);
  if (!copied) throw ExitError(kExitCannotWrite, copied.reason());
  print_damage(copied->damage);
  std::cout << copied->messages << " messages are in " << options.output << '\n';
  return *copied;
}

int recover(const McapOptions& options) {
  return copy(options).messages > 0 ? kExitOk : kExitBadData;
}

int slice(const McapOptions& options) {
  const Copied copied = copy(options);
  return copied.messages > 0 && copied.damage.none() ? kExitOk : kExitBadData;
}

CLI::App& add_verb(CLI::App& app, const char* name, const char* purpose,
                   int (*run)(const McapOptions&), const std::shared_ptr<McapOptions>& options,
                   Verb& chosen) {
  CLI::App* const verb = app.add_subcommand(name, purpose);
  verb->add_option("file", options->path, "An .mcap file, or an .mcap.part")->required();
  verb->callback([=, &chosen] { chosen = [=] { return run(*options); }; });
  return *verb;
}

}  // namespace

void add_mcap_verbs(CLI::App& app, Verb& chosen) {
  const auto options = std::make_shared<McapOptions>();
  add_verb(app, "info", "What an MCAP file holds", info, options, chosen)
      .add_flag("--json", options->json, "As JSON");
  add_verb(app, "check", "Sums, gaps and sequence numbers of an MCAP file", check, options, chosen);
  add_verb(app, "recover", "What is sound of a cut or damaged MCAP file", recover, options, chosen)
      .add_option("-o,--output", options->output, "The new file")
      ->required();
  CLI::App& slicing = add_verb(app, "slice", "A part of an MCAP file", slice, options, chosen);
  slicing.add_option("-o,--output", options->output, "The new file")->required();
  slicing.add_option("--from", options->window.from_s, "Seconds after its first message");
  slicing.add_option("--to", options->window.to_s, "Seconds after its first message");
  slicing.add_option("--topics", options->topics, "By full name; else all");
}

}  // namespace swivel
