// ./run bench accuracy: the attitude's error in each mode and tier, beside what is to be reached;
// with --alpha or --mounting that of a calibration.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "calibration/units.hpp"
#include "tests/bench/accuracy.hpp"
#include "tests/bench/mounting_tables.hpp"

namespace swivel {
namespace {

struct Options {
  std::vector<int> modes{1, 2, 3, 4, 5, 6, 7};
  std::vector<Tier> tiers{Tier::kClean, Tier::kReal, Tier::kRough};
  int sweeps = 50;
  std::uint64_t seed = 1;
};

// What is to be reached in tier real.
struct Aim {
  double rms_deg;
  double max_deg;
};
const std::map<int, Aim> kAims{{1, {0.09, 0.286}}, {4, {0.04, 0.12}}, {7, {0.02, 0.06}}};

// A study with a simulator of its own, tier real: an oracle that knows the real plate, and the
// paper's method with its even spread of the beams.
constexpr std::array<double, 7> kStudyBound_deg{0.070, 0.043, 0.030, 0.027, 0.018, 0.015, 0.010};
constexpr std::array<double, 7> kStudyRing_deg{0.474, 0.325, 0.266, 0.208, 0.178, 0.172, 0.133};

constexpr int kCalibrations = 5;

constexpr double kMapDistance_mm = 10'000.0;
constexpr double kMapAim_mm = 50.0;

const char* in_words(Tier tier) {
  switch (tier) {
    case Tier::kClean:
      return "range noise 13 mm, a pencil beam";
    case Tier::kReal:
      return "13 mm, 4 mm spot of 6 mrad, echo jitter, mixed pixels, 0.5 % dropouts";
    case Tier::kRough:
      return "20 mm, 8 mm spot, 2 % dropouts, range bias 3 mm, plate tilted 1.5/-1.0 deg and 1 mm "
             "low";
  }
  return "";
}

void print_tier(Tier tier) {
  std::printf("\nTier %s: %s\n", name_of(tier), in_words(tier));
}

void print_head(Tier tier) {
  std::printf("%4s %-14s %7s %7s %7s %7s %7s %8s %10s", "mode", "estimator", "rms", "max", "mean",
              "/sigma", "refused", "ms", "10 m, mm");
  std::printf(tier == Tier::kReal ? "  study: bound, ring    aim\n" : "\n");
}

const char* pass_or_miss(bool reached) {
  return reached ? "pass" : "miss";
}

void print_aim(const AccuracySummary& summary, int mode) {
  const auto index = static_cast<std::size_t>(mode) - 1;
  std::printf("  %12.3f %6.3f", kStudyBound_deg[index], kStudyRing_deg[index]);
  const auto aim = kAims.find(mode);
  if (aim == kAims.end()) return;
  const auto& [rms_deg, max_deg] = aim->second;
  std::printf("    rms %.2f %s, max %.3f %s", rms_deg,
              pass_or_miss(summary.good > 0 && summary.rms_deg <= rms_deg), max_deg,
              pass_or_miss(summary.good > 0 && summary.max_deg <= max_deg));
}

void print_row(const TrialPlan& plan, const std::string& name, const AccuracySummary& summary,
               double time_ms) {
  std::printf("%4d %-14s ", plan.mode, name.c_str());
  if (summary.good == 0) {
    std::printf("%7s %7s %7s %7s %7zu %8.2f %15s", "-", "-", "-", "-", summary.refused, time_ms,
                "");
  } else {
    const double map_mm = kMapDistance_mm * std::tan(rad_from_deg(summary.max_deg));
    std::printf("%7.4f %7.4f %7.4f %7.2f %7zu %8.2f %10.1f %s", summary.rms_deg, summary.max_deg,
                summary.mean_deg, summary.rms_in_sigmas, summary.refused, time_ms, map_mm,
                pass_or_miss(map_mm <= kMapAim_mm));
  }
  if (plan.tier == Tier::kReal) print_aim(summary, plan.mode);
  std::printf("\n");
  std::fflush(stdout);
}

void print_alpha(const Calibrated& calibrated) {
  const std::optional<AlphaFit>& fit = calibrated.alpha.fit;
  if (!fit) {
    std::printf("%-14s no alpha: %s\n", calibrated.estimator.name.c_str(),
                calibrated.alpha.reason.c_str());
    return;
  }
  const double error_rad = fit->alpha_rad - PlateGeometry().alpha_rad;
  std::printf("%-14s off by %+.4f deg, said +- %.4f, from %zu sweeps\n",
              calibrated.estimator.name.c_str(), deg_from_rad(error_rad),
              deg_from_rad(fit->sigma_rad), fit->sweeps_used);
}

// The estimators as their rig is used: with the plate and the alpha that a calibration found.
std::vector<std::vector<NamedEstimator>> calibrations(Tier tier, std::uint64_t seed) {
  CalibrationPlan plan;
  plan.tier = tier;
  plan.seed = seed;
  std::printf("Alpha, from %d sweeps of mode %d in a cluttered room:\n", plan.sweeps, plan.mode);
  std::vector<std::vector<NamedEstimator>> found;
  for (plan.run = 0; plan.run < kCalibrations; ++plan.run) {
    found.emplace_back();
    for (const Calibrated& each : calibrate(plan, known_estimators())) {
      print_alpha(each);
      found.back().push_back(each.estimator);
    }
  }
  return found;
}

struct AlphaAim {
  Room room;
  const char* in_words;
  int mode;
  int sweeps;
  double aim_deg;
};
constexpr std::array<AlphaAim, 6> kAlphaAims{
    {{Room::kSquare, "a square room", 7, 5, 0.015},
     {Room::kSquare, "a square room", 1, 20, 0.04},
     {Room::kCluttered, "a cluttered room", 7, 5, 0.015},
     {Room::kCluttered, "a cluttered room", 1, 20, 0.04},
     {Room::kSkewed, "a room with a wall 0.5 deg askew", 7, 5, 0.03},
     {Room::kSkewed, "a room with a wall 0.5 deg askew", 1, 20, 0.03}}};

void measure_alpha(std::uint64_t seed) {
  for (const AlphaAim& aim : kAlphaAims) {
    std::printf("\nAlpha, tier real, from %d sweeps of mode %d in %s; aim %.3f deg:\n", aim.sweeps,
                aim.mode, aim.in_words, aim.aim_deg);
    const CalibrationPlan plan{Tier::kReal, aim.room, aim.mode, aim.sweeps, seed};
    for (const Calibrated& each : calibrate(plan, known_estimators())) print_alpha(each);
    std::fflush(stdout);
  }
}

void measure(const Options& options) {
  std::printf(
      "Error of phi_offset, deg, over %d sweeps a row: phi_start drawn within 3 deg of 0. The rig"
      " is calibrated first,\nas `swivel calibrate alpha` does it, %d times: the sweeps take turns"
      " with the calibrations.\n",
      options.sweeps, kCalibrations);
  std::printf(
      "/sigma: rms of error by its own sigma. 10 m: map error there, distance * tan(max),"
      " aim 50 mm.\nms: of the processor, the median of one estimate of all beams.\n");
  for (const Tier tier : options.tiers) {
    print_tier(tier);
    const auto calibrated = calibrations(tier, options.seed);
    print_head(tier);
    for (const int mode : options.modes) {
      const TrialPlan plan{tier, mode, options.sweeps, options.seed};
      const auto trials = run_trials(plan, calibrated);
      const auto times_ms = median_times_ms(plan, calibrated.front());
      for (std::size_t i = 0; i < trials.size(); ++i) {
        print_row(plan, calibrated.front()[i].name, summarise(trials[i]), times_ms[i]);
      }
    }
  }
}

}  // namespace
}  // namespace swivel

