#include "components/swivel/report/findings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calibration/seam.hpp"
#include "calibration/units.hpp"

namespace swivel {
namespace {

using Findings = std::vector<Finding>;

constexpr double kEnoughWithin = 0.95;  // of a wall's points within 40 mm
constexpr std::size_t kFewSweeps = 5;   // the paper has five a mode

void good(Findings& findings, const std::string& words) {
  findings.push_back({Finding::Kind::kGood, words});
}
void bad(Findings& findings, const std::string& words) {
  findings.push_back({Finding::Kind::kBad, words});
}
void note(Findings& findings, const std::string& words) {
  findings.push_back({Finding::Kind::kNote, words});
}

std::string sweeps_in_words(std::size_t count) {
  return count == 1 ? "1 sweep" : fmt::format("{} sweeps", count);
}

void find_verdicts(const Evaluation& evaluation, Findings& findings) {
  std::size_t without = 0;
  std::string words;
  for (const auto& [verdict, count] : evaluation.verdicts()) {
    if (verdict == "good" || verdict == "measured") continue;
    without += count;
    words += (words.empty() ? "" : ", ") + fmt::format("{} {}", count, verdict);
  }
  const std::size_t all = evaluation.sweeps.size();
  if (all == 0) return bad(findings, "There is no sweep.");
  if (without > 0) {
    return bad(findings, fmt::format("{} of {} have no attitude ({}). Their clouds are left "
                                     "uncorrected, and they count in no number with correction.",
                                     without, sweeps_in_words(all), words));
  }
  if (!evaluation.axis_measured)
    good(findings, all == 1 ? "The sweep has an attitude."
                            : fmt::format("All {} sweeps have an attitude.", all));
}

std::string mode_in_words(int mode) {
  return mode == 0 ? "The sweeps without a mode" : fmt::format("Mode {}", mode);
}

void find_map_error(const ModeEvaluation& mode, Findings& findings) {
  if (mode.with.count == 0) return;
  const double largest_rad = mode.with.largest_rad();
  const double kept_m = kept_up_to_m(largest_rad);
  const std::string largest =
      fmt::format("largest |phi_error| {:.3f} deg", deg_from_rad(largest_rad));
  std::string paper;
  if (const auto paper_rad = papers_largest_rad(mode.mode))
    paper = fmt::format("; the paper: {:.4f} deg, {:.2f} m", deg_from_rad(*paper_rad),
                        kept_up_to_m(*paper_rad));
  const std::string name = mode_in_words(mode.mode);
  if (kept_m >= kMapReach_m)
    good(findings,
         fmt::format("{}: the map is within +-50 mm up to 10 m ({}{}).", name, largest, paper));
  else
    bad(findings, fmt::format("{}: the map is within +-50 mm up to {:.2f} m only ({}{}).", name,
                              kept_m, largest, paper));
}

void find_gain(const std::vector<SweepAttitude>& attitudes, Findings& findings) {
  std::vector<double> without, with;
  for (const SweepAttitude& attitude : attitudes) {
    if (std::isnan(attitude.with_rad)) continue;
    without.push_back(attitude.without_rad);
    with.push_back(attitude.with_rad);
  }
  if (with.empty()) return;
  const double before_deg = deg_from_rad(statistics_of(without).rms_rad);
  const double after_deg = deg_from_rad(statistics_of(with).rms_rad);
  const std::string words = fmt::format(
      "The correction takes the rms of phi_error from {:.3f} to "
      "{:.3f} deg.",
      before_deg, after_deg);
  if (after_deg < before_deg)
    good(findings, words);
  else
    bad(findings, words + " It makes the clouds worse.");
}

// A part that all sweeps share is not the estimator's: it is alpha's.
void find_constant_part(const Evaluation& evaluation, Findings& findings) {
  std::vector<double> errors_rad;
  for (const SweepFacts& sweep : evaluation.sweeps) errors_rad.push_back(sweep.attitude.with_rad);
  const AngleStatistics errors = statistics_of(errors_rad);
  if (errors.count < 2 || evaluation.reference == Reference::kOtherSweeps) return;
  const double variance = errors.rms_rad * errors.rms_rad - errors.mean_rad * errors.mean_rad;
  const auto count = static_cast<double>(errors.count);
  const double sigma_rad = std::sqrt(std::max(0.0, variance) / (count - 1.0));
  if (std::abs(errors.mean_rad) < std::max(3.0 * sigma_rad, rad_from_deg(0.02))) return;
  std::string words =
      fmt::format("All sweeps share an error of {:+.3f} deg.", deg_from_rad(errors.mean_rad));
  if (!std::isnan(evaluation.true_alpha_deg))
    words += fmt::format(
        " Alpha was taken as {:.3f} deg and is really {:.3f} deg, which makes {:+.3f} "
        "deg of it; what is left is the estimator's.",
        evaluation.alpha_deg, evaluation.true_alpha_deg,
        evaluation.true_alpha_deg - evaluation.alpha_deg);
  words += evaluation.alpha_calibrated
               ? " Was the plate moved since the calibration? See: swivel calibrate alpha."
               : " Alpha stands as drawn: swivel calibrate alpha takes this part away.";
  bad(findings, words);
}

void find_sigma(const Evaluation& evaluation, Findings& findings) {
  std::vector<double> ratios;
  for (const SweepFacts& sweep : evaluation.sweeps)
    ratios.push_back(sweep.attitude.with_rad / sweep.attitude.sigma_rad);
  const AngleStatistics errors = statistics_of(ratios);
  if (errors.count < kFewSweeps || evaluation.reference != Reference::kTruth) return;
  const std::string words = fmt::format(
      "The errors are {:.2f} times the sigma that was said (rms; 1 is honest)", errors.rms_rad);
  if (errors.rms_rad < 1.5)
    good(findings, words + ".");
  else
    bad(findings, words + ": sigma leaves something out.");
}

void find_flatness(const Evaluation& evaluation, Findings& findings) {
  const SweepFacts* worst = nullptr;
  for (const SweepFacts& sweep : evaluation.sweeps) {
    if (std::isnan(sweep.worst_share_within_40_mm)) continue;
    if (worst == nullptr || sweep.worst_share_within_40_mm < worst->worst_share_within_40_mm)
      worst = &sweep;
  }
  if (worst == nullptr) return note(findings, "No wall was found, so nothing is said of flatness.");
  const double percent = 100.0 * worst->worst_share_within_40_mm;
  if (worst->worst_share_within_40_mm >= kEnoughWithin)
    return good(findings, fmt::format("On every wall of every sweep {:.1f} % or more of the points "
                                      "lie within +-40 mm of the fitted plane.",
                                      std::floor(10.0 * percent) / 10.0));
  bad(findings, fmt::format("Sweep {}, {}: only {:.1f} % of the points lie within +-40 mm of the "
                            "fitted plane. See its picture: furniture, or a bent cloud?",
                            worst->attitude.sweep, worst->worst_surface, percent));
}

void find_seam(const Evaluation& evaluation, Findings& findings) {
  if (evaluation.axis_measured) return;
  std::size_t known = 0;
  std::string open;
  for (const SweepFacts& sweep : evaluation.sweeps) {
    if (std::isnan(sweep.seam_deg)) continue;
    ++known;
    SeamEstimate seam;
    seam.further_rad = rad_from_deg(sweep.seam_deg);
    seam.sigma_rad = rad_from_deg(sweep.seam_sigma_deg);
    if (!seam_is_open(seam)) continue;
    open += fmt::format("{}{} ({:+.3f} deg)", open.empty() ? "" : ", ", sweep.attitude.sweep,
                        sweep.seam_deg);
  }
  if (known == 0)
    return note(findings,
                "How far the shaft really turned is not known (seam_deg); see the pictures "
                "of the seam.");
  if (!open.empty())
    return bad(findings, "The seam is open in sweep " + open +
                             ": were steps lost, or was the shaft "
                             "not at constant speed?");
  good(findings, fmt::format("The seam is closed in {} of {}.", known,
                             sweeps_in_words(evaluation.sweeps.size())));
}

void find_remarks(const Evaluation& evaluation, Findings& findings) {
  std::set<std::string> warnings;
  for (const SweepFacts& sweep : evaluation.sweeps) {
    if (sweep.lines_missing > 0)
      bad(findings,
          fmt::format("Sweep {} misses {} lines.", sweep.attitude.sweep, sweep.lines_missing));
    if (!sweep.warning.empty() && warnings.insert(sweep.warning).second)
      bad(findings, fmt::format("Sweep {}: {}", sweep.attitude.sweep, sweep.warning));
  }
}

void find_what_is_not_told(const Evaluation& evaluation, const std::vector<ModeEvaluation>& modes,
                           Findings& findings) {
  if (evaluation.naive)
    note(findings,
         "Lidar and motor were started together (naive): where such a sweep began says "
         "little of its cloud, which is bent. So phi_error is by the walls here.");
  if (evaluation.reference == Reference::kOtherSweeps)
    note(findings,
         "phi_error is against the median of all "
         "sweeps, by their walls: an error that all share, as alpha's, is not in it.");
  if (evaluation.reference == Reference::kSquareWalls)
    note(findings,
         "phi_error is against the walls: it holds "
         "only if the room is square and the rig stood square in it.");
  if (evaluation.reference == Reference::kNone && !evaluation.axis_measured)
    note(findings,
         "phi_error is not known: there is neither a truth beside the sweeps, nor walls by "
         "which to judge.");
  std::string few;
  for (const ModeEvaluation& mode : modes)
    if (mode.with.count > 0 && mode.with.count < kFewSweeps)
      few += fmt::format("{}{}", few.empty() ? "" : ", ", mode.mode);
  if (!few.empty())
    note(findings,
         "Fewer than five sweeps of mode " + few + ": the largest of so few says little.");
}

}  // namespace

std::vector<SweepAttitude> Evaluation::attitudes() const {
  std::vector<SweepAttitude> attitudes;
  attitudes.reserve(sweeps.size());
  for (const SweepFacts& sweep : sweeps) attitudes.push_back(sweep.attitude);
  return attitudes;
}

std::map<std::string, std::size_t> Evaluation::verdicts() const {
  std::map<std::string, std::size_t> verdicts;
  for (const SweepFacts& sweep : sweeps) ++verdicts[sweep.verdict];
  return verdicts;
}

std::vector<Finding> findings_of(const Evaluation& evaluation) {
  Findings findings;
  const std::vector<ModeEvaluation> modes = by_mode(evaluation.attitudes());
  if (evaluation.axis_measured)
    note(findings,
         "The axis of this rig was measured: it has no plate and nothing to correct, so "
         "phi_error, its map error, seam and plate have no place here. What is left are "
         "the surfaces.");
  find_verdicts(evaluation, findings);
  if (!evaluation.axis_measured) {
    for (const ModeEvaluation& mode : modes) find_map_error(mode, findings);
    find_gain(evaluation.attitudes(), findings);
    find_constant_part(evaluation, findings);
    find_sigma(evaluation, findings);
  }
  find_flatness(evaluation, findings);
  find_seam(evaluation, findings);
  find_remarks(evaluation, findings);
  if (!evaluation.axis_measured) find_what_is_not_told(evaluation, modes, findings);
  const auto order = [](Finding::Kind kind) {
    return kind == Finding::Kind::kBad ? 0 : kind == Finding::Kind::kGood ? 1 : 2;
  };
  std::stable_sort(findings.begin(), findings.end(), [&](const auto& one, const auto& other) {
    return order(one.kind) < order(other.kind);
  });
  return findings;
}

std::string in_words(Reference reference) {
  switch (reference) {
    case Reference::kTruth:
      return "the simulator's truth";
    case Reference::kOtherSweeps:
      return "the median of all sweeps, by their walls";
    case Reference::kSquareWalls:
      return "the square directions of the walls";
    case Reference::kNone:
      break;
  }
  return "nothing: neither a truth nor walls to judge by";
}

}  // namespace swivel
