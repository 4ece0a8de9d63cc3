// What the numbers of an evaluation mean, in words: what is good, what is not.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "components/swivel/report/evaluation.hpp"

namespace swivel {

// The numbers of one sweep that do not depend on the others.
struct SweepFacts {
  SweepAttitude attitude;
  std::string verdict;  // "good", "no_plate"
  std::string reason;   // in words; empty when good
  std::string warning;  // why a new calibration is due; else empty
  std::size_t lines_missing = 0;
  double seam_deg = kUnknownAngle;  // as in the Attitude
  double seam_sigma_deg = kUnknownAngle;
  double worst_share_within_40_mm = kUnknownAngle;  // over its surfaces
  std::string worst_surface;
};

struct Evaluation {
  bool axis_measured = false;
  bool alpha_calibrated = false;
  double alpha_deg = kUnknownAngle;
  double true_alpha_deg = kUnknownAngle;
  bool naive = false;  // lidar and motor started together: the clouds are bent
  Reference reference = Reference::kNone;
  std::vector<SweepFacts> sweeps;

  std::vector<SweepAttitude> attitudes() const;
  std::map<std::string, std::size_t> verdicts() const;  // how many of each
};

struct Finding {
  enum class Kind { kGood, kBad, kNote } kind;
  std::string words;
};

// The most important first.
std::vector<Finding> findings_of(const Evaluation& evaluation);

// "the simulator's truth".
std::string in_words(Reference reference);

}  // namespace swivel