int main(int argc, char** argv) {
  using swivel::Tier;
  swivel::Options options;
  CLI::App app{"The attitude's error on the bench's world, by mode and tier of realism."};
  const std::map<std::string, Tier> tiers{
      {"clean", Tier::kClean}, {"real", Tier::kReal}, {"rough", Tier::kRough}};
  app.add_option("--modes", options.modes, "Which of 1 to 7")->check(CLI::Range(1, 7));
  app.add_option("--tiers", options.tiers, "Which of clean, real, rough")
      ->transform(CLI::CheckedTransformer(tiers));
  app.add_option("--sweeps", options.sweeps, "A mode and tier")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of all random numbers")->capture_default_str();
  bool alpha = false;
  app.add_flag("--alpha", alpha, "Of alpha instead, in three rooms, from few sweeps");
  bool mounting = false;
  app.add_flag("--mounting", mounting,
               "Of bias and mounting instead, on Zeng's rig; --sweeps is the number of rigs [20]");
  CLI11_PARSE(app, argc, argv);
  if (mounting) {
    swivel::print_mounting_accuracy(app.count("--sweeps") > 0 ? options.sweeps : 20, options.seed);
  } else if (alpha) {
    swivel::measure_alpha(options.seed);
  } else {
    swivel::measure(options);
  }
  return 0;
}
