#include "components/gateway/picture.hpp"

#include <fmt/core.h>

#include "components/attitude_corrector/corrector.hpp"

namespace swivel {
namespace {

using Level = Trust::Level;

std::string verdict_in_words(msg::Verdict verdict) {
  switch (verdict) {
    case msg::VERDICT_NO_PLATE:
      return "No plate was found";
    case msg::VERDICT_TOO_FEW_POINTS:
      return "Too few points on the plate";
    case msg::VERDICT_FOREIGN_OBJECT:
      return "Something stands at the plate";
    case msg::VERDICT_LINES_MISSING:
      return "Lines are missing at the plate";
    case msg::VERDICT_SEAM_OPEN:
      return "The shaft did not turn as said";
    default:
      return "The attitude is not known";
  }
}

Trust trust_in_cloud(const Picture& picture) {
  if (!picture.stopped.empty()) return {Level::kBad, "Do not use", picture.stopped};
  if (!picture.attitude) return {Level::kWaiting, "Not judged yet", "its attitude has not come"};
  const msg::Attitude& attitude = *picture.attitude;
  if (!Corrector::in_base(attitude.verdict())) {
    return {Level::kBad, verdict_in_words(attitude.verdict()), attitude.reason()};
  }
  if (!picture.in_base) {
    return {Level::kBad, "Not corrected", "the cloud came in the frame of its start position"};
  }
  if (attitude.lines_missing() > 0) {
    return {Level::kBad, "Incomplete",
            fmt::format("{} of {} lines are missing; {}", attitude.lines_missing(),
                        attitude.lines_expected(), attitude.reason())};
  }
  if (attitude.verdict() == msg::VERDICT_MEASURED) {
    return {Level::kGood, "Good", "the rig measures its axis: nothing to correct"};
  }
  if (!attitude.calibrated()) {
    return {Level::kGood, "Not calibrated",
            "the plate was found, but stands only as drawn: all clouds may be turned by the same "
            "angle; run: swivel calibrate alpha"};
  }
  return {Level::kGood, "Good", attitude.reason()};
}

}  // namespace

Trust trust_in(const Picture& picture) {
  switch (picture.kind) {
    case Picture::Kind::kNone:
      return {Level::kNothing, "No sweep yet", "start one below"};
    case Picture::Kind::kRunning:
      return {Level::kRunning, "Scanning",
              fmt::format("{} of {} lines; not yet corrected", picture.lines_in, picture.lines)};
    case Picture::Kind::kAssembled:
      return {Level::kWaiting, "Being corrected", "all lines are in"};
    case Picture::Kind::kStopped:
      return {Level::kBad, "Stopped", picture.stopped};
    case Picture::Kind::kCloud:
      return trust_in_cloud(picture);
  }
  return {};
}

const char* word_for(Picture::Kind kind) {
  switch (kind) {
    case Picture::Kind::kNone:
      return "none";
    case Picture::Kind::kRunning:
      return "running";
    case Picture::Kind::kAssembled:
      return "assembled";
    case Picture::Kind::kStopped:
      return "stopped";
    case Picture::Kind::kCloud:
      return "cloud";
  }
  return "none";
}

const char* word_for(Trust::Level level) {
  switch (level) {
    case Level::kNothing:
      return "nothing";
    case Level::kRunning:
      return "running";
    case Level::kWaiting:
      return "waiting";
    case Level::kGood:
      return "good";
    case Level::kBad:
      return "bad";
  }
  return "nothing";
}

}  // namespace swivel
