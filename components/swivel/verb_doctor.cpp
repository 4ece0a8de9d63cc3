// swivel doctor: what would keep a scan from working on this computer, and what to do about it.
#include <fmt/core.h>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "components/common/json_text.hpp"
#include "components/common/program.hpp"
#include "components/common/rig_file.hpp"
#include "components/common/strict_yaml.hpp"
#include "components/dds/shared_memory.hpp"
#include "components/swivel/doctor/machine.hpp"
#include "components/swivel/doctor/network.hpp"
#include "components/swivel/verbs.hpp"

namespace swivel {
namespace {

struct DoctorOptions {
  std::string lidar;    // instead of the rig file's
  std::string stepper;  // likewise
  bool json = false;
};

const char* grade_word(Grade grade) {
  switch (grade) {
    case Grade::kOk:
      return "ok";
    case Grade::kWarn:
      return "warn";
    case Grade::kBad:
      return "bad";
  }
  return "unknown";
}

bool is_serial(const std::string& address) {
  return address.rfind("/dev/", 0) == 0;
}

void check_rig(const CommonOptions& common, const DoctorOptions& options,
               std::vector<Diagnosis>& diagnoses) {
  std::optional<RigFile> rig;
  try {
    rig = load_rig_file(common.rig_file);
    diagnoses.push_back({"configuration", Grade::kOk, common.rig_file + " is sound", {}});
  } catch (const ConfigurationError& error) {
    diagnoses.push_back(
        {"configuration", Grade::kBad, error.what(), "mend it, or name another with --rig"});
  }
  const std::string lidar =
      options.lidar.empty() && rig && rig->lidar ? rig->lidar->address : options.lidar;
  const std::string stepper =
      options.stepper.empty() && rig && rig->stepper ? rig->stepper->address : options.stepper;
  if (!lidar.empty())
    diagnoses.push_back(is_serial(lidar) ? check_serial_port("lidar", lidar) : check_lidar(lidar));
  if (!stepper.empty())
    diagnoses.push_back(is_serial(stepper) ? check_serial_port("stepper", stepper)
                                           : check_stepper(stepper));
}

std::vector<Diagnosis> examine(const CommonOptions& common, const DoctorOptions& options) {
  std::vector<Diagnosis> diagnoses;
  check_rig(common, options, diagnoses);
  diagnoses.push_back(check_udp_buffer());
  if (common.discovery_server.empty()) diagnoses.push_back(check_multicast(common.network));
  diagnoses.push_back(check_shared_memory(kSharedMemoryFolder));
  diagnoses.push_back(check_stale_segments(kSharedMemoryFolder));
  diagnoses.push_back(check_other_users(kSharedMemoryFolder));
  diagnoses.push_back(check_clock());
  diagnoses.push_back(check_disk(std::filesystem::current_path()));
  return diagnoses;
}

void print(const std::vector<Diagnosis>& diagnoses) {
  for (const Diagnosis& diagnosis : diagnoses) {
    std::cout << fmt::format("{:<5} {:<15} {}\n", grade_word(diagnosis.grade), diagnosis.subject,
                             diagnosis.words);
    if (!diagnosis.advice.empty()) std::cout << fmt::format("{:<22}{}\n", "", diagnosis.advice);
  }
}

void print_json(const std::vector<Diagnosis>& diagnoses) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Diagnosis& diagnosis : diagnoses) {
    json.push_back({{"subject", diagnosis.subject},
                    {"grade", grade_word(diagnosis.grade)},
                    {"words", diagnosis.words},
                    {"advice", diagnosis.advice}});
  }
  std::cout << json_text(json, 2) << '\n';
}

int doctor(const CommonOptions& common, const DoctorOptions& options) {
  const std::vector<Diagnosis> diagnoses = examine(common, options);
  options.json ? print_json(diagnoses) : print(diagnoses);
  const bool bad = std::any_of(diagnoses.begin(), diagnoses.end(), [](const Diagnosis& diagnosis) {
    return diagnosis.grade == Grade::kBad;
  });
  return bad ? kExitUnavailable : kExitOk;
}

}  // namespace

void add_doctor(CLI::App& app, Verb& chosen) {
  CLI::App* const verb =
      app.add_subcommand("doctor", "What would keep a scan from working, and what to do");
  const auto common = std::make_shared<CommonOptions>();
  const auto options = std::make_shared<DoctorOptions>();
  verb->add_option("--lidar", options->lidar, "tcp://HOST:PORT or /dev/NAME, not the rig file's");
  verb->add_option("--stepper", options->stepper, "/dev/NAME[@BAUD], not the rig file's");
  verb->add_flag("--json", options->json, "As JSON");
  add_common_options(*verb, *common);
  verb->callback([=, &chosen] { chosen = [=] { return doctor(*common, *options); }; });
}

}  // namespace swivel
